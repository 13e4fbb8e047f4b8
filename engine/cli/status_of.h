#pragma once

#include <functional>

namespace lumenline {

/// Does a verb's `action`. What it throws becomes one sentence on standard error, but for errors of the command line
/// itself (CLI::Error), which pass.
/// @returns the exit status
int status_of(const std::function<int()>& action);

}  // namespace lumenline
