// Symbols of the paper: P = sites (surface points), Del(P) = delaunay_tetrahedra, Vor_E(P) =
// VoronoiComplex, R = ball_radius, pole(p) = pole.
#include "engine/voronoi/voronoi.h"

#include <algorithm>

#include "engine/core/text.h"
#include "engine/voronoi/delaunay.h"
#include "engine/voronoi/inside_cells.h"
#include "engine/voronoi/polygons.h"

namespace lumenline {

namespace {

/// Coordinates carry this rounding, and a flat cell's centre magnifies it: centres closer than this
/// many times the rounding are one.
constexpr double kRoundingFactor = 64;

std::vector<VoronoiVertexId> find_poles(const InsideCells& cells, const MergedVertices& merged,
                                        std::size_t site_count) {
    std::vector<VoronoiVertexId> pole(site_count);
    std::vector<double> farthest(site_count, -1);
    for (std::size_t cell = 0; cell < cells.count(); ++cell)
        for (const std::uint32_t s : cells.sites[cell])
            if (cells.radius[cell] > farthest[s]) {
                farthest[s] = cells.radius[cell];
                pole[s] = VoronoiVertexId(merged.of_cell[cell]);
            }
    return pole;
}

}  // namespace

VoronoiComplex build_voronoi(const Surface& surface, const VoronoiOptions& options, StageContext& context) {
    Tetrahedra tetrahedra = delaunay_tetrahedra(surface.points);
    context.check_cancelled();
    const auto duplicates = std::move(tetrahedra.duplicates);
    const InsideCells cells = find_inside_cells(surface, std::move(tetrahedra), context);
    if (cells.count() == 0)
        throw StageError(Stage::kVoronoi, ErrorCode::kNoLumen,
                         "no maximal ball lies inside the surface of " + counted(surface.site_count(), "vertex") +
                             ": it is flat or encloses nothing; check that it is the wall of a vessel lumen");
    const MergedVertices merged =
        merge_vertices(cells, options.merge_tolerance, kRoundingFactor * surface.coordinate_rounding);

    VoronoiComplex complex;
    build_polygons(cells, merged, complex, context);
    const std::size_t bridges = bridge_gaps(surface, cells, merged, complex);
    build_incidence(complex);
    complex.pole = find_poles(cells, merged, surface.site_count());
    for (const auto& [duplicate, kept] : duplicates) complex.pole[duplicate] = complex.pole[kept];
    if (!duplicates.empty())
        context.note("coincident_sites", counted(duplicates.size(), "site") + " at the place of another share its pole",
                     static_cast<double>(duplicates.size()));
    if (bridges > 0)
        context.note("gaps_bridged",
                     counted(bridges, "edge") + " added where parts of the lumen hang together by less than a triangle",
                     static_cast<double>(bridges));
    if (cells.cut_edges > 0)
        context.note(
            "voronoi_edges_cut",
            counted(cells.cut_edges, "Voronoi edge") + " between balls inside the lumen would pass through its wall",
            static_cast<double>(cells.cut_edges));
    return complex;
}

}  // namespace lumenline
