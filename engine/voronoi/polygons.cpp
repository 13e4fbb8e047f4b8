// The polygon dual to a Delaunay edge (p, q) is found by turning around the edge from cell to cell.
// A cell has six edges; a bit each says that its polygon was walked, a second bit that the polygon
// was kept. A facet none of whose three edges has a kept polygon leaves a bare Voronoi edge.
// Ranges of cells are walked apart: a polygon belongs to the range of the first of its cells, where it starts, so that
// the ranges' polygons one after the other are those of one walk over all cells. A range that meets a cell before its
// own leaves the polygon to the range of that cell; cells follow a curve through space, so that few polygons are met
// twice.
// Merged vertices collapse loops: repeated neighbours are skipped, and a loop that meets one vertex
// twice, or has fewer than three, has no area and is dropped, which its bare edges make good.
#include "engine/voronoi/polygons.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>
#include <optional>

namespace lumenline {

namespace {

/// Cells of a range; what a range costs more than its polygons is below a hundredth.
constexpr std::size_t kGrain = 32768;

/// Edge of a tetrahedron: its corners, and the corners to turn from and to.
struct TetEdge {
    std::uint8_t a, b, from, to;
};
constexpr std::array<TetEdge, 6> kEdges{
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};
constexpr std::uint8_t kEdgeNumber[4][4] = {{9, 0, 1, 2}, {0, 9, 3, 4}, {1, 3, 9, 5}, {2, 4, 5, 9}};
/// The three edges of the face opposite to each corner, as bits.
constexpr std::uint8_t kFaceEdges[4] = {0b111000, 0b100110, 0b010101, 0b001011};

struct Step {
    std::uint32_t cell;
    std::uint8_t edge;
};

/// A bit of every edge of the cells that a range of polygons was made from; ranges set bits of each other's cells.
class EdgeBits {
public:
    explicit EdgeBits(std::size_t cells) : bits_(cells, 0) {}

    void set(Step step) {
        std::atomic_ref(bits_[step.cell])
            .fetch_or(static_cast<std::uint8_t>(1U << step.edge), std::memory_order_relaxed);
    }
    [[nodiscard]] std::uint8_t of(std::uint32_t cell) const { return bits_[cell]; }

private:
    std::vector<std::uint8_t> bits_;
};

/// Polygons whose first cell is in one range.
class PolygonRange {
public:
    PolygonRange(const InsideCells& cells, const MergedVertices& merged, std::uint32_t begin, std::uint32_t end,
                 EdgeBits& kept)
        : cells_(cells), merged_(merged), begin_(begin), end_(end), kept_(kept), walked_(end - begin, 0) {
        vertices_.reserve((end - begin) * std::size_t{5});
        for (std::uint32_t cell = begin; cell < end; ++cell)
            for (std::uint8_t e = 0; e < 6; ++e)
                if ((walked_[cell - begin] >> e & 1) == 0 && walk(cell, e)) keep(cell, e);
    }

