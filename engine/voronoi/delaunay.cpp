// CGAL's sequential Delaunay triangulation, flattened at once into arrays: everything later walks
// arrays, and the triangulation's memory is given back. Its parallel variant costs 22-36 % more on
// one thread and gains less than running models side by side.
// Points go in by CGAL's order of insertion. Each search starts at the point before and ends at a cell whose sphere
// holds the point, by inexact predicates with one exact test at the end: the exact search for the cell around the
// point, which insert() adds, is not needed to find the cells in conflict, and costs a twentieth.
#include "engine/voronoi/delaunay.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <utility>

namespace lumenline {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using CellBase =
    CGAL::Triangulation_cell_base_with_info_3<std::uint32_t, Kernel, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Base = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;
using NumberedPoint = std::pair<Kernel::Point_3, std::uint32_t>;

class Triangulation : public Base {
public:
    /// As insert(p, start); fast where `start` is close to p.
    Vertex_handle insert_near(const Point& p, Cell_handle start) {
        if (dimension() < 3) return insert(p, start);
        const Cell_handle cell = inexact_locate(p, start);
        if (is_infinite(cell) || side_of_sphere(cell, p) != CGAL::ON_BOUNDED_SIDE) return insert(p, cell);
        const Conflict_tester_3 tester(p, this);
        return insert_in_conflict(p, CELL, cell, 0, 0, tester, hidden_point_visitor);
    }
};

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
    std::vector<NumberedPoint> input;
    input.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        input.emplace_back(Kernel::Point_3(points[i].x, points[i].y, points[i].z), static_cast<std::uint32_t>(i));
    Triangulation triangulation;
    CGAL::spatial_sort(input.begin(), input.end(),
                       CGAL::Spatial_sort_traits_adapter_3<Kernel, CGAL::First_of_pair_property_map<NumberedPoint>>());
    Triangulation::Cell_handle near;
    for (const auto& [point, number] : input) {
        const auto vertex = triangulation.insert_near(point, near);
        vertex->info() = number;
        near = vertex->cell();
    }
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
