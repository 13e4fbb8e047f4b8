#pragma once

#include <cmath>
#include <limits>

#include "engine/core/vec3.h"
#include "engine/geometry/segment_cost.h"

namespace lumenline {

/// A point with its arrival time and ball radius.
struct TimedPoint {
    Vec3 x;
    double radius = 0;
    double time = 0;
};

/// Which way a front may reach a point: where on the edge it left, and when it arrives.
struct Arrival {
    double time = 0;
    double t = 0;  ///< position on the edge, 0 at a, 1 at b
};

/// Where on the edge ab a straight ray to w leaves so that the time at w is least, for a time that
/// is linear along the edge and a constant cost `f` [1/length] (Kimmel & Sethian 1998).
/// @returns t in [0, 1]; the earlier end where the edge has no length
/// @cost 10 ns
inline double planar_minimizer(Vec3 a, Vec3 b, Vec3 w, double time_a, double time_b, double f) {
    const Vec3 e = b - a;
    const double e2 = squared_norm(e);
    if (!(e2 > 0)) return time_a <= time_b ? 0.0 : 1.0;
    const double length = std::sqrt(e2);
    const double slope = (time_b - time_a) / (f * length);  // sine of the angle to the edge's normal
    if (slope >= 1) return 0;
    if (slope <= -1) return 1;
    const Vec3 q = w - a;
    const double along = dot(q, e) / e2;
    const double height2 = squared_norm(q) - along * along * e2;
    const double height = height2 > 0 ? std::sqrt(height2) : 0.0;
    const double t = along - height * slope / (std::sqrt(1 - slope * slope) * length);
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

/// Where on the edge ab of a polygon that holds w the first arrival at w starts: the minimizer for the
/// cost halfway.
inline double ray_start(const TimedPoint& a, const TimedPoint& b, Vec3 w, double radius_w) {
    return planar_minimizer(a.x, b.x, w, a.time, b.time, 2 / (radius_w + 0.5 * (a.radius + b.radius)));
}

/// Arrival at w by the ray that leaves the edge ab at t, under |grad T| = 1/R.
///
/// Its cost is exact (segment_cost), so that any start gives an upper bound and the error of the
/// start enters squared.
inline double arrival_from(const TimedPoint& a, const TimedPoint& b, Vec3 w, double radius_w, double t) {
    const double r = radius_between(a.radius, b.radius, squared_norm(b.x - a.x), t);
    return (1 - t) * a.time + t * b.time + segment_cost(distance(w, lerp(a.x, b.x, t)), r + radius_w);
}

/// First arrival at w across the edge ab of a polygon that holds all three.
/// @returns time and start of the ray; starts inside the edge only are better than vertex_arrival
inline Arrival edge_arrival(const TimedPoint& a, const TimedPoint& b, Vec3 w, double radius_w) {
    const double t = ray_start(a, b, w, radius_w);
    return {arrival_from(a, b, w, radius_w, t), t};
}

/// The same where the ray starts inside the edge; +inf, at half the cost, where it would start at an
/// end, which vertex_arrival covers.
inline double inner_arrival(const TimedPoint& a, const TimedPoint& b, Vec3 w, double radius_w) {
    const double t = ray_start(a, b, w, radius_w);
    return t > 0 && t < 1 ? arrival_from(a, b, w, radius_w, t) : std::numeric_limits<double>::infinity();
}

/// First arrival at w straight from the vertex a.
inline double vertex_arrival(const TimedPoint& a, Vec3 w, double radius_w) {
    return a.time + segment_cost(distance(w, a.x), a.radius + radius_w);
}

}  // namespace lumenline
