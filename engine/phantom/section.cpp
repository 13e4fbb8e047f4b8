// Ellipses: arc length by three-point Gauss quadrature on a table fine enough for rounding
// accuracy; distance by the root of Eberly's function F ("Distance from a Point to an Ellipse, an
// Ellipsoid, or a Hyperellipsoid"). With semi-axes e0 >= e1 and the point in the first quadrant the
// foot is (r y0 / (v + r - 1), y1 / v), r = (e0/e1)^2, where F(v) = 0. F is decreasing and convex
// right of its pole v = 0, so the root is unique; on the major axis the pole hides it and the foot
// has a closed form. Eberly's own variable is v - 1, which cancels near that axis.
#include "engine/phantom/section.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/phantom/minimum.h"

namespace lumenline {
namespace {

constexpr int kTableSize = 4096;
constexpr double kFullTurn = 2 * std::numbers::pi;

double knot(int i) { return kFullTurn * i / kTableSize; }

}  // namespace

EllipseArc::EllipseArc(double a, double b) : a_(a), b_(b), length_(kTableSize + 1, 0.0) {
    for (int i = 0; i < kTableSize; ++i) length_[i + 1] = length_[i] + arc(knot(i), knot(i + 1));
}

double EllipseArc::arc(double t0, double t1) const {
    const double middle = 0.5 * (t0 + t1);
    const double half = 0.5 * (t1 - t0);
    const double reach = half * std::sqrt(0.6);
    const auto speed = [&](double t) { return std::hypot(a_ * std::sin(t), b_ * std::cos(t)); };
    return half / 9 * (5 * speed(middle - reach) + 8 * speed(middle) + 5 * speed(middle + reach));
}

double EllipseArc::parameter(double u) const {
    if (a_ == b_) return kFullTurn * u;
    const double turns = std::floor(u);
    const double target = (u - turns) * perimeter();
    const auto above = std::upper_bound(length_.begin(), length_.end(), target);
    const int i = std::clamp(static_cast<int>(above - length_.begin()) - 1, 0, kTableSize - 1);
    double t = knot(i) + (target - length_[i]) / (length_[i + 1] - length_[i]) * (knot(i + 1) - knot(i));
    for (int k = 0; k < 2; ++k) {  // Newton, from a start already good to the table's square
        t += (target - length_[i] - arc(knot(i), t)) / std::hypot(a_ * std::sin(t), b_ * std::cos(t));
    }
    return t + kFullTurn * turns;
}

double ellipse_distance(double a, double b, double x, double y) {
    double e0 = a, e1 = b, y0 = std::fabs(x), y1 = std::fabs(y);
    if (e0 < e1) {
        std::swap(e0, e1);
        std::swap(y0, y1);
    }
    if (e0 == e1) return e0 - std::hypot(y0, y1);
    const double z0 = y0 / e0;
    const double z1 = y1 / e1;
    const double sign = z0 * z0 + z1 * z1 < 1 ? 1.0 : -1.0;
    double foot0 = 0, foot1 = 0;
    if (y1 > 0) {
        const double r = (e0 / e1) * (e0 / e1);
        const double above_one = (e0 - e1) * (e0 + e1) / (e1 * e1);  // r - 1
        const auto slope = [&](double v) {
            const double p = r * z0 / (v + above_one);
            const double q = z1 / v;
            return Jet{0, 1 - p * p - q * q, 2 * (p * p / (v + above_one) + q * q / v)};
        };
        const double v = stationary_point(slope, z1, std::hypot(r * z0, z1));
        foot0 = r * y0 / (v + above_one);
        foot1 = y1 / v;
    } else {
        const double focal = (e0 - e1) * (e0 + e1);
        const double share = std::min(1.0, e0 * y0 / focal);
        foot0 = share < 1 ? e0 * share : e0;
        foot1 = share < 1 ? e1 * std::sqrt((1 - share) * (1 + share)) : 0.0;
    }
    return sign * std::hypot(foot0 - y0, foot1 - y1);
}

}  // namespace lumenline
