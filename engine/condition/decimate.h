#pragma once

#include "engine/condition/wall_mesh.h"
#include "engine/core/stage_context.h"

namespace lumenline {

/// Coarsens the wall by collapsing edges in the order of their quadric error, as long as the surface stays within
/// `error` [length] of every point of before. Boundary loops stay; kept points keep their places.
/// Notes decimated with the counts before and after.
/// @throws StageError kNonManifold when a triangle does not fit
void decimate_wall(WallMesh& wall, double error, StageContext& context);

}  // namespace lumenline
