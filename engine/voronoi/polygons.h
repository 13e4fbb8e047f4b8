#pragma once

#include "engine/core/stage_context.h"
#include "engine/core/surface.h"
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

/// Joins parts of the complex that hang together through the lumen but not through Voronoi edges: at
/// a waist narrower than a triangle circumcentres lie outside and the chain breaks. Vertices on both
/// sides share a site p there, so that the radius along a bare edge between them is |x - p| as on any
/// other. Shortest first, only between different parts, only inside the lumen.
/// @returns the number of edges added
/// @cost O(V)
std::size_t bridge_gaps(const Surface& surface, const InsideCells& cells, const MergedVertices& merged,
                        VoronoiComplex& complex);

/// Fills vertices, radii, polygons and bare edges of the complex.
/// @cost O(cells)
void build_polygons(const InsideCells& cells, const MergedVertices& merged, VoronoiComplex& complex,
                    const StageContext& context);

/// Fills the incidence of vertices and polygons, when all polygons are there.
void build_incidence(VoronoiComplex& complex);

}  // namespace lumenline
