#pragma once

#include "engine/condition/wall_topology.h"
#include "engine/core/condition_options.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"

namespace lumenline {

/// Removes scraps: open components of less than a twentieth of the area of which more than a tenth of
/// the edges are boundary, such as fins split off and loose triangles. Warns (fragment_removed). Removes none
/// if they are more than a twentieth of the area: then the surface was never joined.
void remove_fragments(WallMesh& wall, WallTopology& topology, StageContext& context);

/// Refuses a wall that is no lumen with openings but loose or flat triangles.
/// @throws StageError kOpenBoundary when more than a tenth of a component's edges are boundary edges,
///         or when a component is a sheet hardly larger than its hole
void refuse_loose_triangles(const WallMesh& wall, const WallTopology& topology);

/// Removes components of less than `share` of the area. Warns (speck_removed). Removes none if they are more than a
/// twentieth of the area: then the surface was never joined.
void remove_specks(WallMesh& wall, WallTopology& topology, double share, StageContext& context);

/// Keeps the components that `policy` asks for. Warns (component_dropped).
/// @throws StageError kSeveralComponents where the policy allows one only
void select_components(WallMesh& wall, WallTopology& topology, ComponentPolicy policy, StageContext& context);

/// Turns the components whose volume, with each hole closed by a fan, is negative. Notes
/// orientation_flipped; loops are turned with their component.
/// @throws StageError kRepairOff if there are any and `allowed` is false
void turn_outward(WallMesh& wall, WallTopology& topology, bool allowed, StageContext& context);

/// Warns (multiple_components) when there is more than one component.
/// @param component  of each site
/// @throws StageError kNoVolume when a component encloses none; kNestedComponents when one lies inside another
void check_components(const Surface& surface, const std::vector<std::uint32_t>& component, std::uint32_t count,
                      StageContext& context);

}  // namespace lumenline
