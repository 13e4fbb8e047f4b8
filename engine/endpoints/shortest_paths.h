#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/core/endpoints.h"
#include "engine/core/stage_context.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline {

/// Least costs from seeds over the chords of the complex's polygons: straight segments between any two
/// vertices of one polygon, with the exact integral of 1/R along each.
struct ShortestPaths {
    std::vector<double> cost;             ///< (V) dimensionless; +inf = unreached
    std::vector<double> length;           ///< (V) of the path of least cost [length]
    std::vector<VoronoiVertexId> parent;  ///< (V) the vertex before; none at seeds and where unreached

    [[nodiscard]] bool reaches(std::size_t v) const { return cost[v] < std::numeric_limits<double>::infinity(); }
};

/// Dijkstra's algorithm. The costs lie above the arrival times of the march by a few percent: good
/// enough for order and topology, at a fraction of the code.
/// @cost O(E log V), E the chords of all polygons
ShortestPaths shortest_paths(const VoronoiComplex& complex, std::span<const Seed> seeds, StageContext& context);

}  // namespace lumenline
