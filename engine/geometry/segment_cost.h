#pragma once

#include <cmath>

#include "engine/core/vec3.h"

namespace lumenline {

/// Integral of 1/R along a straight segment inside one Voronoi polygon.
///
/// On the polygon dual to the sites (p, q) the ball radius is exactly R(x) = |x - p|, so that the
/// integral over a segment of length L between points of radii R1, R2 is 2 atanh(L / (R1 + R2)).
/// @param length      L [length]; less than R1 + R2 within a polygon
/// @param radius_sum  R1 + R2 [length]
/// @returns dimensionless; large but finite where L reaches R1 + R2 by rounding
inline double segment_cost(double length, double radius_sum) {
    const double y = length / radius_sum;
    if (y < 0.1) {  // the series is faster than the logarithm, and exact to rounding here
        const double q = y * y;
        const double tail = 1.0 / 7 + q * (1.0 / 9 + q * (1.0 / 11 + q * (1.0 / 13)));
        return 2 * y * (1 + q * (1.0 / 3 + q * (1.0 / 5 + q * tail)));
    }
    constexpr double kLargest = 1 - 1e-15;
    const double z = y < kLargest ? y : kLargest;
    return std::log((1 + z) / (1 - z));
}

/// Radius at a + t (b - a) inside one polygon from the radii at a and b: R^2 is quadratic in t.
inline double radius_between(double radius_a, double radius_b, double length2, double t) {
    const double r2 = (1 - t) * radius_a * radius_a + t * radius_b * radius_b - t * (1 - t) * length2;
    return r2 > 0 ? std::sqrt(r2) : 0.0;
}

}  // namespace lumenline
