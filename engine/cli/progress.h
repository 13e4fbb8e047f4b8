#pragma once

#include <chrono>
#include <cstddef>

#include "engine/core/model_record.h"

namespace lumenline {

/// Progress of a run on standard error: one line that renews itself on a terminal, a plain line a
/// minute elsewhere. Failures get a line of their own at once.
class Progress {
public:
    explicit Progress(std::size_t models);

    /// One model is done; called by one thread at a time.
    void add(const ModelSummary& model);
    /// Ends the line.
    void finish();

private:
    void print(bool last);

    std::size_t models_;
    std::size_t done_ = 0, failed_ = 0;
    bool terminal_;
    std::chrono::steady_clock::time_point start_, printed_;
};

}  // namespace lumenline
