#pragma once

#include <cmath>

namespace lumenline {

/// Point or vector in space, in the length unit of the model.
struct Vec3 {
    double x = 0, y = 0, z = 0;

    constexpr bool operator==(const Vec3&) const = default;
    constexpr double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    constexpr double& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
    constexpr Vec3& operator+=(Vec3 b) { return *this = {x + b.x, y + b.y, z + b.z}; }
};

constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
constexpr double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
constexpr double squared_norm(Vec3 a) { return dot(a, a); }
inline double norm(Vec3 a) { return std::sqrt(dot(a, a)); }
inline double distance(Vec3 a, Vec3 b) { return norm(a - b); }
constexpr Vec3 lerp(Vec3 a, Vec3 b, double t) { return a + t * (b - a); }

/// `a` scaled to length one; the zero vector stays zero.
inline Vec3 normalized(Vec3 a) {
    const double length = norm(a);
    return length > 0 ? (1 / length) * a : a;
}

/// Some unit vector perpendicular to the unit vector `n`; a continuous choice is impossible.
inline Vec3 any_perpendicular(Vec3 n) {
    return normalized(std::fabs(n.x) < 0.7 ? cross(n, {1, 0, 0}) : cross(n, {0, 1, 0}));
}

}  // namespace lumenline
