#include "tests/damage/consumers.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>

#include "engine/cli/browse.h"
#include "engine/cli/export.h"
#include "engine/cli/pack.h"
#include "engine/cli/report.h"
#include "engine/cli/stats.h"
#include "engine/cli/status_of.h"
#include "engine/cli/validate_archive.h"

namespace lumenline::damage {

Outcome run_command(const std::vector<std::string>& words) {
    CLI::App app;
    app.require_subcommand(1);
    std::function<int()> action;
    for (const auto add : {add_browse, add_export, add_pack, add_report, add_stats, add_validate_archive})
        add(app, action);
    std::vector<std::string> reversed(words.rbegin(), words.rend());
    app.parse(reversed);
    Outcome outcome;
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    outcome.status = status_of(action);
    outcome.out = ::testing::internal::GetCapturedStdout();
    outcome.err = ::testing::internal::GetCapturedStderr();
    return outcome;
}

std::string complaint(const std::vector<std::string>& words) {
    const Outcome outcome = run_command(words);
    std::string line = "lumenline";
    for (const std::string& word : words) line += " " + word;
    const auto lines = std::count(outcome.err.begin(), outcome.err.end(), '\n');
    const bool is_finding = words.front() == "validate-archive" && outcome.status == 1 && outcome.err.empty();
    if (outcome.status == 0 || is_finding) return "";
    if ((outcome.status == 1 || outcome.status == 2) && lines == 1) return "";
    return line + ": status " + std::to_string(outcome.status) + ", " + std::to_string(lines) +
           " lines of errors: " + outcome.err + "\n";
}

}  // namespace lumenline::damage
