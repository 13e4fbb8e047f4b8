#pragma once

#include "io/archive/names.h"

/// Names of /centerlines and /loops in the model file (io/ARCHIVE.md).
namespace lumenline::names {

// clang-format off
inline constexpr const char* kCenterlines = "/centerlines";
inline constexpr Field kLinePoints{"/centerlines/points", "length", "points of all lines, each from source to target"};
inline constexpr Field kLineOffsets{"/centerlines/offsets", "1", "start of each line in the arrays per point"};
inline constexpr Field kLineBallRadius{"/centerlines/ball_radius", "length",
    "radius of the largest ball around the point that holds no site"};
inline constexpr Field kClearance{"/centerlines/clearance", "length", "distance to the triangulated surface"};
inline constexpr Field kRadius{"/centerlines/radius", "length", "best estimate of the maximal inscribed ball's radius"};
inline constexpr Field kRadiusError{"/centerlines/radius_error", "length", "estimated error of radius"};
inline constexpr Field kPositionError{"/centerlines/position_error", "length",
    "estimated distance of the point from the true line; NaN = no estimate"};
inline constexpr Field kAbscissa{"/centerlines/abscissa", "length", "arc length from the line's first point"};
inline constexpr Field kLineSource{"/centerlines/source", "1", "endpoint where each line starts"};
inline constexpr Field kLineTarget{"/centerlines/target", "1", "endpoint where each line ends; -1 = at its loop"};
inline constexpr Field kLineLoop{"/centerlines/loop", "1", "loop in whose point the line ends; -1 = at its target"};
inline constexpr Field kPathPoints{"/centerlines/path/points", "length", "points of the descent paths on the complex"};
inline constexpr Field kPathOffsets{"/centerlines/path/offsets", "1", "start of each path in the arrays per point"};
inline constexpr Field kPathBallRadius{"/centerlines/path/ball_radius", "length", "radius of the Voronoi ball"};
inline constexpr Field kPathAbscissa{"/centerlines/path/abscissa", "length", "arc length of the path from its source"};
inline constexpr Field kLineAbscissa{"/centerlines/path/line_abscissa", "length",
    "abscissa of the corresponding point of the final line"};

inline constexpr Field kLoopPoint{"/loops/point", "length", "where the two sides of the loop meet"};
inline constexpr Field kLoopBallRadius{"/loops/ball_radius", "length", "of the Voronoi vertex where the fronts meet"};
inline constexpr Field kLoopTime{"/loops/arrival_time", "1", "when the fronts meet there"};
inline constexpr Field kLoopSource{"/loops/source", "1", "endpoint from which the front of its first line comes"};
// clang-format on

}  // namespace lumenline::names
