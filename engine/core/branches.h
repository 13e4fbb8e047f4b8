#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/core/ids.h"
#include "engine/core/surface_character.h"
#include "engine/core/vec3.h"

namespace lumenline {

using BranchId = Index<struct BranchTag>;      ///< stretch of vessel between two nodes
using NodeId = Index<struct NodeTag>;          ///< end of branches
using JunctionId = Index<struct JunctionTag>;  ///< node where three branches or more meet

/// The branches as a graph; an edge is a branch. Cycles are allowed.
struct BranchGraph {
    std::vector<Vec3> position;        ///< (G) of nodes: the end of a line, or the origin of a junction [length]
    std::vector<double> radius;        ///< (G) of the inscribed ball at an end, of the parent there [length]
    std::vector<EndpointId> endpoint;  ///< (G) none at a junction
    std::vector<JunctionId> junction;  ///< (G) none at an end
    std::vector<std::array<NodeId, 2>> edges;  ///< (B) first and last node of each branch, away from the inlet

    [[nodiscard]] std::size_t node_count() const { return position.size(); }
    [[nodiscard]] std::size_t branch_count() const { return edges.size(); }
};

/// Axes of the branches, resampled. A line runs from the origin of its first node to that of its last; the points
/// between belong to its own part, which is in no junction. Values that are not defined are NaN.
struct BranchLines {
    std::vector<std::uint32_t> offsets;  ///< (B+1) into the arrays below
    std::vector<Vec3> points;            ///< (J) [length]
    std::vector<double> radius;          ///< (J) of the inscribed ball [length]
    std::vector<double> abscissa;        ///< (J) from the branch's first node [length]
    std::vector<double> curvature;       ///< (J) [1/length]; NaN at a junction's origin
    std::vector<double> torsion;         ///< (J) [1/length], right-handed positive; NaN where the line is straight
    std::vector<Vec3> tangent;           ///< (J) unit, away from the first node
    std::vector<Vec3> normal;            ///< (J) unit, to the centre of curvature (Frenet); NaN where straight
    std::vector<Vec3> frame;             ///< (J) unit, across the tangent: direction of angle 0, by parallel transport
    std::vector<double> own_from;        ///< (B) abscissa where the first junction's part ends [length]
    std::vector<double> own_to;          ///< (B) abscissa where the last junction's part begins [length]

    [[nodiscard]] std::size_t branch_count() const { return own_from.size(); }
    [[nodiscard]] double length(std::size_t b) const { return abscissa[offsets[b + 1] - 1]; }
};

/// Where on the branches the centerlines run: pieces in order along each line, which cover it.
struct LinePieces {
    std::vector<std::uint32_t> offsets;  ///< (L+1) into the arrays below
    std::vector<double> from, to;        ///< (T) abscissa of the line [length]
    std::vector<BranchId> branch;        ///< (T)
    std::vector<double> branch_from;     ///< (T) abscissa of the branch at `from` [length]
    std::vector<double> branch_to;       ///< (T) at `to`; linear between; may be less than at `from` [length]
    std::vector<JunctionId> junction;    ///< (T) whose part it is; none = the branch's own part
};

/// What the centerlines' points belong to, one value per point.
struct LineBranches {
    std::vector<BranchId> branch;         ///< (K)
    std::vector<JunctionId> junction;     ///< (K) none = the branch's own part
    std::vector<double> branch_abscissa;  ///< (K) of the branch [length]
    std::vector<double> curvature;        ///< (K) of the branch's axis there [1/length]
    std::vector<double> torsion;          ///< (K) [1/length]
    std::vector<Vec3> tangent;            ///< (K) unit, away from the branch's first node
    std::vector<Vec3> frame;              ///< (K) direction of angle 0, unit
};

/// Branches and where lines run on them.
struct BranchAxes {
    BranchGraph graph;
    BranchLines lines;
    LinePieces pieces;
    LineBranches points;
};

}  // namespace lumenline
