#pragma once

#include <filesystem>

namespace lumenline {

/// Where the bytes of `file` are gathered before it appears: "<file>.tmp", in the same directory.
std::filesystem::path temporary_of(const std::filesystem::path& file);

/// Makes the finished and closed `temporary_of(file)` appear as `file`: syncs it to the disk,
/// renames it (replacing an older `file`), syncs the directory. After a crash there is either the
/// older file, or none, or the complete new one.
/// @throws std::system_error
void commit_file(const std::filesystem::path& file);

}  // namespace lumenline
