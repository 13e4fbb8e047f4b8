#pragma once

#include <vector>

#include "engine/condition/wall_mesh.h"
#include "engine/condition/wall_topology.h"
#include "engine/core/soup.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"

namespace lumenline {

/// Triangles of the wall that close the flat end of a vessel, and their rim, directed as a Loop.
struct FlatCap {
    std::vector<std::uint32_t> triangles;  ///< ascending
    Loop rim;
};

/// Finds the flat caps of an outward oriented wall, by descending area.
///
/// A patch of connected triangles is a flat cap if it
/// - is flat: normals within 2 degrees of the first one's, vertices within a hundredth of the patch's
///   radius of its plane, both plus what the rounding of coordinates explains;
/// - is roughly a disc: one rim of at least 8 edges, no holes, at least half the area of the circle of
///   its perimeter;
/// - has a sharp rim: along 95 % of it the wall falls back from the plane by 35 degrees or more;
/// - has a lumen behind it: the wall opposite its centre is at least its radius away;
/// - touches no other such patch: the sides of a box are no caps.
/// Patches of equal cell labels (SimVascular's ModelFaceID, VMTK's CellEntityIds) are tried first, with
/// more patience: a twentieth of the radius from the plane, 75 % of the rim sharp.
/// @param soup  whose labels are looked up by the positions of the corners
/// @cost O(n log n)
std::vector<FlatCap> find_flat_caps(const WallMesh& wall, const TriangleSoup& soup);

/// Takes the flat caps out of the wall, so that their rims become loops of `topology`. Notes
/// flat_caps_opened with their number.
/// @returns the positions of the rims' vertices, for mark_flat_caps
std::vector<Vec3> open_flat_caps(WallMesh& wall, WallTopology& topology, const TriangleSoup& soup,
                                 StageContext& context);

/// Whether the wall has no opening yet: no loop but those of less than six edges, which are holes.
bool has_no_opening(const WallTopology& topology);

/// Marks the openings whose loop runs through the rim of a flat cap.
void mark_flat_caps(Surface& surface, const std::vector<Vec3>& rim);

}  // namespace lumenline
