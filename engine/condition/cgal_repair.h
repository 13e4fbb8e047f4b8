#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/condition/wall_mesh.h"

namespace lumenline {

/// Triangles with consistent orientation in which every edge and vertex is manifold.
struct OrientedSoup {
    std::vector<Corners> triangles;     ///< in the order given; a flipped one is reversed: (c, b, a)
    std::vector<std::uint32_t> source;  ///< (N') the vertex that each is or copies; the first N are themselves
};

/// CGAL's orient_polygon_soup: turns triangles so that neighbours agree, copies vertices at edges of
/// more than two triangles and where fans meet in one vertex.
OrientedSoup orient_soup(const std::vector<Corners>& triangles, std::size_t vertex_count);

/// Whether each query lies strictly inside a closed manifold.
std::vector<char> inside_closed_mesh(const std::vector<Vec3>& points, const std::vector<Corners>& triangles,
                                     std::span<const Vec3> queries);

/// Closes a loop in space, with interior vertices at the spacing of the loop when `refined`.
/// @returns nothing when CGAL finds no triangulation
std::optional<Patch> triangulate_loop(std::span<const Vec3> loop, bool refined);

}  // namespace lumenline
