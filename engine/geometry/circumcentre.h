#pragma once

#include <cmath>
#include <limits>

#include "engine/core/vec3.h"

namespace lumenline {

/// Centre of the sphere through four points.
///
/// In double precision relative to the first point; where the tetrahedron is so flat that the
/// rounding would show (|det| < 1e-8 |a||b||c| for its edge vectors), again in quadruple
/// precision: structured meshes have cells whose double-precision centre is off by many radii.
/// @param reach  what is of interest [length]: where the centre is provably farther than this from the
///               first point, as for the slivers of flat caps, quadruple precision is not called for
/// @returns the centre; not finite for four coplanar points, or where it is out of reach
/// @cost 10 ns; flat tetrahedra 2 us
inline Vec3 circumcentre(Vec3 p0, Vec3 p1, Vec3 p2, Vec3 p3, double reach = std::numeric_limits<double>::infinity()) {
    const Vec3 a = p1 - p0, b = p2 - p0, c = p3 - p0;
    const double aa = squared_norm(a), bb = squared_norm(b), cc = squared_norm(c);
    const Vec3 bc = cross(b, c);
    const double det = dot(a, bc);
    if (det * det > 1e-16 * aa * bb * cc) {
        const double f = 0.5 / det;
        return p0 + f * (aa * bc + bb * cross(c, a) + cc * cross(a, b));
    }
    constexpr double kRounding = 1e-14;  // generous bound on the relative rounding of the sums below
    const double la = std::sqrt(aa), lb = std::sqrt(bb), lc = std::sqrt(cc);
    const double numerator_norm =
        norm(aa * bc + bb * cross(c, a) + cc * cross(a, b)) - kRounding * (la + lb + lc) * la * lb * lc;
    if (numerator_norm > 2 * reach * (std::fabs(det) + kRounding * la * lb * lc)) {
        constexpr double kFar = std::numeric_limits<double>::infinity();
        return {kFar, kFar, kFar};
    }
    using Quad = __float128;
    const Quad q[3][3] = {{Quad(p1.x) - p0.x, Quad(p1.y) - p0.y, Quad(p1.z) - p0.z},
                          {Quad(p2.x) - p0.x, Quad(p2.y) - p0.y, Quad(p2.z) - p0.z},
                          {Quad(p3.x) - p0.x, Quad(p3.y) - p0.y, Quad(p3.z) - p0.z}};
    auto cross_component = [&q](int i, int j, int k) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        return q[i][l] * q[j][m] - q[i][m] * q[j][l];
    };
    Quad square[3];
    for (int i = 0; i < 3; ++i) square[i] = q[i][0] * q[i][0] + q[i][1] * q[i][1] + q[i][2] * q[i][2];
    Quad determinant = 0;
    for (int k = 0; k < 3; ++k) determinant += q[0][k] * cross_component(1, 2, k);
    double offset[3];
    for (int k = 0; k < 3; ++k) {
        const Quad numerator = square[0] * cross_component(1, 2, k) + square[1] * cross_component(2, 0, k) +
                               square[2] * cross_component(0, 1, k);
        offset[k] = determinant != 0 ? static_cast<double>(numerator / (2 * determinant)) : std::nan("");
    }
    return p0 + Vec3{offset[0], offset[1], offset[2]};
}

/// Is the tetrahedron no higher than `height` over its largest face? Where that is what rounding makes of
/// four points on a circle, its centre is anywhere on the circle's axis.
/// @cost 5 ns
inline bool is_flat(Vec3 p0, Vec3 p1, Vec3 p2, Vec3 p3, double height) {
    const Vec3 a = p1 - p0, b = p2 - p0, c = p3 - p0;
    const double det = dot(a, cross(b, c)), h2 = height * height;
    const double aa = squared_norm(a), bb = squared_norm(b), cc = squared_norm(c);
    const double longest = std::fmax(aa, std::fmax(bb, cc));
    if (det * det > 16 * h2 * longest * longest) return false;  // no face is larger
    const double face = std::fmax(std::fmax(squared_norm(cross(a, b)), squared_norm(cross(b, c))),
                                  std::fmax(squared_norm(cross(c, a)), squared_norm(cross(b - a, c - a))));
    return det * det <= h2 * face;
}

}  // namespace lumenline
