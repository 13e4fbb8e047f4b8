#pragma once

#include <vector>

#include "engine/core/endpoints.h"
#include "engine/core/surface.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline {

/// The point of the complex nearest to some point in space.
struct NearestOnComplex {
    Vec3 point;
    double distance = 0;              ///< [length]
    std::vector<PolygonId> polygons;  ///< those that hold it, within rounding
};

/// @cost O(polygon vertices)
NearestOnComplex nearest_on_complex(const Surface& surface, const VoronoiComplex& complex, Vec3 x);

/// Anchors an endpoint in the inside of polygons: seeds are all their vertices with the exact cost.
void anchor_at_point(const Surface& surface, const VoronoiComplex& complex, const NearestOnComplex& where,
                     Endpoint& endpoint);

/// Anchors an endpoint at a vertex: its one seed.
void anchor_at_vertex(const VoronoiComplex& complex, VoronoiVertexId v, Endpoint& endpoint);

/// The vertex in whose ball x lies deepest, max R(v) - |v - x|, and that depth; for an x outside of all
/// balls the largest ball of those within `margin` of its radius of the deepest. And the deepest
/// vertex of another branch: one whose depth is within `margin` radii of the best and that no chain
/// of such vertices joins to it. `rival` is none where there is no such branch.
struct DeepestVertex {
    VoronoiVertexId vertex, rival;
    double depth = 0, rival_depth = 0;  ///< [length]; negative = outside of the ball
};

/// @cost O(V)
DeepestVertex deepest_vertex(const VoronoiComplex& complex, Vec3 x, double margin);

}  // namespace lumenline
