#pragma once

#include "engine/condition/wall_topology.h"
#include "engine/core/stage_context.h"

namespace lumenline {

/// Closes the holes among the loops and takes them out of the list, each with a warning (hole_filled). Holes are
/// loops of fewer than six edges and an extent below three median edges that are no end of a vessel, being
/// triangles, slits, or in the plane of the wall around them; and larger loops in the plane of the wall of less than
/// 0.4 of the radius of the vessel there, unless they are even circles of many edges. All others stay as openings;
/// warns (opening_in_wall) of those in the plane of the wall or across the vessel's direction, and then notes the
/// counts (boundary_loops). Points that had to be added belong to the wall and have no `input_vertex`. Needs outward
/// orientation.
void fill_holes(WallMesh& wall, WallTopology& topology, double median_edge, StageContext& context);

}  // namespace lumenline
