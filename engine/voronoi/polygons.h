#pragma once

#include "engine/core/voronoi_complex.h"
#include "engine/voronoi/inside_cells.h"

namespace lumenline {

/// Merged Voronoi vertices: the inside cells' centres with coincident ones made one.
struct MergedVertices {
    std::vector<std::uint32_t> of_cell;  ///< (I) vertex of each inside cell
    std::size_t count = 0;
    std::size_t merged = 0;  ///< cells that share another cell's vertex
};

/// Unites centres of neighbouring cells closer than max(relative x radius, absolute), the absolute
/// part bounded to a thousandth of the radius. Each group takes its first cell's place.
/// @cost O(cells)
MergedVertices merge_vertices(const InsideCells& cells, double relative, double absolute);

/// Fills vertices, radii, polygons, bare edges and vertex-polygon incidence of the complex.
/// @cost O(cells)
void build_polygons(const InsideCells& cells, const MergedVertices& merged, VoronoiComplex& complex);

}  // namespace lumenline
