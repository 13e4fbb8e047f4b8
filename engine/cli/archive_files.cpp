// A path from the network is matched against the few forms that an archive has before anything is opened; then openat
// with O_NOFOLLOW walks it part by part. O_NONBLOCK keeps a named pipe from holding up whoever opens it, and what is no
// regular file is refused afterwards.
#include "engine/cli/archive_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "io/archive/errors.h"
#include "io/archive/index_names.h"
#include "io/archive/utf8.h"

namespace lumenline {

namespace {

constexpr std::string_view kModels = "models/";
constexpr std::string_view kExtension = ".hdf";

bool is_file_name(std::string_view name) {
    return !name.empty() && name != "." && name != ".." && name.find('/') == std::string_view::npos &&
           name.find('\0') == std::string_view::npos;
}

std::string tag_of(const struct stat& status) {
    return '"' + std::to_string(status.st_ino) + '-' + std::to_string(status.st_size) + '-' +
           std::to_string(status.st_mtim.tv_sec) + '.' + std::to_string(status.st_mtim.tv_nsec) + '"';
}

std::shared_ptr<const OpenFile> open_in(int directory, const std::string& name) {
    const int fd = ::openat(directory, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) return nullptr;
    struct stat status {};
    if (::fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) {
        ::close(fd);
        return nullptr;
    }
    return std::make_shared<OpenFile>(fd, static_cast<std::uint64_t>(status.st_size), tag_of(status));
}

}  // namespace

OpenFile::OpenFile(int fd, std::uint64_t size, std::string tag) : fd_(fd), size_(size), tag_(std::move(tag)) {}

OpenFile::~OpenFile() { ::close(fd_); }

std::size_t OpenFile::read(std::uint64_t offset, std::span<char> target) const {
    std::size_t done = 0;
    while (done < target.size()) {
        const ssize_t got = ::pread(fd_, target.data() + done, target.size() - done, static_cast<off_t>(offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        done += static_cast<std::size_t>(got);
    }
    return done;
}

ArchiveFiles::ArchiveFiles(const std::filesystem::path& archive) {
    std::error_code error;
    const std::filesystem::path place = std::filesystem::canonical(archive, error);
    if (error) throw UnknownName("there is no archive '" + printable(archive.string()) + "'");
    single_ = !std::filesystem::is_directory(place, error);
    const std::filesystem::path directory = single_ ? place.parent_path() : place;
    root_ = single_ ? place.filename().string() : std::string(names::kIndexFile);
    name_ = valid_text(place.filename().string());
    directory_ = ::open(directory.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (directory_ < 0)
        throw UnknownName("cannot open '" + printable(archive.string()) +
                          "': " + std::generic_category().message(errno));
    if (open(root_)) return;
    ::close(directory_);
    throw UnknownName(single_ ? "cannot read '" + printable(archive.string()) + "' as a file"
                              : "the directory '" + printable(archive.string()) + "' has no index " + root_ +
                                    ": it is no archive, or its run has not ended: run it again to make the index");
}

ArchiveFiles::~ArchiveFiles() { ::close(directory_); }

std::shared_ptr<const OpenFile> ArchiveFiles::open(std::string_view path) const {
    if (path == root_) return open_in(directory_, root_);
    if (single_ || !path.starts_with(kModels) || !path.ends_with(kExtension)) return nullptr;
    const std::string_view name = path.substr(kModels.size());
    if (!is_file_name(name)) return nullptr;
    const int models = ::openat(directory_, "models", O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (models < 0) return nullptr;
    auto file = open_in(models, std::string(name));
    ::close(models);
    return file;
}

}  // namespace lumenline
