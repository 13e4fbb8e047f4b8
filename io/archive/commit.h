#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <stdexcept>
#include <string>

namespace lumenline {

/// A place where nothing can or should be written: "cannot write '<file>': why".
class OutputError : public std::runtime_error {
public:
    OutputError(const std::filesystem::path& file, const std::string& why);
};

/// An output that the same command reads or writes otherwise, or a part of the archive that it reads.
class OutputTaken : public OutputError {
public:
    using OutputError::OutputError;
};

/// Where the bytes of `file` are gathered before it appears: "<file>.tmp", in the same directory.
std::filesystem::path temporary_of(const std::filesystem::path& file);

/// The file that `output` names, behind symbolic links, which stay: a rename onto a link would replace the link.
/// @throws OutputError where that is a directory, a device, a pipe, or in no directory
std::filesystem::path output_file(const std::filesystem::path& output);

/// Makes a directory, and those above it, where there is none.
/// @throws OutputError
void make_directories(const std::filesystem::path& directory);

/// Refuses an `output` that is `other`, an input or another output of the command, or that would damage an archive: the
/// index or a model of the one that is `other` or in whose directory `other` lies.
/// @throws OutputTaken
void refuse_overwriting(const std::filesystem::path& output, const std::filesystem::path& other);

/// Makes the finished and closed `temporary_of(file)` appear as `file`: syncs it to the disk,
/// renames it (replacing an older `file`), syncs the directory. After a crash there is either the
/// older file, or none, or the complete new one.
/// @throws std::system_error
void commit_file(const std::filesystem::path& file);

/// Makes the `output_file` of `file` appear with what `body` writes, as commit_file does. Nothing is left behind where
/// that fails.
/// @throws OutputError; std::system_error "cannot write '<file>': why"; what `body` throws
void write_file(const std::filesystem::path& file, const std::function<void(std::ostream&)>& body);

}  // namespace lumenline
