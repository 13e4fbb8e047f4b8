#pragma once

#include "engine/phantom/tree.h"

namespace lumenline::test {

/// Every stage on a tree with open ends: all leaves reached, each line along the axes of its branches;
/// prints the mean errors away from junctions and holds them against the bounds.
void expect_axes_of_tree(const TreeOptions& options);

}  // namespace lumenline::test
