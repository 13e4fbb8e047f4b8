#pragma once

#include <string>
#include <vector>

namespace lumenline {

/// What another program left behind.
struct CommandResult {
    int status = -1;       ///< its exit status; -1 if a signal ended it or it took too long
    std::string out, err;  ///< standard output and standard error
};

/// Runs a program of the PATH to its end, with `input` as its standard input; one that takes longer than half a minute
/// is killed.
/// @param words  the program's name first
/// @throws std::system_error if it cannot be started: errno ENOENT where there is no such program
CommandResult run_command(const std::vector<std::string>& words, const std::string& input = "");

}  // namespace lumenline
