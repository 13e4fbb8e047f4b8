#pragma once

#include "engine/condition/wall_mesh.h"
#include "engine/core/soup.h"
#include "engine/core/stage_context.h"

namespace lumenline {

/// Joins vertices that are equal or closer than `tolerance` times the diagonal of the bounding box;
/// the one of lowest index stays, with its coordinates. Then drops triangles with a repeated vertex,
/// repetitions of a triangle (in any orientation; the first stays) and unused vertices, each with a
/// note that counts them.
/// @param drop_faces  false: refuse such triangles
/// @throws StageError kNoSurface when nothing is left, kBadCoordinate for coordinates that are not finite or
///         beyond 1e20, or all within 1e-20 of each other, kTooLarge, kRepairOff
/// @cost O(n log n) time unless more than a few vertices lie within the tolerance of one plane
WallMesh weld_soup(const TriangleSoup& soup, double tolerance, bool drop_faces, StageContext& context);

}  // namespace lumenline
