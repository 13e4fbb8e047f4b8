// Polygons are taken off one by one, each with an edge that no other one left holds: the two say together that the
// edge's class is the sum of the polygon's other ones, and nothing else. What is left in the end is a graph. Over a
// spanning forest of it every other edge closes one cycle and gets a bit of its own; the edges taken off follow, in
// the opposite order. A complex that encloses no hollow shrinks so to a graph. Where one does, no edge is free some
// time: a polygon is then taken off without an edge, and what it says, that the classes around it add up to zero, is
// kept as a relation among the bits.
//
// Two Voronoi edges between the same two vertices, as merged ones have them, count as one.
#include "engine/trace/cycle_classes.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace lumenline {

namespace {

constexpr std::size_t kBits = 64;

/// Connected sets of vertices.
class Sets {
public:
    explicit Sets(std::size_t count) : above_(count) { std::iota(above_.begin(), above_.end(), 0U); }

    /// False where the two are in one set already.
    bool join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        above_[std::max(a, b)] = std::min(a, b);
        return a != b;
    }

private:
    std::uint32_t find(std::uint32_t v) {
        while (above_[v] != v) v = above_[v] = above_[above_[v]];
        return v;
    }
    std::vector<std::uint32_t> above_;
};

}  // namespace

bool is_zero(const CycleClass& sum) {
    return std::all_of(sum.begin(), sum.end(), [](std::uint64_t w) { return w == 0; });
}

void add(CycleClass& sum, std::span<const std::uint64_t> other) {
    for (std::size_t i = 0; i < other.size(); ++i) sum[i] ^= other[i];
}

void ClassSpan::reduce(CycleClass& sum) const {
    for (const Row& row : rows_)
        if ((sum[row.pivot / kBits] >> (row.pivot % kBits) & 1U) != 0) add(sum, row.bits);
}

bool ClassSpan::insert(CycleClass sum) {
    reduce(sum);
    for (std::size_t i = 0; i < sum.size(); ++i)
        if (sum[i] != 0) {
            const std::size_t pivot = i * kBits + static_cast<std::size_t>(std::countr_zero(sum[i]));
            for (Row& row : rows_)
                if ((row.bits[i] >> (pivot % kBits) & 1U) != 0) add(row.bits, sum);
            rows_.push_back({pivot, std::move(sum)});
            return true;
        }
    return false;
}

CycleClasses::CycleClasses(const VoronoiComplex& complex) : complex_(complex) {
    number_edges();
    std::vector<PolygonId> left;
    const std::vector<Collapse> collapsed = collapse(left);
    name_cycles(collapsed);
    for (const PolygonId p : left) relations_.insert(around(p));
    for (Edge e = 0; relations_.rank() > 0 && e < edge_count(); ++e) {
        CycleClass reduced(row(e).begin(), row(e).end());
        relations_.reduce(reduced);
        std::copy(reduced.begin(), reduced.end(), row(e).begin());
    }
}

void CycleClasses::number_edges() {
    struct Side {
        VoronoiVertexId low, high;
        std::uint32_t corner;
        auto operator<=>(const Side&) const = default;
    };
    std::vector<Side> sides;
    sides.reserve(complex_.polygon_vertices.size());
    for (std::size_t p = 0; p < complex_.polygon_count(); ++p) {
        const auto polygon = complex_.polygon(PolygonId(p));
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const auto [low, high] = std::minmax(polygon[i], polygon[i + 1 == polygon.size() ? 0 : i + 1]);
            sides.push_back({low, high, complex_.polygon_offsets[p] + static_cast<std::uint32_t>(i)});
        }
    }
    std::sort(sides.begin(), sides.end());
    side_.resize(sides.size());
    for (const Side& s : sides) {
        if (ends_.empty() || ends_.back() != std::array{s.low, s.high}) ends_.push_back({s.low, s.high});
        side_[s.corner] = static_cast<std::uint32_t>(ends_.size() - 1);
    }
}

