#pragma once

#include <cstdint>
#include <vector>

#include "engine/condition/wall_mesh.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"

namespace lumenline {

/// Median over the edges of all triangles [length].
double median_edge(const WallMesh& wall);

/// Checks that each edge has two triangles that run opposite ways and each vertex one fan, and that all
/// coordinates are finite; sets the genus.
/// @throws StageError kNotClosed, kNonManifold, kBadCoordinate
void verify_closed(Surface& surface);

/// Sets the unit outward normal of each site: mean of its triangles' normals, weighted by the angle.
/// Triangles thinner than the rounding of coordinates have no direction and do not count (note
/// zero_area_triangles); a site of such triangles only takes the mean of its neighbours.
void compute_normals(Surface& surface, StageContext& context);

}  // namespace lumenline
