#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/condition/wall_mesh.h"

namespace lumenline {

struct VertexNormals {
    std::vector<Vec3> normals;       ///< (N) unit; zero where no triangle of the vertex has a direction
    std::size_t thin_triangles = 0;  ///< without a direction
};

/// Mean of the normals of each vertex's triangles, weighted by the angle. Triangles thinner than double precision or
/// `rounding` tell apart have no direction and do not count.
/// @param rounding  of the coordinates [length]
/// @cost O(N + M)
VertexNormals vertex_normals(std::span<const Vec3> points, std::span<const Corners> triangles, double rounding);

}  // namespace lumenline
