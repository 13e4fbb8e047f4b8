#pragma once

#include "engine/condition/wall_mesh.h"
#include "engine/core/condition_options.h"
#include "engine/core/stage_context.h"

namespace lumenline {

/// Makes neighbouring triangles agree in orientation, and every edge and vertex manifold by copying
/// vertices (appended, with the `input_vertex` of their original). Leaves a mesh that is so already
/// untouched; otherwise warns (non_manifold_split, triangles_reoriented) with counts.
/// @returns the number of vertices copied
/// @throws StageError kNonManifold for a one-sided surface; kRepairOff for what `options` do not let it do
std::size_t make_oriented_manifold(WallMesh& wall, const ConditionOptions& options, StageContext& context);

}  // namespace lumenline
