#include "tests/stages/complex_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "engine/geometry/inside_test.h"

// Tolerances are displacements: a vertex may be off by `slack`, and what follows from that for
// angles and planes is worked out where it is used.

namespace lumenline::test {

namespace {

/// How far a vertex may be off its place: merging moves it by up to this (see VoronoiOptions).
double slack(const Surface& surface, double radius, double tolerance) {
    return tolerance * radius + 256 * surface.coordinate_rounding;
}

std::string at_polygon(std::size_t p, const std::string& what) { return "polygon " + std::to_string(p) + " " + what; }
std::string at_vertex(std::size_t v, const std::string& what) { return "vertex " + std::to_string(v) + " " + what; }

/// Planarity and convexity of one loop in the plane perpendicular to the unit vector n.
std::string check_shape(const VoronoiComplex& complex, std::size_t p, Vec3 n, double allowed, double out_of_plane) {
    const auto loop = complex.polygon(PolygonId(p));
    const std::size_t size = loop.size();
    const auto vertex = [&](std::size_t i) { return complex.vertices[at(loop[i % size])]; };
    double twice_area = 0;
    for (std::size_t i = 0; i < size; ++i) {
        if (std::fabs(dot(vertex(i) - vertex(0), n)) > out_of_plane) return at_polygon(p, "is not planar");
        twice_area += dot(cross(vertex(i) - vertex(0), vertex(i + 1) - vertex(0)), n);
    }
    const double turn = twice_area < 0 ? -1 : 1;
    for (std::size_t i = 0; i < size; ++i) {
        const Vec3 edge = vertex(i + 1) - vertex(i);
        for (std::size_t j = 0; j < size; ++j) {
            const Vec3 to = vertex(j) - vertex(i);
            // An area whose corners are off by `allowed` is off by that times its sides.
            if (turn * dot(cross(edge, to), n) < -2 * allowed * (norm(edge) + norm(to) + allowed))
                return at_polygon(p, "is not convex");
        }
    }
    return {};
}

bool same_loop(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double allowed) {
    if (a.size() != b.size()) return false;
    const std::size_t n = a.size();
    for (std::size_t shift = 0; shift < n; ++shift)
        for (const bool backwards : {false, true}) {
            bool same = true;
            for (std::size_t i = 0; i < n && same; ++i)
                same = distance(a[i], b[backwards ? (shift + n - i) % n : (shift + i) % n]) <= allowed;
            if (same) return true;
        }
    return false;
}

bool same_edge(const std::array<Vec3, 2>& a, const std::array<Vec3, 2>& b, double allowed) {
    return std::max(distance(a[0], b[0]), distance(a[1], b[1])) <= allowed ||
           std::max(distance(a[0], b[1]), distance(a[1], b[0])) <= allowed;
}

}  // namespace

std::string check_incidence(const Surface& surface, const VoronoiComplex& complex) {
    const std::size_t n = complex.vertex_count(), m = complex.polygon_count();
    if (complex.ball_radius.size() != n || complex.vertex_site.size() != n) return "vertex arrays differ in length";
    if (complex.vertex_offsets.size() != n + 1 || complex.polygon_offsets.size() != m + 1) return "offsets are short";
    if (complex.pole.size() != surface.site_count()) return "there is not one pole per site";
    if (complex.polygon_offsets.front() != 0 || complex.polygon_offsets.back() != complex.polygon_vertices.size() ||
        complex.vertex_offsets.front() != 0 || complex.vertex_offsets.back() != complex.vertex_polygons.size() ||
        complex.vertex_polygons.size() != complex.polygon_vertices.size())
        return "offsets do not cover their values";
    for (std::size_t p = 0; p < m; ++p) {
        if (complex.polygon_offsets[p] + 2 > complex.polygon_offsets[p + 1]) return at_polygon(p, "has no edge");
        const auto loop = complex.polygon(PolygonId(p));
        const bool bare = loop.size() == 2;
        for (const SiteId s : complex.polygon_sites[p])
            if (s.is_none() != bare || (!bare && at(s) >= surface.site_count())) return at_polygon(p, "has odd sites");
        for (std::size_t i = 0; i < loop.size(); ++i) {
            if (at(loop[i]) >= n) return at_polygon(p, "has a vertex that does not exist");
            if (std::count(loop.begin(), loop.end(), loop[i]) != 1) return at_polygon(p, "meets a vertex twice");
            const auto back = complex.polygons_of(loop[i]);
            if (std::count(back.begin(), back.end(), PolygonId(p)) != 1)
                return at_polygon(p, "is not known to its vertex");
        }
    }
    for (std::size_t v = 0; v < n; ++v) {
        if (complex.vertex_offsets[v] > complex.vertex_offsets[v + 1]) return at_vertex(v, "has a negative share");
        const auto polygons = complex.polygons_of(VoronoiVertexId(v));
        if (!std::is_sorted(polygons.begin(), polygons.end())) return at_vertex(v, "has unsorted polygons");
    }
    for (const VoronoiVertexId v : complex.pole)
        if (!v.is_none() && at(v) >= n) return "a pole does not exist";
    return {};
}

std::string check_polygons(const Surface& surface, const VoronoiComplex& complex, double tolerance) {
    for (std::size_t p = 0; p < complex.polygon_count(); ++p) {
        const auto loop = complex.polygon(PolygonId(p));
        if (loop.size() == 2) continue;
        const Vec3 s = surface.points[at(complex.polygon_sites[p][0])],
                   t = surface.points[at(complex.polygon_sites[p][1])];
        double largest = 0;
        for (const VoronoiVertexId v : loop) {
            const double r = complex.ball_radius[at(v)], allowed = slack(surface, r, tolerance);
            largest = std::max(largest, r);
            for (const Vec3 site : {s, t})
                if (std::fabs(distance(complex.vertices[at(v)], site) - r) > allowed)
                    return at_polygon(p, "has a vertex that is not a ball radius from its site");
        }
        const double allowed = slack(surface, largest, tolerance);
        // |v - s| and |v - t| differ by up to 2 allowed: off the bisector plane by that times R / |s - t|.
        const std::string shape =
            check_shape(complex, p, normalized(t - s), allowed, 4 * allowed * largest / distance(s, t));
        if (!shape.empty()) return shape;
    }
    return {};
}

std::string check_balls(const Surface& surface, const VoronoiComplex& complex, double tolerance, std::size_t stride) {
    for (std::size_t v = 0; v < complex.vertex_count(); v += stride) {
        double least2 = std::numeric_limits<double>::infinity();
        for (const Vec3& p : surface.points) least2 = std::min(least2, squared_norm(p - complex.vertices[v]));
        const double nearest = std::sqrt(least2), r = complex.ball_radius[v], allowed = slack(surface, r, tolerance);
        if (nearest < r - allowed) return at_vertex(v, "has a site inside its ball");
        if (nearest > r + allowed) return at_vertex(v, "has no site on its sphere");
        const Vec3 site = surface.points[at(complex.vertex_site[v])];
        if (std::fabs(distance(site, complex.vertices[v]) - r) > allowed)
            return at_vertex(v, "is not a ball radius from its site");
    }
    return {};
}

std::string check_inside(const Surface& surface, const VoronoiComplex& complex) {
    const InsideTest test(surface.points, surface.triangles);
    for (std::size_t v = 0; v < complex.vertex_count(); ++v)
        if (!test.inside(complex.vertices[v])) return at_vertex(v, "is outside of the surface");
    return {};
}

std::string check_edges(const Surface& surface, const VoronoiComplex& complex) {
    constexpr int kSamples = 256;
    const WallCrossing wall(surface);
    const InsideTest test(surface.points, surface.triangles);
    for (std::size_t p = 0; p < complex.polygon_count(); ++p) {
        const auto loop = complex.polygon(PolygonId(p));
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec3 a = complex.vertices[at(loop[i])], b = complex.vertices[at(loop[(i + 1) % loop.size()])];
            if (!wall.crosses(a, b)) continue;
            for (int k = 1; k < kSamples; ++k)
                if (!test.inside(lerp(a, b, k / double(kSamples)))) return at_polygon(p, "has an edge outside");
        }
    }
    return {};
}

