#pragma once

#include <array>
#include <span>

#include "engine/core/vec3.h"

namespace lumenline {

/// Symmetric 3 x 3 matrix: xx, yy, zz, xy, xz, yz.
using SymmetricMatrix = std::array<double, 6>;

inline Vec3 times(const SymmetricMatrix& m, Vec3 a) {
    return {m[0] * a.x + m[3] * a.y + m[4] * a.z, m[3] * a.x + m[1] * a.y + m[5] * a.z,
            m[4] * a.x + m[5] * a.y + m[2] * a.z};
}

/// Quadric through a site, gradient . w + w . matrix w = 0, w measured from the site.
struct Quadric {
    Vec3 gradient;             ///< at the site, out of the lumen, about unit
    SymmetricMatrix matrix{};  ///< [1/length]
    /// How much better than a plane the quadric predicts neighbours that are left out of its fit:
    /// 1 - (mean squares of its errors) / (those of a plane), 0 to 1.
    double share = 0;
    /// Where its neighbours, without it, would put the site: height above it along the normal [length].
    /// As large as the noise of sites, or else as what a quadric cannot follow.
    double offset = 0;
};

/// Least squares fit to a site's neighbours, weighted by 1 / distance^2.
/// Of plane, paraboloid and quadric, the one is taken that predicts left-out neighbours best.
/// @param around  neighbours relative to the site [length]
/// @param normal  unit outward normal of the surface at the site, roughly
/// @returns the plane of `normal`, share 0, where neighbours are too few or of no extent
/// @cost 2 us for two rings
Quadric fit_quadric(std::span<const Vec3> around, Vec3 normal);

}  // namespace lumenline
