#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "engine/branches/partings.h"
#include "engine/core/centerlines.h"
#include "engine/core/stage_context.h"

namespace lumenline {

/// A stretch of a line between two nodes.
struct Tract {
    std::size_t line = 0;
    std::size_t first = 0, last = 0;  ///< nodes
    double own_from = 0, own_to = 0;  ///< between the parts of its two nodes [abscissa of the line]
    std::size_t edge = 0;             ///< tracts of several lines that run together are one edge
};

/// The part of a node on a line that passes through it.
struct NodePart {
    std::size_t line = 0;
    double from = 0, to = 0;  ///< [abscissa of the line]
};

/// A place where lines start, end or part.
struct SplitNode {
    EndpointId endpoint;  ///< none at a junction or where the two sides of a loop meet
    LoopId loop;          ///< set where the two sides of a loop meet
    std::vector<NodePart> parts;

    [[nodiscard]] bool is_junction() const { return endpoint.is_none() && loop.is_none(); }
};

/// A line that has no part of its own: it runs in the tube of another one to its end.
struct ContainedLine {
    static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    std::size_t in = kNone;  ///< a line that is split; kNone = this line is split itself
    double shift = 0;        ///< its abscissa on that line is its own plus this [length]
};

/// Lines cut where they leave each other's tubes (Antiga & Steinman 2004).
struct Split {
    std::vector<SplitNode> nodes;
    std::vector<Tract> tracts;             ///< line by line, in order along each
    std::vector<std::size_t> first_tract;  ///< (L+1) into tracts
    std::vector<ContainedLine> contained;  ///< (L)
    std::size_t edge_count = 0;
};

/// Splits the lines, which may share sources and, from different sources, targets.
///
/// Two lines of one source part between the touching points and the exits of both from the other's tube: the junction's
/// part on each. Where a third line runs along, its partings from both are one; junctions whose parts overlap on a line
/// are one, with more than two branches behind it: between them no branch would have a part of its own. Lines of one
/// target part in the same way, seen from their ends. Both rules are closed over all lines, so that their order does
/// not matter.
/// @cost O(L^2) partings, O(L^3) for closing; L lines
Split split_lines(const Centerlines& lines, std::span<const LineView> views, const StageContext& context);

}  // namespace lumenline
