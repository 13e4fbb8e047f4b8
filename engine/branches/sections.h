#pragma once

#include "engine/branches/section_cutter.h"
#include "engine/core/branch_options.h"
#include "engine/core/branch_tables.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"

namespace lumenline {

/// Sections across the own parts of all branches: `section_step` mean radii apart, the first and last half of that from
/// the own part's ends, and one where the axis's radius is least. Where no boundary goes around the axis's point, rows
/// hold NaN, and the finding section_not_found tells how many. A section whose boundary is for more than half wall of
/// other branches is not of this vessel: it does not count as closed.
/// @param sites  of the surface; empty = no site is known to be near, and all wall counts as the branch's
/// @cost O(sites + triangles cut)
SectionTable cut_sections(const Surface& surface, const BranchAxes& branches, const SurfaceBranches& sites,
                          const BranchOptions& options, StageContext& context);

}  // namespace lumenline
