#include "engine/core/stage_context.h"

#include <algorithm>
#include <utility>

namespace lumenline {

void StageContext::parallel_for(std::size_t count, std::size_t grain,
                                const std::function<void(std::size_t, std::size_t)>& body) const {
    for (std::size_t begin = 0; begin < count; begin += grain) {
        check_cancelled();
        body(begin, std::min(begin + grain, count));
    }
}

void StageContext::check_cancelled() const {
    if (cancelled_ != nullptr && cancelled_->load(std::memory_order_relaxed))
        throw StageError(stage_, ErrorCode::kInterrupted, "the run was stopped before this model was done");
}

void StageContext::note(std::string code, std::string message, double value, double limit) {
    diagnostics_.push_back({std::move(code), Severity::kNote, stage_, std::move(message), value, limit});
}

void StageContext::warn(std::string code, std::string message, double value, double limit) {
    diagnostics_.push_back({std::move(code), Severity::kWarning, stage_, std::move(message), value, limit});
}

void StageContext::error(std::string code, std::string message, double value, double limit) {
    diagnostics_.push_back({std::move(code), Severity::kError, stage_, std::move(message), value, limit});
}

void StageContext::retract(std::size_t first, std::size_t last) {
    const auto begin = diagnostics_.begin();
    diagnostics_.erase(begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(last));
}

}  // namespace lumenline
