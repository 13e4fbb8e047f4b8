#pragma once

#include "engine/core/branch_options.h"
#include "engine/core/branch_tables.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"
#include "engine/core/surface_character.h"

namespace lumenline {

/// Branch and coordinates of each site, by its point c(p) on a line (eq. 7), not by the nearest line.
SurfaceBranches coordinates_of(const Surface& surface, const SurfaceCharacter& character, const BranchAxes& branches,
                               const StageContext& context);

/// Sets wall area, volume and the means of distances of all branches in `table`, over sites of zone wall whose c(p) is
/// in the branch's own part.
///
/// The volume is that of the prisms between the triangles of the wall and the points of the axis that their corners
/// belong to: together they fill the lumen.
void measure_wall(const Surface& surface, const SurfaceCharacter& character, const BranchAxes& branches,
                  const SurfaceBranches& sites, BranchTable& table);

/// Means over patches, of sites of zone wall, junction parts included.
PatchTable measure_patches(const Surface& surface, const SurfaceCharacter& character, const BranchAxes& branches,
                           const SurfaceBranches& sites, const BranchOptions& options);

}  // namespace lumenline