std::vector<CycleClasses::Collapse> CycleClasses::collapse(std::vector<PolygonId>& left) {
    const std::size_t polygons = complex_.polygon_count();
    const auto sides = [&](std::size_t p) {
        return std::span(side_).subspan(complex_.polygon_offsets[p],
                                        complex_.polygon_offsets[p + 1] - complex_.polygon_offsets[p]);
    };
    std::vector<std::uint32_t> holders(edge_count(), 0);  // polygons left that hold it
    std::vector<std::uint32_t> sum(edge_count(), 0);      // of these, the exclusive or of their numbers: the last one
    std::vector<char> gone(polygons, 0);
    for (std::size_t p = 0; p < polygons; ++p) {
        gone[p] = sides(p).size() < 3 ? 1 : 0;
        if (gone[p] != 0) continue;
        for (const std::uint32_t e : sides(p)) {
            ++holders[e];
            sum[e] ^= static_cast<std::uint32_t>(p);
        }
    }
    std::vector<std::uint32_t> free;
    for (std::uint32_t e = 0; e < edge_count(); ++e)
        if (holders[e] == 1) free.push_back(e);
    const auto take_off = [&](std::size_t p) {
        gone[p] = 1;
        for (const std::uint32_t e : sides(p)) {
            sum[e] ^= static_cast<std::uint32_t>(p);
            if (--holders[e] == 1) free.push_back(e);
        }
    };
    std::vector<Collapse> collapsed;
    for (std::size_t next = 0; next < polygons;) {
        while (!free.empty()) {
            const std::uint32_t e = free.back();
            free.pop_back();
            if (holders[e] != 1) continue;
            collapsed.push_back({PolygonId(sum[e]), e});
            take_off(sum[e]);
        }
        if (gone[next] == 0) {
            left.emplace_back(next);
            take_off(next);
        }
        ++next;
    }
    return collapsed;
}

void CycleClasses::name_cycles(const std::vector<Collapse>& collapsed) {
    std::vector<char> taken_off(edge_count(), 0);
    for (const Collapse& c : collapsed) taken_off[c.edge] = 1;
    Sets sets(complex_.vertex_count());
    std::vector<Edge> closing;
    for (Edge e = 0; e < edge_count(); ++e)
        if (taken_off[e] == 0 && !sets.join(ends_[e][0].value, ends_[e][1].value)) closing.push_back(e);
    basis_ = closing.size();
    words_ = (basis_ + kBits - 1) / kBits;
    classes_.assign(edge_count() * words_, 0);
    for (std::size_t bit = 0; bit < basis_; ++bit) row(closing[bit])[bit / kBits] |= std::uint64_t{1} << (bit % kBits);
    for (auto c = collapsed.rbegin(); c != collapsed.rend(); ++c) {
        const CycleClass others = around(c->polygon);  // its own is zero yet
        std::copy(others.begin(), others.end(), row(c->edge).begin());
    }
}

CycleClass CycleClasses::around(PolygonId p) const {
    CycleClass sum = zero();
    for (std::size_t i = complex_.polygon_offsets[at(p)]; i < complex_.polygon_offsets[at(p) + 1]; ++i)
        add(sum, of_edge(side_[i]));
    return sum;
}

void CycleClasses::add_way(PolygonId p, VoronoiVertexId from, VoronoiVertexId to, CycleClass& sum) const {
    const auto polygon = complex_.polygon(p);
    const auto corner = [&](VoronoiVertexId v) {
        return static_cast<std::size_t>(std::find(polygon.begin(), polygon.end(), v) - polygon.begin());
    };
    for (std::size_t i = corner(from), last = corner(to); i != last; i = i + 1 == polygon.size() ? 0 : i + 1)
        add(sum, of_edge(side_[complex_.polygon_offsets[at(p)] + i]));
}

}  // namespace lumenline
