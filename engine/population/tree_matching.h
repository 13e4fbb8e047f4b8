#pragma once

#include <cstddef>
#include <vector>

#include "engine/core/branch_labels.h"

namespace lumenline {

/// Which branches of two trees correspond, one value per branch of the first.
struct TreeMatch {
    /// Branches of the second tree; several, which follow each other, where one that leaves between them is missing in
    /// the first; none where the branch has no counterpart.
    std::vector<std::vector<std::size_t>> partners;
    /// Where one branch of the second tree stands for several of the first, since that has one more leaving between
    /// them: which of these it is, from 1; else 0.
    std::vector<std::size_t> part;
    std::vector<double> confidence;  ///< 0 to 1; NaN without counterpart
    double cost = 0;
};

/// Matches two rooted trees branch by branch, from their inlets.
///
/// Least cost over all correspondences that keep the order from the inlet: a branch and what leaves its end correspond
/// to a branch and what leaves its end, children to children by optimal assignment, whole subtrees staying without
/// counterpart at a price (Zhang 1996, Algorithmica 15:205, constrained edit distance of unordered trees); and a branch
/// may correspond to several that follow each other, the others that leave between them staying without; and one child
/// of a branch may be left out, its own children taking its place, as where a junction of three is two of two. What two
/// branches cost is half the sum of squares of the differences of log length and log radius, of their angles with the
/// branches one and two levels above, and with `axes` of the angle between them in the coordinates, each over its
/// spread (see README.md). Lengths are in units of each tree's own calibre. The branches by which nodes are reached
/// first make the tree of a network; one that closes a cycle is a leaf of it.
///
/// Confidence: 1 - exp(-m), m being what the least cost rises to, over the least, if this branch or one on its way from
/// the inlet is matched otherwise at its junction: m is the logarithm of the ratio of likelihoods of the best and the
/// next best. Two children that are alike, and all behind them, have a confidence near 0.
/// @cost O(n m) assignments of children
TreeMatch match_trees(const BranchTree& first, const BranchTree& second, bool axes);

}  // namespace lumenline
