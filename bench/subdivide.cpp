// OpenMesh's LoopT misplaces vertices of high valence. For a benchmark that is of no consequence:
// the surface stays a vessel of the wanted number of vertices.
#include "bench/subdivide.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/LoopT.hh>
#include <stdexcept>
#include <vector>

namespace lumenline::bench {

namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<DoubleTraits>;

}  // namespace

TriangleSoup loop_subdivided(const TriangleSoup& soup, int levels) {
    if (levels == 0) return soup;
    Mesh mesh;
    std::vector<Mesh::VertexHandle> vertices;
    for (const Vec3& p : soup.points) vertices.push_back(mesh.add_vertex({p.x, p.y, p.z}));
    for (const auto& t : soup.triangles)
        if (!mesh.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]).is_valid())
            throw std::runtime_error(soup.source_file + ": no oriented manifold, cannot be subdivided");
    OpenMesh::Subdivider::Uniform::LoopT<Mesh> loop;
    loop.attach(mesh);
    loop(static_cast<std::size_t>(levels));
    loop.detach();

    TriangleSoup fine;
    fine.source_file = soup.source_file;
    for (const auto v : mesh.vertices()) fine.points.push_back({mesh.point(v)[0], mesh.point(v)[1], mesh.point(v)[2]});
    for (const auto f : mesh.faces()) {
        std::array<std::uint32_t, 3> corners{};
        std::size_t k = 0;
        for (const auto v : mesh.fv_range(f)) corners.at(k++) = static_cast<std::uint32_t>(v.idx());
        fine.triangles.push_back(corners);
    }
    return fine;
}

}  // namespace lumenline::bench
