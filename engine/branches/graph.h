#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "engine/branches/split.h"
#include "engine/core/branches.h"

namespace lumenline {

/// A line's stretch that stands for a branch, or for the half of one that closes a loop.
struct Course {
    std::size_t line = 0;
    double from = 0, to = 0;  ///< own part [abscissa of the line]
    bool backward = false;    ///< the branch runs against the line
};

/// A branch before its axis is resampled.
struct BranchCourse {
    std::vector<Course> courses;           ///< in order along the branch: one, or two that meet behind a loop
    std::size_t first = 0, last = 0;       ///< nodes of the graph
    std::size_t parent = kNone;            ///< branch by which `first` was reached; kNone for a root
    std::size_t generation = 0;            ///< of a root 0
    std::size_t line_count = 0;            ///< centerlines that run through it
    double first_join = 0, last_join = 0;  ///< straight from the nodes to the own part [length]
    /// Relative difference of the extent to that of the next in order among its siblings, the smaller of both sides;
    /// NaN without siblings.
    double order_margin = std::numeric_limits<double>::quiet_NaN();
    /// Without an own part that of the straight way between the nodes; zero where they are one place.
    Vec3 first_direction, last_direction;  ///< of the own part's ends, away from their nodes, unit

    static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    [[nodiscard]] double own_length() const;
    [[nodiscard]] double length() const { return first_join + own_length() + last_join; }
};

/// Nodes and numbered branches.
struct GraphDraft {
    BranchGraph graph;
    std::vector<BranchCourse> branches;
    LinePieces pieces;
};

/// Makes the graph of the split lines.
///
/// A junction's origin is the point nearest to the axes of its branches, straight lines fitted to the lines next to the
/// junction, in the sense of least squares; it is held by a share of 1/20 to the mean of the touching points and exits,
/// weighted by the squares of the radii there. It is not farther from this mean than the mean's ball.
///
/// Branches are numbered level by level from the inlets, which come in the order of the endpoints. Those that leave a
/// node stand by descending extent: the length of the branch and all behind it, node to node. What two sides of a loop
/// have in common is one branch, that runs away from the node that is numbered first.
GraphDraft make_graph(const Split& split, const Centerlines& lines, std::span<const LineView> views);

}  // namespace lumenline
