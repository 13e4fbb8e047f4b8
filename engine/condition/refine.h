#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/condition/wall_topology.h"
#include "engine/core/stage_context.h"

namespace lumenline {

/// What refinement added. Points below `first_added` are those of before, unchanged.
struct Refined {
    std::uint32_t first_added = kDropped;
    std::vector<std::array<std::uint32_t, 2>> ends;  ///< of each added point: the edge that it halves
    std::vector<Vec3> shift;                         ///< of each: from the middle of the edge to its place [length]
};

/// Puts the added points that `flat` marks, and those they stand between, onto the middle of their edges.
/// @param flat  one per point of the wall
/// @returns     whether that changes anything
bool flatten_points(WallMesh& wall, Refined& refined, std::vector<char> flat);

/// Adds points where triangles are large for the vessel: where the largest empty ball would reach beyond the
/// wall by more than a twentieth of its radius. Edges are halved, at most three times, at points
/// of the curved surface that the normals at their ends suggest; added points have no `input_vertex`. Loops and
/// components are kept up to date. Notes undersampled_refined with the count of triangles, points and the coarsest
/// place. Needs outward orientation.
/// @cost a tree of boxes and a query per triangle
Refined refine_undersampled(WallMesh& wall, WallTopology& topology, StageContext& context);

}  // namespace lumenline
