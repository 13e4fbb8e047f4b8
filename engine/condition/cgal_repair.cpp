#include "engine/condition/cgal_repair.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/refine.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <iterator>
#include <numeric>

// The only unit of this stage that includes CGAL's polygon mesh processing, which takes long to
// compile. The soup orienter wants a point range merely to copy elements of it, so vertex numbers
// serve as points and come back as the source of every copy.

namespace lumenline {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

Kernel::Point_3 to_cgal(Vec3 p) { return {p.x, p.y, p.z}; }

Mesh to_cgal(const std::vector<Vec3>& points, const std::vector<Corners>& triangles) {
    Mesh mesh;
    mesh.reserve(static_cast<Mesh::size_type>(points.size()), static_cast<Mesh::size_type>(3 * triangles.size() / 2),
                 static_cast<Mesh::size_type>(triangles.size()));
    for (const Vec3& p : points) mesh.add_vertex(to_cgal(p));
    for (const Corners& t : triangles)
        if (mesh.add_face(Mesh::Vertex_index(t[0]), Mesh::Vertex_index(t[1]), Mesh::Vertex_index(t[2])) ==
            Mesh::null_face())
            refuse(ErrorCode::kNonManifold, "the closed surface is not manifold");
    return mesh;
}

}  // namespace

OrientedSoup orient_soup(const std::vector<Corners>& triangles, std::size_t vertex_count) {
    OrientedSoup soup;
    soup.source.resize(vertex_count);
    std::iota(soup.source.begin(), soup.source.end(), 0U);
    std::vector<std::array<std::size_t, 3>> polygons(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        polygons[t] = {triangles[t][0], triangles[t][1], triangles[t][2]};
    pmp::orient_polygon_soup(soup.source, polygons);
    soup.triangles.resize(polygons.size());
    for (std::size_t t = 0; t < polygons.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) soup.triangles[t][k] = static_cast<std::uint32_t>(polygons[t][k]);
    return soup;
}

std::vector<char> inside_closed_mesh(const std::vector<Vec3>& points, const std::vector<Corners>& triangles,
                                     std::span<const Vec3> queries) {
    const Mesh mesh = to_cgal(points, triangles);
    const CGAL::Side_of_triangle_mesh<Mesh, Kernel> side(mesh);
    std::vector<char> inside;
    for (const Vec3& q : queries) inside.push_back(side(to_cgal(q)) == CGAL::ON_BOUNDED_SIDE);
    return inside;
}

std::optional<Patch> triangulate_loop(std::span<const Vec3> loop, bool refined) {
    std::vector<Kernel::Point_3> polyline;
    for (const Vec3& p : loop) polyline.push_back(to_cgal(p));
    std::vector<CGAL::Triple<int, int, int>> triples;
    pmp::triangulate_hole_polyline(polyline, std::back_inserter(triples));
    if (triples.size() + 2 != loop.size()) return std::nullopt;
    Patch patch;
    for (const auto& [a, b, c] : triples)
        patch.triangles.push_back(
            {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
    if (!refined) return patch;

    Mesh mesh = to_cgal({loop.begin(), loop.end()}, patch.triangles);
    std::vector<Mesh::Face_index> new_faces;
    std::vector<Mesh::Vertex_index> new_vertices;
    const std::vector<Mesh::Face_index> old_faces(mesh.faces().begin(), mesh.faces().end());
    pmp::refine(mesh, old_faces, std::back_inserter(new_faces), std::back_inserter(new_vertices));
    patch.triangles.clear();
    for (std::size_t v = loop.size(); v < mesh.number_of_vertices(); ++v) {
        const Kernel::Point_3& p = mesh.point(Mesh::Vertex_index(static_cast<Mesh::size_type>(v)));
        patch.points.push_back({p.x(), p.y(), p.z()});
    }
    for (const Mesh::Face_index f : mesh.faces()) {
        Corners t{};
        std::size_t k = 0;
        for (const Mesh::Vertex_index v : mesh.vertices_around_face(mesh.halfedge(f))) t[k++] = v;
        patch.triangles.push_back(t);
    }
    return patch;
}

}  // namespace lumenline
