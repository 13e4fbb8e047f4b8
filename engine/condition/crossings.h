#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/condition/wall_mesh.h"

namespace lumenline {

/// Pairs of triangles of a closed manifold that meet elsewhere than in a common vertex or edge, the
/// lower first, in ascending order; at most `limit`. Triangles without area are left out.
/// @cost O(n log^3 n) at worst; about a third of a Delaunay triangulation of the points
std::vector<std::pair<std::uint32_t, std::uint32_t>> crossing_triangles(const std::vector<Vec3>& points,
                                                                        const std::vector<Corners>& triangles,
                                                                        std::size_t limit);

}  // namespace lumenline
