#pragma once

#include <cstddef>
#include <span>

#include "engine/core/vec3.h"

namespace lumenline::bench {

/// The yardstick: seconds of processor time in which CGAL inserts `points` into an empty sequential
/// Delaunay triangulation with vertex numbers. Preparing its input and destroying it do not count.
/// @param distinct  how many vertices there must be afterwards: the number of different points
/// @throws std::runtime_error when there are others
double bare_delaunay_seconds(std::span<const Vec3> points, std::size_t distinct);

}  // namespace lumenline::bench
