#pragma once

#include <vector>

#include "engine/condition/wall_mesh.h"

namespace lumenline {

/// Least cosine between the direction of a vessel and the normal of its end. A loop whose normal is farther from it
/// lies in the wall.
inline constexpr double kLeastAlong = 0.34;

/// Where the vessel behind each loop runs to: across the normals of the wall within one radius of the loop.
///
/// @returns unit, on the side of the loop's normal; zero where no direction is definite, as where the wall within that
///          reach tapers by more than 15 degrees, bends sharply or belongs to another vessel
/// @cost O(N + M), and O(n log n) of the n vertices around the loops
std::vector<Vec3> wall_directions(const WallMesh& wall, const std::vector<Loop>& loops);

/// Area vector of a loop: along its normal, of twice the length of its area [length^2].
Vec3 doubled_area(const WallMesh& wall, const Loop& loop);

}  // namespace lumenline
