// The same kernel, vertex base and insertion as engine/voronoi/delaunay.cpp, and the same compiler
// flags, so that a ratio to it is what the stages add and nothing else.
#include "bench/bare_delaunay.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bench/measure.h"

namespace lumenline::bench {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using Triangulation = CGAL::Delaunay_triangulation_3<
    Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>>;

}  // namespace

double bare_delaunay_seconds(std::span<const Vec3> points, std::size_t distinct) {
    std::vector<std::pair<Kernel::Point_3, std::uint32_t>> input;
    input.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        input.emplace_back(Kernel::Point_3(points[i].x, points[i].y, points[i].z), static_cast<std::uint32_t>(i));
    Triangulation triangulation;
    const double start = thread_seconds();
    triangulation.insert(input.begin(), input.end());
    const double seconds = thread_seconds() - start;
    if (triangulation.dimension() != 3 || triangulation.number_of_vertices() != distinct)
        throw std::runtime_error("the bare Delaunay triangulation has another number of vertices than there are sites");
    return seconds;
}

}  // namespace lumenline::bench
