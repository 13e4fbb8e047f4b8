// A rename is atomic but not durable: without the sync of the file a crash can leave the new name
// with no bytes behind it, and without the sync of the directory it can leave the old name.

#include "io/archive/commit.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>

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

}  // namespace

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

void write_file(const std::filesystem::path& file, const std::function<void(std::ostream&)>& body) {
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
