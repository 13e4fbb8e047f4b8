// A rename is atomic but not durable: without the sync of the file a crash can leave the new name
// with no bytes behind it, and without the sync of the directory it can leave the old name.

#include "io/archive/commit.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "io/archive/index_names.h"
#include "io/archive/utf8.h"

namespace lumenline {

namespace {

void sync_path(const std::filesystem::path& path, int flags, bool may_be_unsupported) {
    const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
    if (descriptor < 0) throw std::system_error(errno, std::generic_category(), "cannot open '" + path.string() + "'");
    const int status = ::fsync(descriptor);
    const int error = errno;
    ::close(descriptor);
    if (status != 0 && !(may_be_unsupported && error == EINVAL))
        throw std::system_error(error, std::generic_category(), "cannot sync '" + path.string() + "'");
}

/// Absolute and without links, also where nothing stands there yet.
std::filesystem::path real_path(const std::filesystem::path& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path));
}

/// Whether `file` lies in `directory` or below it; both are real paths.
bool lies_in(const std::filesystem::path& file, const std::filesystem::path& directory) {
    return std::mismatch(directory.begin(), directory.end(), file.begin(), file.end()).first == directory.end();
}

}  // namespace

OutputError::OutputError(const std::filesystem::path& file, const std::string& why)
    : std::runtime_error("cannot write '" + printable(file.string()) + "': " + why) {}

std::filesystem::path output_file(const std::filesystem::path& output) {
    namespace fs = std::filesystem;
    if (output.empty()) throw OutputError(output, "its name is empty");
    std::error_code error;
    const fs::file_status status = fs::status(output, error);
    if (fs::is_directory(status) || !output.has_filename()) throw OutputError(output, "it is a directory");
    if (fs::exists(status) && !fs::is_regular_file(status))
        throw OutputError(output, "it is a device or a pipe, and only files are written");
    const fs::path target = real_path(output);
    if (!fs::is_directory(target.parent_path(), error))
        throw OutputError(output, "there is no directory '" + printable(target.parent_path().string()) + "'");
    return fs::is_symlink(fs::symlink_status(output, error)) ? target : output;
}

void make_directories(const std::filesystem::path& directory) {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (error) throw OutputError(directory, error.message());
}

void refuse_overwriting(const std::filesystem::path& output, const std::filesystem::path& other) {
    namespace fs = std::filesystem;
    if (output.empty()) return;
    std::error_code ignored;
    const fs::path target = real_path(output);
    if (fs::equivalent(output, other, ignored) || target == real_path(other))
        throw OutputTaken(output, "the command has that file already, to read or to write: name another");
    const fs::path archive = fs::is_directory(other, ignored) ? real_path(other) : real_path(other).parent_path();
    if (!fs::exists(archive / names::kIndexFile, ignored)) return;
    if (lies_in(target, archive / "models") || fs::equivalent(output, archive / names::kIndexFile, ignored))
        throw OutputTaken(output, "it is a part of the archive '" + printable(archive.string()) +
                                      "', which that would damage: name another file");
}

std::filesystem::path temporary_of(const std::filesystem::path& file) {
    std::filesystem::path temporary = file;
    temporary += ".tmp";
    return temporary;
}

void commit_file(const std::filesystem::path& file) {
    const std::filesystem::path temporary = temporary_of(file);
    sync_path(temporary, O_RDONLY, false);
    std::filesystem::rename(temporary, file);
    // Some network file systems cannot sync a directory (EINVAL); the rename stands all the same.
    sync_path(file.has_parent_path() ? file.parent_path() : ".", O_RDONLY | O_DIRECTORY, true);
}

void write_file(const std::filesystem::path& output, const std::function<void(std::ostream&)>& body) {
    const std::filesystem::path file = output_file(output);
    const std::filesystem::path temporary = temporary_of(file);
    const auto require = [&](bool written) {
        if (!written)
            throw std::system_error(errno, std::generic_category(), "cannot write '" + printable(file.string()) + "'");
    };
    std::ofstream out(temporary, std::ios::binary);
    require(out.is_open());
    try {
        body(out);
        out.close();
        require(out.good());
        commit_file(file);
    } catch (...) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        throw;
    }
}

}  // namespace lumenline
