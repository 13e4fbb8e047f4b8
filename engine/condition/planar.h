#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/vec3.h"

namespace lumenline {

/// Point of a plane [length].
struct Vec2 {
    double x = 0, y = 0;
    constexpr bool operator==(const Vec2&) const = default;
};

constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
constexpr Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.y}; }
constexpr double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
constexpr double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
inline double norm(Vec2 a) { return std::sqrt(dot(a, a)); }

/// Right-handed orthonormal axes of a plane in space.
struct Frame {
    Vec3 origin, u, v, normal;

    [[nodiscard]] Vec2 project(Vec3 p) const { return {dot(p - origin, u), dot(p - origin, v)}; }
    [[nodiscard]] double height(Vec3 p) const { return dot(p - origin, normal); }
    [[nodiscard]] Vec3 lift(Vec2 q, double h) const { return origin + q.x * u + q.y * v + h * normal; }
};

/// Side of a polygon.
struct Side {
    Vec2 a, b;
};

/// Signed distance to the nearest of `sides`, positive inside the polygon; infinite if there are none.
/// Right if `sides` holds all sides of a closed polygon that reach the height q.y. @cost linear
double depth_among(const std::vector<Side>& sides, Vec2 q);

std::vector<Side> sides_of(const std::vector<Vec2>& polygon);

/// Value in [-1, 1) that depends on the three numbers alone and looks random.
double wobble(std::uint32_t a, std::uint32_t b, std::uint32_t c);

/// Smooth closed curve through the corners of a polygon with a height at each, by the length along
/// the polygon. Between corners it is a cubic with Catmull-Rom tangents, or straight where the
/// polygon turns sharply or its sides differ much.
class ClosedCurve {
public:
    ClosedCurve(const std::vector<Vec2>& corners, const std::vector<double>& heights, bool smooth);

    struct Sample {
        Vec2 point;
        double height = 0;
    };
    /// The curve at `s` in [0, 2 length()).
    [[nodiscard]] Sample at(double s) const;
    [[nodiscard]] double length() const { return start_.back(); }
    /// Position of each corner, then the length: n + 1 ascending values.
    [[nodiscard]] const std::vector<double>& starts() const { return start_; }

private:
    std::vector<Vec2> corners_, tangents_;
    std::vector<double> heights_, start_;
    std::vector<char> straight_;
};

}  // namespace lumenline
