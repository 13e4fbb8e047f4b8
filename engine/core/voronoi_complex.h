#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/ids.h"
#include "engine/core/vec3.h"

namespace lumenline {

/// Embedded Voronoi diagram Vor_E(P) of the sites (Antiga et al. 2003, eqs. 3-4): the complete
/// Voronoi polygons whose vertices are all inside the lumen, and the bare Voronoi edges between
/// inside vertices that bound no such polygon. Non-manifold: any number of polygons share an edge.
struct VoronoiComplex {
    std::vector<Vec3> vertices;                        ///< (V) centres of maximal empty balls [length]
    std::vector<double> ball_radius;                   ///< (V) R [length]
    std::vector<SiteId> vertex_site;                   ///< (V) one site on the ball's sphere
    std::vector<std::uint32_t> polygon_offsets;        ///< (P+1) into polygon_vertices
    std::vector<VoronoiVertexId> polygon_vertices;     ///< loops in order; two vertices = a bare edge
    std::vector<std::array<SiteId, 2>> polygon_sites;  ///< (P) the two sites it is dual to; none for a bare edge
    std::vector<std::uint32_t> vertex_offsets;         ///< (V+1) into vertex_polygons
    std::vector<PolygonId> vertex_polygons;            ///< polygons around each vertex, ascending
    std::vector<VoronoiVertexId> pole;  ///< (N sites) farthest inside Voronoi vertex; none if the site has none

    [[nodiscard]] std::size_t vertex_count() const { return vertices.size(); }
    [[nodiscard]] std::size_t polygon_count() const { return polygon_sites.size(); }

    [[nodiscard]] std::span<const VoronoiVertexId> polygon(PolygonId p) const {
        return {polygon_vertices.data() + polygon_offsets[at(p)], polygon_vertices.data() + polygon_offsets[at(p) + 1]};
    }
    [[nodiscard]] std::span<const PolygonId> polygons_of(VoronoiVertexId v) const {
        return {vertex_polygons.data() + vertex_offsets[at(v)], vertex_polygons.data() + vertex_offsets[at(v) + 1]};
    }
};

/// A point on the complex: on the edge from `a` to `b` at `a + t (b - a)`; a vertex has a == b, t = 0.
struct ComplexPoint {
    VoronoiVertexId a, b;
    double t = 0;

    [[nodiscard]] bool is_vertex() const { return a == b; }
};

inline Vec3 position(const VoronoiComplex& complex, const ComplexPoint& p) {
    return p.is_vertex() ? complex.vertices[at(p.a)] : lerp(complex.vertices[at(p.a)], complex.vertices[at(p.b)], p.t);
}

/// Ball radius on an edge. Exact: every site of the edge is equidistant from its points, so R^2 is
/// the quadratic t -> (1-t) Ra^2 + t Rb^2 - t (1-t) |b - a|^2.
inline double ball_radius(const VoronoiComplex& complex, const ComplexPoint& p) {
    const double ra = complex.ball_radius[at(p.a)];
    if (p.is_vertex()) return ra;
    const double rb = complex.ball_radius[at(p.b)];
    const double e2 = squared_norm(complex.vertices[at(p.b)] - complex.vertices[at(p.a)]);
    const double r2 = (1 - p.t) * ra * ra + p.t * rb * rb - p.t * (1 - p.t) * e2;
    return r2 > 0 ? std::sqrt(r2) : 0.0;
}

}  // namespace lumenline
