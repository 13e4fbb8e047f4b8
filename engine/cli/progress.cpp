#include "engine/cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "engine/cli/estimates.h"

namespace lumenline {

namespace {

/// Ids and sentences name files: what they hold is not to move the cursor.
std::string printable(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 32 || c == 127; }, '?');
    return text;
}

}  // namespace

Progress::Progress(std::size_t models)
    : models_(models),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()),
      printed_(start_) {}

void Progress::add(const ModelSummary& model) {
    ++done_;
    if (model.failure) {
        ++failed_;
        fmt::print(stderr, "{}{}: failed in {}: {}\n", terminal_ ? "\r\033[K" : "", printable(model.identity.id),
                   stage_name(model.failure->stage), printable(model.failure->sentence));
    }
    const auto now = std::chrono::steady_clock::now();
    const auto pause = terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(60000);
    if (now - printed_ >= pause) print(false);
}

void Progress::finish() { print(true); }

void Progress::print(bool last) {
    printed_ = std::chrono::steady_clock::now();
    const double elapsed = std::chrono::duration<double>(printed_ - start_).count();
    const double rate = elapsed > 0 ? static_cast<double>(done_) / elapsed : 0;
    std::string line = fmt::format("{} of {} models", done_, models_);
    if (failed_ > 0) line += fmt::format(", {} failed", failed_);
    line +=
        rate >= 1 || rate == 0 ? fmt::format(", {:.1f} a second", rate) : fmt::format(", {:.1f} a minute", 60 * rate);
    line += last ? fmt::format(", {} in all", duration_text(elapsed))
                 : fmt::format(", {} left", duration_text(rate > 0 ? static_cast<double>(models_ - done_) / rate : 0));
    if (terminal_)
        fmt::print(stderr, "\r\033[K{}{}", line, last ? "\n" : "");
    else
        fmt::print(stderr, "{}\n", line);
    std::fflush(stderr);
}

}  // namespace lumenline
