// Kruskal's algorithm: union-find on the complex as it stands, then the candidates between different
// parts by length. Candidates are pairs of vertices whose balls touch a common site; only sites that
// belong to more than one part are looked at, on most surfaces none.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "engine/geometry/inside_test.h"
#include "engine/voronoi/polygons.h"

namespace lumenline {

namespace {

constexpr int kPieces = 16;  // of a bridge, whose ends are asked for being inside

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

struct Bridge {
    double length = 0;
    std::uint32_t a = 0, b = 0;
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
            bridges.push_back({distance(complex.vertices[v], complex.vertices[w]), std::min(v, w), std::max(v, w)});
        }
    if (bridges.empty()) return 0;
    std::sort(bridges.begin(), bridges.end(), [](const Bridge& x, const Bridge& y) {
        return std::tie(x.length, x.a, x.b) < std::tie(y.length, y.a, y.b);
    });
    const InsideTest test(surface.points, surface.triangles);
    std::size_t added = 0;
    for (const Bridge& bridge : bridges) {
        if (parts.root(bridge.a) == parts.root(bridge.b)) continue;
        bool inside = bridge.length < complex.ball_radius[bridge.a] + complex.ball_radius[bridge.b];
        for (int i = 1; inside && i < kPieces; ++i)
            inside = test.inside(lerp(complex.vertices[bridge.a], complex.vertices[bridge.b], double{1} * i / kPieces));
        if (!inside) continue;
        parts.unite(bridge.a, bridge.b);
        complex.polygon_vertices.insert(complex.polygon_vertices.end(), {VoronoiVertexId(std::size_t{bridge.a}),
                                                                         VoronoiVertexId(std::size_t{bridge.b})});
        complex.polygon_sites.push_back({SiteId(), SiteId()});
        complex.polygon_offsets.push_back(static_cast<std::uint32_t>(complex.polygon_vertices.size()));
        ++added;
    }
    return added;
}

}  // namespace lumenline
