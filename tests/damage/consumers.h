#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lumenline::damage {

/// What a command of the program did, run in this process as main.cpp runs it.
struct Outcome {
    int status = -1;  ///< exit status
    std::string out, err;
};

/// Runs `lumenline WORDS...`; its output is caught.
Outcome run_command(const std::vector<std::string>& words);

/// Empty if a command did what it may do with a damaged archive: work, or say one sentence and exit with 1 or 2.
std::string complaint(const std::vector<std::string>& words);

}  // namespace lumenline::damage
