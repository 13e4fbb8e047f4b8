#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/core/errors.h"
#include "engine/core/vec3.h"

namespace lumenline {

/// Corners of one triangle.
using Corners = std::array<std::uint32_t, 3>;

/// Boundary vertices of one hole, in the direction of the boundary half-edges: the hole lies to the
/// left, so that a triangle closing the hole runs along the loop and not against it.
using Loop = std::vector<std::uint32_t>;

/// The wall while it is being conditioned.
struct WallMesh {
    std::vector<Vec3> points;                 ///< (N) [length]
    std::vector<Corners> triangles;           ///< (M)
    std::vector<std::uint32_t> input_vertex;  ///< (N) vertex of the soup; copies of one vertex share it
};

/// Triangles that close one opening. Vertices 0 .. loop.size() - 1 are the loop's, the following
/// ones are `points`; triangles are oriented as the loop is.
struct Patch {
    std::vector<Vec3> points;
    std::size_t extension_points = 0;  ///< the first so many of `points` lie on the extension, the others in the cap
    std::vector<Corners> triangles;
};

/// Length of the diagonal of the bounding box of `points` [length]; 0 if there are none.
double bounding_diagonal(const std::vector<Vec3>& points);

/// Drops vertices that no triangle uses; the others keep their order.
/// @returns the new number of each vertex, kDropped if it is gone
std::vector<std::uint32_t> drop_unused_vertices(WallMesh& wall);

inline constexpr std::uint32_t kDropped = 0xffffffffU;

/// Throws the StageError of this stage.
[[noreturn]] void refuse(ErrorCode code, const std::string& sentence);

}  // namespace lumenline
