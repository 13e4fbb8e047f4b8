#pragma once

#include <utility>
#include <vector>

#include "engine/condition/wall_topology.h"
#include "engine/core/stage_context.h"

namespace lumenline {

/// Takes out small patches around triangles that cross each other and fills the holes they leave, where that is
/// a local matter: each new patch less than a fiftieth of the area, away from the openings, and bounded by one loop.
/// Tries one, two and three rings of triangles around. A change is kept only if fewer pairs cross afterwards and
/// components, loops and genus are as before. Notes self_intersections_repaired.
/// @param pairs  of crossing triangles of the wall
/// @returns      whether anything changed; then triangle numbers are new
bool repair_crossings(WallMesh& wall, WallTopology& topology,
                      const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs, StageContext& context);

}  // namespace lumenline
