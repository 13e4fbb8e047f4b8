#pragma once

#include <vector>

#include "engine/branches/branches.h"
#include "engine/core/centerlines.h"
#include "engine/phantom/tree.h"

namespace lumenline::test {

/// A line given by points and radii, for lines that come from no surface.
struct PlainLine {
    std::vector<Vec3> points;
    std::vector<double> radius;
    std::size_t source = 0;
    std::size_t target = Index<int>::kNoneValue;  ///< endpoint, or kNoneValue: the line ends at its loop
    std::size_t loop = Index<int>::kNoneValue;
};

/// Appends the straight way to `to` in steps of `step`, with radii going linearly to `radius`.
void go_to(PlainLine& line, Vec3 to, double radius, double step);

Centerlines centerlines_of(const std::vector<PlainLine>& lines);

/// Branches of lines alone: an empty surface, no characterization.
Branches branches_of(const std::vector<PlainLine>& lines, const BranchOptions& options = {});

/// A tree of straight lines with `leaves` leaves, a power of two, whose inner branches fork at right angles. One line
/// per leaf; lengths and radii of siblings differ.
std::vector<PlainLine> forked_lines(std::size_t leaves);

/// The whole pipeline on a tree phantom.
struct TreeModel {
    TreePhantom tree;
    Branches branches;
};
TreeModel tree_model(const TreeOptions& options);

/// Branch of `found` for each branch of the tree, by the middle of its axis; kNone if there is not exactly one.
std::vector<BranchId> matched(const TreeTruth& truth, const Branches& found);

/// Holds lengths, radii, tapers, junctions and numbers against the truth.
void expect_branches_of_tree(const TreeTruth& truth, const Branches& found);

}  // namespace lumenline::test
