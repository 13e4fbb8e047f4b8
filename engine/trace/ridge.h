#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/core/vec3.h"

namespace lumenline {

/// Bound on the radius of a ball around a node by one place of the wall, as the node moves by y in its section:
/// radius <= value + gradient . y + y . hessian y / 2.
struct WallBound {
    double value = 0;                  ///< distance of the node to the place [length]
    std::array<double, 2> gradient{};  ///< along the section's axes
    std::array<double, 3> hessian{};   ///< 11, 12, 22; negative semidefinite [1/length]
};

/// A node of a line, free to move in its section.
struct RidgeNode {
    Vec3 position;
    std::array<Vec3, 2> axes;           ///< unit, of the section
    double radius = 0;                  ///< in: scale of the node; out: of the largest ball within the bounds [length]
    double reach = 0;                   ///< largest move along an axis; 0 = the node stays [length]
    std::uint32_t first = 0, last = 0;  ///< its bounds
    std::array<double, 2> move{};       ///< out: along the axes [length]
};

/// A line between ridges of the distance to the wall.
struct RidgeProblem {
    std::vector<RidgeNode> nodes;
    std::vector<WallBound> bounds;
};

/// Moves the nodes to minimise the cost, sum 2 atanh(L / (R1 + R2)) over the segments, with each radius
/// the least of its node's bounds.
///
/// Where bounds of all directions meet, as on the axis of a round tube, they hold the node; where only
/// two opposite ones do, as on the sheet of a flat tube, the node is held across the sheet and free
/// along it but for the bounds' curvature and the tension of the line: no case is told from another.
/// @param accuracy  of moves and radii, relative to the radius
/// @returns false where no step could be made: the nodes are left as they were
/// @cost 15 to 25 steps of O(nodes + bounds)
bool solve_ridge(RidgeProblem& problem, double accuracy);

}  // namespace lumenline
