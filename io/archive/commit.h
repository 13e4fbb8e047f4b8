#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>

namespace lumenline {

/// Where the bytes of `file` are gathered before it appears: "<file>.tmp", in the same directory.
std::filesystem::path temporary_of(const std::filesystem::path& file);

/// Makes the finished and closed `temporary_of(file)` appear as `file`: syncs it to the disk,
/// renames it (replacing an older `file`), syncs the directory. After a crash there is either the
/// older file, or none, or the complete new one.
/// @throws std::system_error
void commit_file(const std::filesystem::path& file);

/// Makes `file` appear with what `body` writes, as commit_file does. Nothing is left behind where that fails.
/// @throws std::system_error "cannot write '<file>': why"; what `body` throws
void write_file(const std::filesystem::path& file, const std::function<void(std::ostream&)>& body);

}  // namespace lumenline
