#pragma once

#include "engine/branches/graph.h"
#include "engine/core/branch_tables.h"

namespace lumenline {

/// One row per junction, in the order of JunctionId. Directions are those of straight axes fitted to the own parts next
/// to it, diameters the medians of the inscribed balls' over two radii there.
BifurcationTable measure_junctions(const GraphDraft& draft, const BranchLines& axes);

/// The exponent x of d_p^x = sum of d_i^x (Murray 1926 has x = 3); NaN where a child is as wide as the parent.
/// @param ratios  of the children's diameters to the parent's
double murray_exponent(const std::vector<double>& ratios);

}  // namespace lumenline
