#pragma once

#include <cstdint>
#include <vector>

#include "engine/condition/wall_mesh.h"

namespace lumenline {

/// Loops and components of a manifold wall.
struct WallTopology {
    std::vector<Loop> loops;               ///< in the order of their lowest vertex, with which each begins
    std::vector<std::uint32_t> component;  ///< (N) of each vertex, numbered by lowest vertex
    std::uint32_t component_count = 0;
};

/// Builds the half-edge kernel and reads loops and components from it.
/// @throws StageError kNonManifold when a triangle does not fit, with its position
WallTopology analyse_wall(const WallMesh& wall);

/// Joins the copies of one vertex that lie on one loop, and splits the loop there: two holes that
/// touch in a vertex become two loops, and a slit closes. Unused copies are dropped.
void pinch_loops(WallMesh& wall, WallTopology& topology);

}  // namespace lumenline
