#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace lumenline {

struct ServeOptions {
    int port = 0;  ///< 0 = kUsualPort, or any free one if that is taken
};

inline constexpr int kUsualPort = 8417;

/// Shows an archive in the browser: the page at "/", the archive's files below "/archive/", nothing else.
///
/// Listens on 127.0.0.1 only and answers only requests that name this machine as their host, so that pages of other
/// sites cannot read the archive through a name of theirs. Reads alone (GET, HEAD), one range of bytes at a time; see
/// ArchiveFiles for what of the disk can be reached.
///
/// `said` is given the address once the server listens. Returns when the server was stopped by a signal of the
/// operating system, in which case the process ends with status 0, or could not go on.
/// @throws UnknownName, ArchiveError if the archive cannot be used; std::runtime_error if the port cannot
void serve_archive(const std::filesystem::path& archive, const ServeOptions& options,
                   const std::function<void(const std::string&)>& said);

struct PageOptions {
    std::vector<std::string> models;  ///< ids; none = all
    bool empty = false;               ///< no archive in it
};

/// Writes the page with the files of an archive in it, so that it shows them without a server and without the archive.
///
/// Of a directory's models those that are asked for come along; an empty page asks for an archive. A model whose file
/// is missing is left out; the page says so where it is asked for.
/// @throws UnknownName, ArchiveError if the archive cannot be used or is too large for a page; std::runtime_error,
///         std::system_error if the file cannot be written
void write_page(const std::filesystem::path& archive, const std::filesystem::path& file, const PageOptions& options);

}  // namespace lumenline
