// A polygon is the ring of cells around a finite Delaunay edge; a bare edge a facet between two
// joined inside cells none of whose three edges has a complete polygon.
#include "tests/stages/reference_complex.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "tests/stages/exact_circumcentre.h"

namespace lumenline::test {

namespace {

struct CellInfo {
    Vec3 centre;
    double radius = 0;
    bool inside = false;
};
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using CellBase = CGAL::Triangulation_cell_base_with_info_3<CellInfo, Kernel>;
using Triangulation =
    CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using SitePair = std::array<std::uint32_t, 2>;

SitePair ascending(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

Mesh to_mesh(const Surface& surface) {
    Mesh mesh;
    for (const Vec3& p : surface.points) mesh.add_vertex({p.x, p.y, p.z});
    for (const auto& t : surface.triangles)
        if (mesh.add_face(Mesh::Vertex_index(t[0].value), Mesh::Vertex_index(t[1].value),
                          Mesh::Vertex_index(t[2].value)) == Mesh::null_face())
            throw std::invalid_argument("the surface is not manifold");
    return mesh;
}

void fill_cells(const Surface& surface, Triangulation& triangulation, ReferenceComplex& reference) {
    const Mesh mesh = to_mesh(surface);
    const CGAL::Side_of_triangle_mesh<Mesh, Kernel> side(mesh);
    reference.pole_distance.assign(surface.site_count(), -1);
    for (auto cell = triangulation.finite_cells_begin(); cell != triangulation.finite_cells_end(); ++cell) {
        Corners corners;
        for (int k = 0; k < 4; ++k) corners[static_cast<std::size_t>(k)] = surface.points[cell->vertex(k)->info()];
        const ExactCentre exact = exact_circumcentre(corners);
        const Vec3 c = exact.centre;
        cell->info() = {c, exact.radius, side({c.x, c.y, c.z}) == CGAL::ON_BOUNDED_SIDE};
        if (!cell->info().inside) continue;
        ++reference.inside_cells;
        for (int k = 0; k < 4; ++k) {
            double& pole = reference.pole_distance[cell->vertex(k)->info()];
            pole = std::max(pole, exact.radius);
        }
    }
}

}  // namespace

struct WallCrossing::Tree {
    using Triangles = std::vector<Kernel::Triangle_3>;
    using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
    Triangles triangles;
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree;
};

WallCrossing::WallCrossing(const Surface& surface) : tree_(std::make_unique<Tree>()) {
    const auto point = [&](SiteId s) {
        const Vec3 p = surface.points[at(s)];
        return Kernel::Point_3(p.x, p.y, p.z);
    };
    for (const auto& t : surface.triangles) tree_->triangles.emplace_back(point(t[0]), point(t[1]), point(t[2]));
    tree_->tree.rebuild(tree_->triangles.cbegin(), tree_->triangles.cend());
}

WallCrossing::~WallCrossing() = default;

bool WallCrossing::crosses(Vec3 a, Vec3 b) const {
    return a != b && tree_->tree.do_intersect(Kernel::Segment_3({a.x, a.y, a.z}, {b.x, b.y, b.z}));
}

ReferenceComplex reference_complex(const Surface& surface) {
    std::vector<std::pair<Kernel::Point_3, std::uint32_t>> input;
    for (std::size_t i = 0; i < surface.site_count(); ++i) {
        const Vec3 p = surface.points[i];
        input.emplace_back(Kernel::Point_3(p.x, p.y, p.z), static_cast<std::uint32_t>(i));
    }
    Triangulation triangulation(input.begin(), input.end());
    ReferenceComplex reference;
    fill_cells(surface, triangulation, reference);
    const WallCrossing wall(surface);
    const auto joined = [&](const auto& a, const auto& b) {
        return !triangulation.is_infinite(a) && !triangulation.is_infinite(b) && a->info().inside && b->info().inside &&
               !wall.crosses(a->info().centre, b->info().centre);
    };

    std::set<SitePair> complete;
    for (auto e = triangulation.finite_edges_begin(); e != triangulation.finite_edges_end(); ++e) {
        ReferenceComplex::Polygon polygon;
        polygon.sites = ascending(e->first->vertex(e->second)->info(), e->first->vertex(e->third)->info());
        bool closed = true;
        auto cell = triangulation.incident_cells(*e);
        const auto first = cell;
        do {
            const Triangulation::Cell_handle here = cell, next = ++cell;
            closed = closed && joined(here, next);
            polygon.loop.push_back(here->info().centre);
        } while (cell != first);
        if (!closed) continue;
        complete.insert(polygon.sites);
        reference.polygons.push_back(std::move(polygon));
    }
    std::sort(reference.polygons.begin(), reference.polygons.end(),
              [](const auto& a, const auto& b) { return a.sites < b.sites; });
    for (auto f = triangulation.finite_facets_begin(); f != triangulation.finite_facets_end(); ++f) {
        const auto cell = f->first, other = cell->neighbor(f->second);
        if (triangulation.is_infinite(cell) || triangulation.is_infinite(other)) continue;
        if (cell->info().inside && other->info().inside && !joined(cell, other)) ++reference.crossing_edges;
        if (!joined(cell, other)) continue;
        bool bare = true;
        for (int i = 0; i < 4; ++i)
            for (int j = i + 1; j < 4; ++j)
                if (i != f->second && j != f->second)
                    bare = bare && complete.count(ascending(cell->vertex(i)->info(), cell->vertex(j)->info())) == 0;
        if (bare) reference.bare_edges.push_back({cell->info().centre, other->info().centre});
    }
    return reference;
}

}  // namespace lumenline::test
