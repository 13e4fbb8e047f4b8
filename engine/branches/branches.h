#pragma once

#include "engine/core/branch_options.h"
#include "engine/core/branch_tables.h"
#include "engine/core/centerlines.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"
#include "engine/core/surface_character.h"

namespace lumenline {

/// Branches, junctions and their measures from the lines: split.h, graph.h, axes.h, measures.h, wall.h, sections.h,
/// junctions.h, calibre.h say how.
/// @param character  of the surface; null = nothing that needs to know which branch a site belongs to
Branches find_branches(const Surface& surface, const Centerlines& centerlines, const SurfaceCharacter* character,
                       const BranchOptions& options, StageContext& context);

}  // namespace lumenline