    /// Adds them to those of the ranges before.
    void append_to(VoronoiComplex& complex) const {
        const auto first = static_cast<std::uint32_t>(complex.polygon_vertices.size());
        complex.polygon_vertices.insert(complex.polygon_vertices.end(), vertices_.begin(), vertices_.end());
        complex.polygon_sites.insert(complex.polygon_sites.end(), sites_.begin(), sites_.end());
        for (const std::uint32_t end : ends_) complex.polygon_offsets.push_back(first + end);
    }

private:
    /// Turns around edge `e` of `start`; true when the loop closed inside, and none of its cells is before the range.
    bool walk(std::uint32_t start, std::uint8_t e) {
        loop_.clear();
        const auto& corner = cells_.sites[start];
        const std::uint32_t a = corner[kEdges[e].a], b = corner[kEdges[e].b];
        std::uint32_t from = corner[kEdges[e].from], to = corner[kEdges[e].to];
        std::uint32_t cell = start;
        do {
            const auto& s = cells_.sites[cell];
            std::uint8_t ia = 0, ib = 0, ifrom = 0;
            for (std::uint8_t k = 0; k < 4; ++k) {
                if (s[k] == a)
                    ia = k;
                else if (s[k] == b)
                    ib = k;
                else if (s[k] == from)
                    ifrom = k;
            }
            const std::uint8_t edge = kEdgeNumber[ia][ib];
            if (cell < begin_) return false;
            if (cell < end_) walked_[cell - begin_] |= static_cast<std::uint8_t>(1U << edge);
            loop_.push_back({cell, edge});
            const std::uint32_t next = cells_.neighbours[cell][ifrom];
            if (next == InsideCells::kOutside) return false;
            // In the next cell the face holds a, b and `to`; its fourth corner is where to turn to.
            const auto& n = cells_.sites[next];
            std::uint32_t fourth = 0;
            for (const std::uint32_t v : n)
                if (v != a && v != b && v != to) fourth = v;
            from = to;
            to = fourth;
            cell = next;
        } while (cell != start);
        return true;
    }

    void keep(std::uint32_t cell, std::uint8_t e) {
        auto& out = vertices_;
        const std::size_t begin = out.size();
        for (const Step& step : loop_) {
            const VoronoiVertexId v(merged_.of_cell[step.cell]);
            if (out.size() == begin || out.back() != v) out.push_back(v);
        }
        while (out.size() > begin + 1 && out.back() == out[begin]) out.pop_back();
        const bool collapsed = out.size() - begin != loop_.size();
        if (out.size() - begin < 3 || (collapsed && meets_a_vertex_twice(begin))) {
            out.resize(begin);
            return;
        }
        for (const Step& step : loop_) kept_.set(step);
        const auto& corner = cells_.sites[cell];
        sites_.push_back({SiteId(corner[kEdges[e].a]), SiteId(corner[kEdges[e].b])});
        ends_.push_back(static_cast<std::uint32_t>(out.size()));
    }

    [[nodiscard]] bool meets_a_vertex_twice(std::size_t begin) const {
        const auto& out = vertices_;
        for (std::size_t i = begin; i < out.size(); ++i)
            for (std::size_t j = i + 1; j < out.size(); ++j)
                if (out[i] == out[j]) return true;
        return false;
    }

    const InsideCells& cells_;
    const MergedVertices& merged_;
    std::uint32_t begin_, end_;
    EdgeBits& kept_;
    std::vector<std::uint8_t> walked_;  ///< of the range's cells
    std::vector<Step> loop_;
    std::vector<VoronoiVertexId> vertices_;
    std::vector<std::array<SiteId, 2>> sites_;
    std::vector<std::uint32_t> ends_;  ///< of each polygon in vertices_
};

void add_bare_edges(const InsideCells& cells, const MergedVertices& merged, const EdgeBits& kept,
                    VoronoiComplex& complex) {
    std::vector<std::array<std::uint32_t, 2>> bare;
    for (std::uint32_t cell = 0; cell < cells.count(); ++cell)
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t n = cells.neighbours[cell][k];
            if (n == InsideCells::kOutside || n < cell || (kept.of(cell) & kFaceEdges[k]) != 0) continue;
            const std::uint32_t v = merged.of_cell[cell], w = merged.of_cell[n];
            if (v != w) bare.push_back({std::min(v, w), std::max(v, w)});
        }
    std::sort(bare.begin(), bare.end());
    bare.erase(std::unique(bare.begin(), bare.end()), bare.end());
    for (const auto& edge : bare) {
        complex.polygon_vertices.insert(complex.polygon_vertices.end(),
                                        {VoronoiVertexId(edge[0]), VoronoiVertexId(edge[1])});
        complex.polygon_sites.push_back({SiteId(), SiteId()});
        complex.polygon_offsets.push_back(static_cast<std::uint32_t>(complex.polygon_vertices.size()));
    }
}

}  // namespace

