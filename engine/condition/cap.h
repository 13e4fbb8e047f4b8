#pragma once

#include <optional>
#include <vector>

#include "engine/condition/planar.h"
#include "engine/condition/wall_mesh.h"

namespace lumenline {

/// Whether a polygon is simple and counter-clockwise.
bool is_simple_polygon(const std::vector<Vec2>& polygon);

/// Triangles of a simple polygon and a lattice of points inside it.
struct PlanarCap {
    std::vector<Vec2> interior;
    std::vector<Corners> triangles;  ///< 0 .. n - 1 = corners of the polygon, then `interior`; counter-clockwise
};

/// Constrained Delaunay triangulation of a polygon, with interior points on a triangular lattice of
/// spacing `edge` around the origin of the plane, slightly displaced; no vertex is added on a side.
/// @param seed  makes the displacement of each cap its own
/// @returns     nothing when the polygon is not simple and counter-clockwise
std::optional<PlanarCap> cap_polygon(const std::vector<Vec2>& polygon, double edge, std::uint32_t seed);

/// Value at `q`, inside, of mean value coordinates: smooth, linear along the sides.
double interpolate_inside(const std::vector<Vec2>& polygon, const std::vector<double>& values, Vec2 q);

}  // namespace lumenline
