#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/voronoi_complex.h"

namespace lumenline {

/// Sum of ways, one bit per independent cycle: adding is exclusive or.
using CycleClass = std::vector<std::uint64_t>;

/// What a set of classes can make up by addition.
class ClassSpan {
public:
    /// Takes from `sum` what the span makes up; what is left is zero, or independent of it.
    void reduce(CycleClass& sum) const;
    /// Widens the span by `sum`; false where it holds it already.
    bool insert(CycleClass sum);
    [[nodiscard]] std::size_t rank() const { return rows_.size(); }

private:
    struct Row {
        std::size_t pivot = 0;  // bit
        CycleClass bits;
    };
    std::vector<Row> rows_;
};

[[nodiscard]] bool is_zero(const CycleClass& sum);
/// Adds a class of at most as many words; words beyond are of the caller's own.
void add(CycleClass& sum, std::span<const std::uint64_t> other);

/// Which closed ways over the complex can be pulled together over its polygons, and which of the others go around
/// the same holes: every edge has a class in the first homology with coefficients 0 and 1, such that those around a
/// polygon add up to zero, and those along a closed way do so if and only if polygons fill it.
class CycleClasses {
public:
    using Edge = std::size_t;

    /// @cost O(E log E), E the edges; and of memory 20 bytes each, and a bit more for each cycle
    explicit CycleClasses(const VoronoiComplex& complex);

    /// Independent cycles that no polygons fill; parts of the complex that no source reaches included.
    [[nodiscard]] std::size_t count() const { return basis_ - relations_.rank(); }

    [[nodiscard]] std::size_t edge_count() const { return ends_.size(); }
    [[nodiscard]] std::array<VoronoiVertexId, 2> ends(Edge e) const { return ends_[e]; }
    [[nodiscard]] std::span<const std::uint64_t> of_edge(Edge e) const {
        return {classes_.data() + e * words_, classes_.data() + (e + 1) * words_};
    }

    [[nodiscard]] CycleClass zero() const { return CycleClass(words_, 0); }
    /// Adds the way within polygon p between two of its vertices.
    void add_way(PolygonId p, VoronoiVertexId from, VoronoiVertexId to, CycleClass& sum) const;

private:
    /// An edge taken off together with the last polygon that holds it.
    struct Collapse {
        PolygonId polygon;
        Edge edge;
    };

    void number_edges();
    std::vector<Collapse> collapse(std::vector<PolygonId>& left);
    void name_cycles(const std::vector<Collapse>& collapsed);
    [[nodiscard]] CycleClass around(PolygonId p) const;
    [[nodiscard]] std::span<std::uint64_t> row(Edge e) { return {classes_.data() + e * words_, words_}; }

    const VoronoiComplex& complex_;
    std::vector<std::uint32_t> side_;  // per corner of a polygon: the edge to its next one
    std::vector<std::array<VoronoiVertexId, 2>> ends_;
    std::size_t basis_ = 0, words_ = 0;
    std::vector<std::uint64_t> classes_;  // per edge
    ClassSpan relations_;                 // what polygons say that could not be taken off
};

}  // namespace lumenline
