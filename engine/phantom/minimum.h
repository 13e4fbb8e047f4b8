#pragma once

#include <cmath>

namespace lumenline {

/// Value and first two derivatives of a function at one place.
struct Jet {
    double value, first, second;
};

/// Where the slope of `g` changes sign in [lo, hi]: Newton on the derivative, falling back to
/// bisection, down to neighbouring doubles.
/// @param g  double -> Jet, with first(lo) <= 0 <= first(hi)
template <class G>
double stationary_point(const G& g, double lo, double hi) {
    constexpr int kMaxSteps = 200;  // bisection alone needs about 60
    double x = 0.5 * (lo + hi);
    double last_step = hi - lo;
    for (int i = 0; i < kMaxSteps; ++i) {
        const Jet jet = g(x);
        if (jet.first == 0) return x;
        (jet.first < 0 ? lo : hi) = x;
        double next = x - jet.first / jet.second;
        const bool halves = std::fabs(next - x) <= 0.5 * last_step;
        if (!(next > lo && next < hi && halves)) next = 0.5 * (lo + hi);
        if (next == x || next == lo || next == hi) return next;
        last_step = std::fabs(next - x);
        x = next;
    }
    return x;
}

/// Where `g` is least in [lo, hi]: every local minimum of a scan in `steps` equal steps is refined.
/// Minima closer to each other than two steps may be taken for one.
template <class G>
double scanned_minimum(const G& g, double lo, double hi, int steps) {
    const auto knot = [&](int i) { return i == steps ? hi : lo + (hi - lo) * (static_cast<double>(i) / steps); };
    double best = lo;
    double least = g(lo).value;
    const auto offer = [&](double x) {
        const double value = g(x).value;
        if (value < least) {
            least = value;
            best = x;
        }
    };
    double before = least;
    double here = least;
    for (int i = 0; i <= steps; ++i) {
        const double after = i < steps ? g(knot(i + 1)).value : here;
        if (here <= before && here <= after) {
            const double left = knot(i > 0 ? i - 1 : 0);
            const double right = knot(i < steps ? i + 1 : steps);
            offer(knot(i));
            if (g(left).first <= 0 && g(right).first >= 0) offer(stationary_point(g, left, right));
        }
        before = here;
        here = after;
    }
    return best;
}

}  // namespace lumenline
