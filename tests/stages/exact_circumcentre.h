#pragma once

#include <array>

#include "engine/core/vec3.h"

namespace lumenline::test {

using Corners = std::array<Vec3, 4>;

/// Sphere through four points by exact rational arithmetic, rounded once at the end.
struct ExactCentre {
    Vec3 centre;
    double radius = 0;
    double relative_determinant = 0;  ///< |det| / (|a||b||c|) of the edge vectors a, b, c from the first point
};

/// Not to be asked about coplanar points unless only relative_determinant (then 0) matters.
ExactCentre exact_circumcentre(const Corners& p);

}  // namespace lumenline::test
