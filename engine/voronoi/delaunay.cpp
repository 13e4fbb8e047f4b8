// CGAL's sequential Delaunay triangulation, flattened at once into arrays: everything later walks
// arrays, and the triangulation's memory is given back. Its parallel variant costs 22-36 % more on
// one thread and gains less than running models side by side.
#include "engine/voronoi/delaunay.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <utility>

namespace lumenline {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using CellBase =
    CGAL::Triangulation_cell_base_with_info_3<std::uint32_t, Kernel, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Triangulation =
    CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

/// Pairs every point that has no vertex with the one that took its place.
std::vector<std::array<std::uint32_t, 2>> find_duplicates(const Triangulation& triangulation,
                                                          std::span<const Vec3> points) {
    std::vector<std::array<std::uint32_t, 2>> duplicates;
    if (triangulation.number_of_vertices() == points.size()) return duplicates;
    std::vector<bool> present(points.size(), false);
    for (const auto v : triangulation.finite_vertex_handles()) present[v->info()] = true;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!present[i]) {
            const auto v = triangulation.nearest_vertex({points[i].x, points[i].y, points[i].z});
            duplicates.push_back({static_cast<std::uint32_t>(i), v->info()});
        }
    return duplicates;
}

}  // namespace

Tetrahedra delaunay_tetrahedra(std::span<const Vec3> points) {
    std::vector<std::pair<Kernel::Point_3, std::uint32_t>> input;
    input.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        input.emplace_back(Kernel::Point_3(points[i].x, points[i].y, points[i].z), static_cast<std::uint32_t>(i));
    Triangulation triangulation;
    triangulation.insert(input.begin(), input.end());
    input = {};

    Tetrahedra result;
    if (triangulation.dimension() < 3) return result;
    result.duplicates = find_duplicates(triangulation, points);
    std::uint32_t count = 0;
    for (auto cell = triangulation.all_cells_begin(); cell != triangulation.all_cells_end(); ++cell)
        cell->info() = triangulation.is_infinite(cell) ? Tetrahedra::kOuter : count++;
    result.sites.resize(count);
    result.neighbours.resize(count);
    for (auto cell = triangulation.all_cells_begin(); cell != triangulation.all_cells_end(); ++cell) {
        const std::uint32_t i = cell->info();
        if (i == Tetrahedra::kOuter) continue;
        for (int k = 0; k < 4; ++k) {
            result.sites[i][static_cast<std::size_t>(k)] = cell->vertex(k)->info();
            result.neighbours[i][static_cast<std::size_t>(k)] = cell->neighbor(k)->info();
        }
    }
    return result;
}

}  // namespace lumenline
