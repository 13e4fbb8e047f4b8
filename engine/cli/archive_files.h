#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace lumenline {

/// A regular file that is open for reading, and the size it had then.
class OpenFile {
public:
    /// Takes over the descriptor `fd`.
    OpenFile(int fd, std::uint64_t size, std::string tag);
    ~OpenFile();
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    [[nodiscard]] std::uint64_t size() const { return size_; }
    /// Differs between two files that stood under one name, as far as inode, size and time of change do.
    [[nodiscard]] const std::string& tag() const { return tag_; }
    /// Bytes from `offset` on into `target`; fewer than asked for at the file's end or when it cannot be read.
    std::size_t read(std::uint64_t offset, std::span<char> target) const;

private:
    int fd_;
    std::uint64_t size_;
    std::string tag_;
};

/// The files of one archive that may be given away, by their paths within it: "cohort.h5" and "models/<id>.hdf" of a
/// directory, or the one file that the archive is.
///
/// Every part of a path is opened in the directory opened before it and no symbolic link is followed, so that nothing
/// outside of the archive can be reached, not even while somebody changes the directory.
class ArchiveFiles {
public:
    /// @throws UnknownName if there is no such archive, or a directory has no index
    explicit ArchiveFiles(const std::filesystem::path& archive);
    ~ArchiveFiles();
    ArchiveFiles(const ArchiveFiles&) = delete;
    ArchiveFiles& operator=(const ArchiveFiles&) = delete;

    /// Path of the index, or of the one file.
    [[nodiscard]] const std::string& root() const { return root_; }
    /// What people call the archive: the directory's or file's name, as valid UTF-8.
    [[nodiscard]] const std::string& name() const { return name_; }
    /// Null where the archive has no such file, or the path is none of its paths.
    [[nodiscard]] std::shared_ptr<const OpenFile> open(std::string_view path) const;

private:
    int directory_ = -1;
    bool single_ = false;
    std::string root_, name_;
};

}  // namespace lumenline