std::string compare_polygons(const VoronoiComplex& complex, const ReferenceComplex& reference, double tolerance) {
    std::map<std::array<std::uint32_t, 2>, std::vector<Vec3>> found;
    std::vector<std::array<Vec3, 2>> bare;
    double largest = 0;
    for (const double r : complex.ball_radius) largest = std::max(largest, r);
    const double allowed = tolerance * largest;
    for (std::size_t p = 0; p < complex.polygon_count(); ++p) {
        std::vector<Vec3> loop;
        for (const VoronoiVertexId v : complex.polygon(PolygonId(p))) loop.push_back(complex.vertices[at(v)]);
        if (loop.size() == 2) {
            bare.push_back({loop[0], loop[1]});
            continue;
        }
        const auto [s, t] = complex.polygon_sites[p];
        if (!found.emplace(std::array{std::min(s.value, t.value), std::max(s.value, t.value)}, std::move(loop)).second)
            return at_polygon(p, "has the sites of another polygon");
    }
    for (const auto& polygon : reference.polygons) {
        const auto match = found.find(polygon.sites);
        const std::string name =
            "the polygon of sites " + std::to_string(polygon.sites[0]) + " and " + std::to_string(polygon.sites[1]);
        if (match == found.end()) return name + " is missing";
        if (!same_loop(match->second, polygon.loop, allowed)) return name + " has another loop";
    }
    if (found.size() != reference.polygons.size()) return "there are more polygons than there should be";
    if (bare.size() != reference.bare_edges.size())
        return "there are " + std::to_string(bare.size()) + " bare edges, not " +
               std::to_string(reference.bare_edges.size());
    for (const auto& edge : reference.bare_edges)
        if (std::none_of(bare.begin(), bare.end(), [&](const auto& b) { return same_edge(b, edge, allowed); }))
            return "a bare edge is missing";
    return {};
}