void build_incidence(VoronoiComplex& complex) {
    auto& offsets = complex.vertex_offsets;
    offsets.assign(complex.vertex_count() + 1, 0);
    for (const VoronoiVertexId v : complex.polygon_vertices) ++offsets[at(v) + 1];
    for (std::size_t v = 0; v + 1 < offsets.size(); ++v) offsets[v + 1] += offsets[v];
    complex.vertex_polygons.resize(complex.polygon_vertices.size());
    std::vector<std::uint32_t> next(offsets.begin(), offsets.end() - 1);
    for (std::size_t p = 0; p < complex.polygon_count(); ++p)
        for (const VoronoiVertexId v : complex.polygon(PolygonId(p)))
            complex.vertex_polygons[next[at(v)]++] = PolygonId(p);
}

MergedVertices merge_vertices(const InsideCells& cells, double relative, double absolute) {
    std::vector<std::uint32_t> parent(cells.count());
    std::iota(parent.begin(), parent.end(), 0U);
    auto root = [&parent](std::uint32_t c) {
        while (parent[c] != c) c = parent[c] = parent[parent[c]];
        return c;
    };
    for (std::uint32_t cell = 0; cell < cells.count(); ++cell) {
        const double r = cells.radius[cell];
        const double tolerance = std::max(relative * r, std::min(absolute, 1e-3 * r));
        for (const std::uint32_t n : cells.neighbours[cell]) {
            if (n == InsideCells::kOutside || n < cell) continue;
            if (squared_norm(cells.centre[cell] - cells.centre[n]) > tolerance * tolerance) continue;
            const std::uint32_t x = root(cell), y = root(n);
            if (x != y) parent[std::max(x, y)] = std::min(x, y);
        }
    }
    MergedVertices merged;
    merged.of_cell.resize(cells.count());
    for (std::uint32_t cell = 0; cell < cells.count(); ++cell) {
        const std::uint32_t r = root(cell);  // never after `cell`: roots are the least of their group
        merged.of_cell[cell] = r == cell ? static_cast<std::uint32_t>(merged.count++) : merged.of_cell[r];
    }
    merged.merged = cells.count() - merged.count;
    return merged;
}

void build_polygons(const InsideCells& cells, const MergedVertices& merged, VoronoiComplex& complex,
                    const StageContext& context) {
    complex.vertices.resize(merged.count);
    complex.ball_radius.resize(merged.count);
    complex.vertex_site.resize(merged.count);
    for (std::uint32_t cell = static_cast<std::uint32_t>(cells.count());
         cell-- > 0;) {  // the first cell of a group wins
        const std::uint32_t v = merged.of_cell[cell];
        complex.vertices[v] = cells.centre[cell];
        complex.ball_radius[v] = cells.radius[cell];
        complex.vertex_site[v] = SiteId(cells.sites[cell][0]);
    }
    EdgeBits kept(cells.count());
    std::vector<std::optional<PolygonRange>> ranges((cells.count() + kGrain - 1) / kGrain);
    context.parallel_for(cells.count(), kGrain, [&](std::size_t begin, std::size_t end) {
        ranges[begin / kGrain].emplace(cells, merged, static_cast<std::uint32_t>(begin),
                                       static_cast<std::uint32_t>(end), kept);
    });
    complex.polygon_offsets.assign(1, 0);
    complex.polygon_vertices.reserve(cells.count() * 5);
    complex.polygon_sites.reserve(cells.count() * 3 / 2);
    complex.polygon_offsets.reserve(cells.count() * 3 / 2);
    for (auto& range : ranges) {
        if (!range) continue;  // ranges may have been run as one
        range->append_to(complex);
        range.reset();
    }
    add_bare_edges(cells, merged, kept, complex);
}

}  // namespace lumenline
