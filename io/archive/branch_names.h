#pragma once

#include "io/archive/names.h"

/// Names of /graph and of what branches add to /surface and /centerlines in the model file (io/ARCHIVE.md). The tables'
/// columns are named in engine/core/branch_tables.cpp.
namespace lumenline::names {

// clang-format off
inline constexpr Field kNodePosition{"/graph/position", "length", "of each node: end of a line, or origin of a junction"};
inline constexpr Field kNodeRadius{"/graph/radius", "length", "of the inscribed ball at an end; of the largest that comes to a junction"};
inline constexpr Field kNodeKind{"/graph/kind", "1", "end | junction"};
inline constexpr Field kNodeEndpoint{"/graph/endpoint", "1", "endpoint of an end; -1 = none"};
inline constexpr Field kNodeJunction{"/graph/junction_id", "1", "row of /bifurcations; -1 = an end"};
inline constexpr Field kEdges{"/graph/edges", "1", "first and last node of each branch, away from the inlet"};
inline constexpr Field kAxisOffsets{"/graph/axis/offsets", "1", "start of each branch's axis in the arrays per point"};
inline constexpr Field kAxisPoints{"/graph/axis/points", "length", "points of the axes, each from its first node to its last"};
inline constexpr Field kAxisRadius{"/graph/axis/radius", "length", "of the maximal inscribed ball"};
inline constexpr Field kAxisAbscissa{"/graph/axis/abscissa", "length", "from the branch's first node"};
inline constexpr Field kAxisCurvature{"/graph/axis/curvature", "1/length", "smoothed; NaN at a junction's origin"};
inline constexpr Field kAxisTorsion{"/graph/axis/torsion", "1/length", "smoothed, right-handed positive; NaN where straight"};
inline constexpr Field kAxisTangent{"/graph/axis/tangent", "1", "unit, away from the first node"};
inline constexpr Field kAxisNormal{"/graph/axis/normal", "1", "Frenet normal, unit, to the centre of curvature; NaN where straight"};
inline constexpr Field kAxisFrame{"/graph/axis/frame", "1", "direction of angle 0: unit, across the tangent, by parallel transport"};

inline constexpr Field kLineBranch{"/centerlines/branch_id", "1", "branch of each point"};
inline constexpr Field kLineJunction{"/centerlines/junction_id", "1", "junction in whose part the point lies; -1 = the branch's own part"};
inline constexpr Field kLineBranchAbscissa{"/centerlines/branch_abscissa", "length", "abscissa of the branch"};
inline constexpr Field kLineCurvature{"/centerlines/curvature", "1/length", "of the branch's axis; NaN in a junction"};
inline constexpr Field kLineTorsion{"/centerlines/torsion", "1/length", "of the branch's axis; NaN in a junction and where straight"};
inline constexpr Field kLineTangent{"/centerlines/tangent", "1", "of the branch's axis: unit, away from its first node"};
inline constexpr Field kLineFrame{"/centerlines/frame", "1", "of the branch's axis: direction of angle 0, unit"};

inline constexpr Field kSiteBranch{"/surface/branch_id", "1", "branch of centerline_point; -1 = no way"};
inline constexpr Field kSiteJunction{"/surface/junction_id", "1", "junction in whose part it lies; -1 = the branch's own part, or no way"};
inline constexpr Field kSiteLongitudinal{"/surface/branch_abscissa", "length", "abscissa of the branch at centerline_point; NaN = no way"};
inline constexpr Field kSiteRelative{"/surface/branch_abscissa_relative", "1", "the same over the branch's length, 0 to 1; NaN = no way"};
inline constexpr Field kSiteAngle{"/surface/angle", "rad", "around the branch's axis from its frame, right-handed along it; NaN = no way"};
// clang-format on

}  // namespace lumenline::names
