// Anchors in the inside of a polygon offer their seeds with the exact cost; those at a vertex are their one seed.
#include "engine/endpoints/anchor.h"

#include <algorithm>
#include <limits>

#include "engine/geometry/nearest_on_polygon.h"
#include "engine/geometry/segment_cost.h"

namespace lumenline {

namespace {

/// Ball radius at a point of the complex: the distance to a site of its polygon, or on a bare edge
/// the quadratic of edges.
double radius_at(const Surface& surface, const VoronoiComplex& complex, const NearestOnComplex& where) {
    const PolygonId p = where.polygons.front();
    if (const SiteId site = complex.polygon_sites[at(p)][0]; !site.is_none())
        return distance(where.point, surface.points[at(site)]);
    const VoronoiVertexId a = complex.polygon(p)[0], b = complex.polygon(p)[1];
    const double length = distance(complex.vertices[at(a)], complex.vertices[at(b)]);
    return ball_radius(complex, {a, b, length > 0 ? distance(complex.vertices[at(a)], where.point) / length : 0.0});
}

}  // namespace

NearestOnComplex nearest_on_complex(const Surface& surface, const VoronoiComplex& complex, Vec3 x) {
    std::vector<double> away(complex.vertex_count());
    for (std::size_t v = 0; v < away.size(); ++v) away[v] = distance(complex.vertices[v], x);
    NearestOnComplex nearest;
    nearest.distance = std::numeric_limits<double>::infinity();
    std::vector<std::pair<PolygonId, Vec3>> close;
    const double slack = 1e-9 * surface.median_edge;
    for (std::size_t p = 0; p < complex.polygon_count(); ++p) {
        const auto loop = complex.polygon(PolygonId(p));
        // No point of the polygon is nearer than its nearest vertex less its farthest vertex's distance from that.
        double least = std::numeric_limits<double>::infinity(), size = 0;
        for (const VoronoiVertexId v : loop) {
            least = std::min(least, away[at(v)]);
            size = std::max(size, squared_norm(complex.vertices[at(v)] - complex.vertices[at(loop[0])]));
        }
        if (least - 2 * std::sqrt(size) > nearest.distance + slack) continue;
        const Vec3 q = nearest_on_polygon(surface, complex, PolygonId(p), x).point;
        const double d = distance(q, x);
        if (d > nearest.distance + slack) continue;
        close.emplace_back(PolygonId(p), q);
        if (d < nearest.distance) {
            nearest.distance = d;
            nearest.point = q;
        }
    }
    for (const auto& [p, q] : close)
        if (distance(q, nearest.point) <= slack) nearest.polygons.push_back(p);
    return nearest;
}

void anchor_at_point(const Surface& surface, const VoronoiComplex& complex, const NearestOnComplex& where,
                     Endpoint& endpoint) {
    endpoint.anchor = where.point;
    endpoint.anchor_polygons = where.polygons;
    endpoint.anchor_radius = radius_at(surface, complex, where);
    for (const PolygonId p : where.polygons)
        for (const VoronoiVertexId v : complex.polygon(p)) {
            const double cost = segment_cost(distance(complex.vertices[at(v)], where.point),
                                             complex.ball_radius[at(v)] + endpoint.anchor_radius);
            endpoint.seeds.push_back({v, cost});
        }
    std::sort(endpoint.seeds.begin(), endpoint.seeds.end(), [](const Seed& a, const Seed& b) {
        return a.vertex != b.vertex ? a.vertex < b.vertex : a.time < b.time;
    });
    const auto same = [](const Seed& a, const Seed& b) { return a.vertex == b.vertex; };
    endpoint.seeds.erase(std::unique(endpoint.seeds.begin(), endpoint.seeds.end(), same), endpoint.seeds.end());
    const auto nearest = std::min_element(endpoint.seeds.begin(), endpoint.seeds.end(),
                                          [](const Seed& a, const Seed& b) { return a.time < b.time; });
    endpoint.anchor_vertex = nearest->vertex;
}

void anchor_at_vertex(const VoronoiComplex& complex, VoronoiVertexId v, Endpoint& endpoint) {
    endpoint.anchor = complex.vertices[at(v)];
    endpoint.anchor_radius = complex.ball_radius[at(v)];
    endpoint.anchor_vertex = v;
    const auto polygons = complex.polygons_of(v);
    endpoint.anchor_polygons.assign(polygons.begin(), polygons.end());
    endpoint.seeds = {{v, 0.0}};
}

DeepestVertex deepest_vertex(const VoronoiComplex& complex, Vec3 x, double margin) {
    const auto depth = [&](std::size_t v) { return complex.ball_radius[v] - distance(complex.vertices[v], x); };
    DeepestVertex result;
    result.depth = -std::numeric_limits<double>::infinity();
    for (std::size_t v = 0; v < complex.vertex_count(); ++v)
        if (const double d = depth(v); d > result.depth) {
            result.depth = d;
            result.vertex = VoronoiVertexId(v);
        }

    // Outside of the wall the tiny balls along it are the least far: take the vessel's own.
    if (const double deepest = result.depth; deepest < 0)
        for (std::size_t v = 0; v < complex.vertex_count(); ++v)
            if (complex.ball_radius[v] > complex.ball_radius[at(result.vertex)] &&
                depth(v) >= deepest - margin * complex.ball_radius[v]) {
                result.depth = depth(v);
                result.vertex = VoronoiVertexId(v);
            }

    // Everything joined to the best vertex through vertices about as deep belongs to its branch.
    const double threshold = result.depth - margin * complex.ball_radius[at(result.vertex)];
    std::vector<bool> joined(complex.vertex_count(), false);
    std::vector<VoronoiVertexId> front{result.vertex};
    joined[at(result.vertex)] = true;
    while (!front.empty()) {
        const VoronoiVertexId v = front.back();
        front.pop_back();
        for (const PolygonId p : complex.polygons_of(v))
            for (const VoronoiVertexId w : complex.polygon(p))
                if (!joined[at(w)] && depth(at(w)) >= threshold - margin * complex.ball_radius[at(w)]) {
                    joined[at(w)] = true;
                    front.push_back(w);
                }
    }
    result.rival_depth = threshold;
    for (std::size_t v = 0; v < complex.vertex_count(); ++v)
        if (const double d = depth(v); !joined[v] && d > result.rival_depth) {
            result.rival_depth = d;
            result.rival = VoronoiVertexId(v);
        }
    return result;
}

}  // namespace lumenline
