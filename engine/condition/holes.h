#pragma once

#include <vector>

#include "engine/condition/wall_topology.h"
#include "engine/core/stage_context.h"

namespace lumenline {

/// A hole closed without an extension: part of the wall.
struct FilledHole {
    Loop loop;
    Patch patch;
};

/// Takes the tiny holes out of `loops` and closes them, each with a warning (hole_filled): loops of fewer
/// than six edges and an extent below three median edges that are no end of a vessel, being triangles,
/// slits, or in the plane of the wall around them. Vertices that had to be added are the patch's.
/// Warns (opening_in_wall) of larger loops in the plane of the wall. Needs outward orientation.
std::vector<FilledHole> fill_tiny_holes(const WallMesh& wall, double median_edge, std::vector<Loop>& loops,
                                        StageContext& context);

}  // namespace lumenline
