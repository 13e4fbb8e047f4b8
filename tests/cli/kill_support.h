#pragma once

#include <string>
#include <vector>

namespace lumenline::cli_test {

/// Runs a small cohort (with further `arguments`), kills the run (SIGKILL) at `kills` random moments, and resumes it
/// each time; meanwhile a reader opens whatever stands under its final name. Expects that no file is ever torn, and
/// that the archive at the end is that of a run which was never killed, but for times and hosts.
void expect_kills_leave_no_trace(int kills, unsigned seed, const std::vector<std::string>& arguments = {});

}  // namespace lumenline::cli_test
