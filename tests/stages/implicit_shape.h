#pragma once

#include <functional>

#include "engine/core/soup.h"

namespace lumenline::test {

/// Distance to the wall, negative inside; no more than about that.
using Implicit = std::function<double(Vec3)>;

/// To a tube around a circle in a plane across z.
double tube_around_ring(Vec3 x, Vec3 centre, double ring, double tube);

/// To a straight tube with round ends.
double straight_tube(Vec3 x, Vec3 a, Vec3 b, double tube);

/// The wall by marching tetrahedra, six to a cube: closed but where the box cuts the lumen. Its vertices lie on the
/// edges of a grid and keep off their ends, which moves them by up to a seventh of the step.
TriangleSoup polygonized(const Implicit& shape, Vec3 low, Vec3 high, double step);

}  // namespace lumenline::test
