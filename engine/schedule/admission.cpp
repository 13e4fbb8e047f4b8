#include "engine/schedule/admission.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace lumenline {

Admission::Admission(const std::vector<double>& needs, int places, double memory)
    : places_(places), most_passed_(places), bytes_(memory > 0 ? memory : std::numeric_limits<double>::infinity()) {
    queue_.reserve(needs.size());
    for (std::size_t i = needs.size(); i-- > 0;) queue_.push_back({i, needs[i]});
}

std::optional<Admission::Admitted> Admission::next() {
    if (places_ <= 0) return std::nullopt;
    const auto chosen = choose();
    if (chosen == queue_.rend()) return std::nullopt;
    const Admitted admitted{chosen->model, chosen->bytes};
    queue_.erase(std::next(chosen).base());
    --places_;
    bytes_ -= admitted.bytes;
    ++in_flight_;
    return admitted;
}

std::vector<Admission::Waiting>::reverse_iterator Admission::choose() {
    const auto first = queue_.rbegin();
    if (first == queue_.rend()) return first;
    if (in_flight_ == 0 || first->bytes <= bytes_) {
        passed_ = 0;
        return first;
    }
    if (passed_ >= most_passed_) return queue_.rend();
    const auto found = std::find_if(first, queue_.rend(), [this](const Waiting& w) { return w.bytes <= bytes_; });
    if (found != queue_.rend()) ++passed_;
    return found;
}

void Admission::leave(double bytes) {
    bytes_ += bytes;
    --in_flight_;
}

std::size_t Admission::would_fit(std::size_t most) const {
    std::size_t count = 0;
    double left = bytes_;
    for (auto w = queue_.rbegin(); w != queue_.rend() && count < most; ++w) {
        if (w->bytes > left) continue;
        left -= w->bytes;
        ++count;
    }
    return count;
}

}  // namespace lumenline
