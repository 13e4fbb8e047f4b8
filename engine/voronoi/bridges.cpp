// Kruskal's algorithm: union-find on the complex as it stands, then the candidates between different
// parts by length. Candidates are pairs of cells with a common site; only sites that belong to more
// than one part are looked at, on most surfaces none. Where the straight way leaves the lumen, which
// a waist of three rim vertices may bend, a way over one more vertex is sought beside its middle: the
// centre of an empty ball that touches the common site, so that radii stay exact along both edges.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "engine/geometry/inside_test.h"
#include "engine/voronoi/polygons.h"

namespace lumenline {

namespace {

constexpr int kPieces = 256;  // of an edge, whose ends are asked for being inside
constexpr int kShifts = 16;   // places tried for the additional vertex

class Parts {
public:
    explicit Parts(const VoronoiComplex& complex) : parent_(complex.vertex_count()) {
        std::iota(parent_.begin(), parent_.end(), 0U);
        for (std::size_t p = 0; p < complex.polygon_count(); ++p) {
            const auto loop = complex.polygon(PolygonId(p));
            for (const VoronoiVertexId v : loop) unite(loop[0].value, v.value);
        }
    }

    std::uint32_t root(std::uint32_t v) {
        while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
        return v;
    }

    void unite(std::uint32_t v, std::uint32_t w) {
        const std::uint32_t a = root(v), b = root(w);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> parent_;
};

/// A way between two parts; `site` is on the balls of both ends.
struct Bridge {
    double length = 0;
    std::uint32_t a = 0, b = 0, site = 0;
};

/// Vertices around each site that belongs to several parts: (site, vertex), sorted.
std::vector<std::pair<std::uint32_t, std::uint32_t>> vertices_at_seams(const InsideCells& cells,
                                                                       const MergedVertices& merged,
                                                                       std::size_t site_count, Parts& parts) {
    std::vector<std::uint32_t> part_of(site_count, VoronoiVertexId::kNoneValue);
    std::vector<bool> seam(site_count, false);
    for (std::size_t cell = 0; cell < cells.count(); ++cell)
        for (const std::uint32_t s : cells.sites[cell]) {
            const std::uint32_t part = parts.root(merged.of_cell[cell]);
            if (part_of[s] == VoronoiVertexId::kNoneValue) part_of[s] = part;
            if (part_of[s] != part) seam[s] = true;
        }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
    for (std::size_t cell = 0; cell < cells.count(); ++cell)
        for (const std::uint32_t s : cells.sites[cell])
            if (seam[s]) found.emplace_back(s, merged.of_cell[cell]);
    std::sort(found.begin(), found.end());
    return found;
}

class Bridger {
public:
    Bridger(const Surface& surface, VoronoiComplex& complex)
        : surface_(surface), complex_(complex), test_(surface.points, surface.triangles) {}

    /// Adds the edges of a bridge; their number, 0 where no way stays inside.
    std::size_t build(const Bridge& bridge) {
        const VoronoiVertexId a(std::size_t{bridge.a}), b(std::size_t{bridge.b});
        const Vec3 from = complex_.vertices[at(a)], to = complex_.vertices[at(b)];
        const Vec3 site = surface_.points[bridge.site];
        if (edge_inside(from, to)) {
            add_edge(a, b);
            return 1;
        }
        const Vec3 middle = lerp(from, to, 0.5);
        const double reach = std::min(complex_.ball_radius[at(a)], complex_.ball_radius[at(b)]);
        const Vec3 inward = -surface_.normals[bridge.site], across = normalized(cross(inward, to - from));
        const Vec3 along = normalized(site - middle);
        for (int i = 1; i <= kShifts; ++i)
            for (const Vec3 direction : {inward, along, -along, across, -across}) {
                const Vec3 m = middle + (reach * i / kShifts) * direction;
                if (!test_.inside(m) || !edge_inside(from, m) || !edge_inside(m, to) || !touches(m, site)) continue;
                complex_.vertices.push_back(m);
                complex_.ball_radius.push_back(distance(m, site));
                complex_.vertex_site.push_back(SiteId(std::size_t{bridge.site}));
                add_edge(a, VoronoiVertexId(complex_.vertex_count() - 1));
                add_edge(VoronoiVertexId(complex_.vertex_count() - 1), b);
                return 2;
            }
        return 0;
    }

private:
    [[nodiscard]] bool edge_inside(Vec3 a, Vec3 b) const {
        for (int i = 1; i < kPieces; ++i)
            if (!test_.inside(lerp(a, b, double{1} * i / kPieces))) return false;
        return true;
    }

    /// Is no site nearer to m than `site`?
    [[nodiscard]] bool touches(Vec3 m, Vec3 site) const {
        const double r2 = squared_norm(m - site);
        return std::none_of(surface_.points.begin(), surface_.points.end(),
                            [&](Vec3 p) { return squared_norm(p - m) < r2; });
    }

    void add_edge(VoronoiVertexId a, VoronoiVertexId b) {
        complex_.polygon_vertices.insert(complex_.polygon_vertices.end(), {std::min(a, b), std::max(a, b)});
        complex_.polygon_sites.push_back({SiteId(), SiteId()});
        complex_.polygon_offsets.push_back(static_cast<std::uint32_t>(complex_.polygon_vertices.size()));
    }

    const Surface& surface_;
    VoronoiComplex& complex_;
    InsideTest test_;
};

}  // namespace

std::size_t bridge_gaps(const Surface& surface, const InsideCells& cells, const MergedVertices& merged,
                        VoronoiComplex& complex) {
    Parts parts(complex);
    std::vector<Bridge> bridges;
    const auto around = vertices_at_seams(cells, merged, surface.site_count(), parts);
    for (std::size_t i = 0; i < around.size(); ++i)
        for (std::size_t j = i + 1; j < around.size() && around[j].first == around[i].first; ++j) {
            const std::uint32_t v = around[i].second, w = around[j].second;
            if (parts.root(v) == parts.root(w)) continue;
            const double length = distance(complex.vertices[v], complex.vertices[w]);
            if (length < complex.ball_radius[v] + complex.ball_radius[w])
                bridges.push_back({length, std::min(v, w), std::max(v, w), around[i].first});
        }
    if (bridges.empty()) return 0;
    std::sort(bridges.begin(), bridges.end(), [](const Bridge& x, const Bridge& y) {
        return std::tie(x.length, x.a, x.b, x.site) < std::tie(y.length, y.a, y.b, y.site);
    });
    Bridger bridger(surface, complex);
    std::size_t added = 0;
    for (const Bridge& bridge : bridges) {
        if (parts.root(bridge.a) == parts.root(bridge.b)) continue;
        const std::size_t edges = bridger.build(bridge);
        if (edges > 0) parts.unite(bridge.a, bridge.b);
        added += edges;
    }
    return added;
}

}  // namespace lumenline
