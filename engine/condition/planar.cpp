#include "engine/condition/planar.h"

#include <algorithm>
#include <cstddef>
#include <limits>

// Tangents are those of the parabola through three neighbouring corners, which is Catmull-Rom for
// uneven spacing. A tangent far off the chord, or sides of very different length, would make the
// cubic swing out; such spans stay straight.

namespace lumenline {
namespace {

constexpr double kLeastCosine = 0.7;  // between tangent and chord; a regular hexagon has 0.87
constexpr double kMostUneven = 5;     // ratio of neighbouring sides

std::uint64_t mixed(std::uint64_t x) {  // the finalizer of SplitMix64
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
}

double squared_distance_to_side(Vec2 a, Vec2 b, Vec2 q) {
    const Vec2 side = b - a;
    const double length = dot(side, side);
    const double t = length > 0 ? std::clamp(dot(q - a, side) / length, 0.0, 1.0) : 0;
    const Vec2 gap = q - (a + t * side);
    return dot(gap, gap);
}

}  // namespace

double depth_among(const std::vector<Side>& sides, Vec2 q) {
    bool inside = false;
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& [a, b] : sides) {
        nearest = std::min(nearest, squared_distance_to_side(a, b, q));
        if ((a.y > q.y) != (b.y > q.y) && q.x < a.x + (b.x - a.x) * ((q.y - a.y) / (b.y - a.y))) inside = !inside;
    }
    return inside ? std::sqrt(nearest) : -std::sqrt(nearest);
}

std::vector<Side> sides_of(const std::vector<Vec2>& polygon) {
    std::vector<Side> sides(polygon.size());
    for (std::size_t i = 0; i < polygon.size(); ++i) sides[i] = {polygon[i], polygon[(i + 1) % polygon.size()]};
    return sides;
}

double wobble(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const std::uint64_t bits = mixed(mixed(mixed(a + 0x9e3779b97f4a7c15ULL) + b) + c);
    return static_cast<double>(bits >> 11) * 0x1p-52 - 1;
}

ClosedCurve::ClosedCurve(const std::vector<Vec2>& corners, const std::vector<double>& heights, bool smooth)
    : corners_(corners), tangents_(corners.size()), heights_(heights), start_{0}, straight_(corners.size(), 0) {
    const std::size_t n = corners.size();
    std::vector<double> side(n);
    for (std::size_t i = 0; i < n; ++i) {
        side[i] = norm(corners[(i + 1) % n] - corners[i]);
        start_.push_back(start_.back() + side[i]);
    }
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t before = (i + n - 1) % n;
        if (side[i] > 0 && side[before] > 0) {
            const Vec2 ahead = (1 / side[i]) * (corners[(i + 1) % n] - corners[i]);
            const Vec2 behind = (1 / side[before]) * (corners[i] - corners[before]);
            tangents_[i] = (1 / (side[i] + side[before])) * (side[before] * ahead + side[i] * behind);
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 chord = corners[(i + 1) % n] - corners[i];
        const auto leans = [&](Vec2 tangent) { return dot(tangent, chord) < kLeastCosine * norm(tangent) * side[i]; };
        const auto uneven = [&](double other) {
            return other > kMostUneven * side[i] || side[i] > kMostUneven * other;
        };
        straight_[i] = !smooth || leans(tangents_[i]) || leans(tangents_[(i + 1) % n]) ||
                       uneven(side[(i + n - 1) % n]) || uneven(side[(i + 1) % n]);
    }
}

ClosedCurve::Sample ClosedCurve::at(double s) const {
    if (s >= length()) s -= length();
    const auto after = std::upper_bound(start_.begin() + 1, start_.end() - 1, s);
    const auto i = static_cast<std::size_t>(after - start_.begin()) - 1;
    const std::size_t j = (i + 1) % corners_.size();
    const double side = start_[i + 1] - start_[i];
    const double t = side > 0 ? std::clamp((s - start_[i]) / side, 0.0, 1.0) : 0;
    const double height = heights_[i] + t * (heights_[j] - heights_[i]);
    if (straight_[i]) return {corners_[i] + t * (corners_[j] - corners_[i]), height};
    const double r = 1 - t;
    const Vec2 ends = r * r * (1 + 2 * t) * corners_[i] + t * t * (3 - 2 * t) * corners_[j];
    const Vec2 bend = side * t * r * (r * tangents_[i] - t * tangents_[j]);
    return {ends + bend, height};
}

}  // namespace lumenline
