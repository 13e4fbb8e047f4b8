#pragma once

#include <span>
#include <vector>

#include "engine/branches/graph.h"
#include "engine/core/branch_tables.h"

namespace lumenline {

/// Points of the own part of a branch, with the arc length that each stands for.
struct OwnPart {
    std::size_t begin = 0, end = 0;  ///< points of the axis
    std::vector<double> weight;      ///< [length]
};
OwnPart own_part(const BranchLines& axes, std::size_t branch);

/// Rows of all branches: what the axes tell. Columns that need the wall or sections are NaN.
BranchTable measure_axes(const GraphDraft& draft, const BranchLines& axes);

/// Sets the distribution of the areas of closed sections.
void measure_areas(const SectionTable& sections, BranchTable& table);

}  // namespace lumenline