std::string compare_poles(const Surface& surface, const VoronoiComplex& complex, const ReferenceComplex& reference,
                          double tolerance) {
    for (std::size_t s = 0; s < surface.site_count(); ++s) {
        const VoronoiVertexId pole = complex.pole[s];
        const double expected = reference.pole_distance[s];
        const std::string name = "the pole of site " + std::to_string(s);
        if (pole.is_none() != (expected < 0)) return name + (pole.is_none() ? " is missing" : " should not exist");
        if (pole.is_none()) continue;
        if (std::fabs(distance(complex.vertices[at(pole)], surface.points[s]) - expected) >
            slack(surface, expected, tolerance))
            return name + " is not the farthest";
    }
    return {};
}

std::string check_poles(const Surface& surface, const VoronoiComplex& complex, double tolerance) {
    for (std::size_t p = 0; p < complex.polygon_count(); ++p)
        for (const SiteId s : complex.polygon_sites[p]) {
            if (s.is_none()) continue;
            const VoronoiVertexId pole = complex.pole[at(s)];
            if (pole.is_none()) return "site " + std::to_string(at(s)) + " has a polygon but no pole";
            const double reach = distance(complex.vertices[at(pole)], surface.points[at(s)]);
            for (const VoronoiVertexId v : complex.polygon(PolygonId(p)))
                if (distance(complex.vertices[at(v)], surface.points[at(s)]) > reach + slack(surface, reach, tolerance))
                    return at_vertex(at(v), "is farther from a site than its pole");
        }
    return {};
}

std::size_t count_components(const VoronoiComplex& complex) {
    std::vector<std::size_t> parent(complex.vertex_count());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::size_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    std::size_t count = complex.vertex_count();
    for (std::size_t p = 0; p < complex.polygon_count(); ++p) {
        const auto loop = complex.polygon(PolygonId(p));
        for (const VoronoiVertexId v : loop) {
            const std::size_t a = root(at(loop[0])), b = root(at(v));
            if (a == b) continue;
            parent[b] = a;
            --count;
        }
    }
    return count;
}

}  // namespace lumenline::test
