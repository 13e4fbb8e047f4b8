#pragma once

#include "engine/branches/graph.h"
#include "engine/core/branch_tables.h"

namespace lumenline {

/// One row per junction, in the order of JunctionId, and one per child. Directions are those of straight axes fitted to
/// the own parts next to it. Diameters are those at the node: the inscribed balls' of the nearest ten radii of the own
/// part, carried to it by repeated medians; of an own part shorter than the way there the median of the nearest two.
void measure_junctions(const GraphDraft& draft, const BranchLines& axes, BifurcationTable& junctions,
                       ChildTable& children);

/// The exponent x of d_p^x = sum of d_i^x (Murray 1926 has x = 3); NaN where a child is as wide as the parent.
/// @param ratios  of the children's diameters to the parent's
double murray_exponent(const std::vector<double>& ratios);

}  // namespace lumenline
