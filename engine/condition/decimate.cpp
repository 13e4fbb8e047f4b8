#include "engine/condition/decimate.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModHausdorffT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <string>

#include "engine/core/text.h"

// OpenMesh's decimater: quadrics give the order, its Hausdorff module refuses a collapse that would leave a
// point of the input farther than the error from its triangles, its normal module one that turns a triangle over.
// Half-edge collapses keep points where they are, so sites stay vertices of the file.

namespace lumenline {
namespace {

struct DecimatedTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
    VertexAttributes(OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
    HalfedgeAttributes(OpenMesh::Attributes::Status | OpenMesh::Attributes::PrevHalfedge);
    FaceAttributes(OpenMesh::Attributes::Status | OpenMesh::Attributes::Normal);
};
using Kernel = OpenMesh::TriMesh_ArrayKernelT<DecimatedTraits>;

constexpr double kMostTurn = 45;  // degrees by which a triangle's normal may turn at a collapse

OpenMesh::VertexHandle handle(std::uint32_t v) { return OpenMesh::VertexHandle(static_cast<int>(v)); }

}  // namespace

void decimate_wall(WallMesh& wall, double error, StageContext& context) {
    Kernel mesh;
    for (const Vec3& p : wall.points) mesh.add_vertex({p.x, p.y, p.z});
    for (const Corners& t : wall.triangles)
        if (!mesh.add_face(handle(t[0]), handle(t[1]), handle(t[2])).is_valid())
            refuse(ErrorCode::kNonManifold, "the triangle at " + short_text(wall.points[t[0]]) +
                                                " does not fit its neighbours in a manifold surface; repair it");
    for (const auto v : mesh.vertices()) mesh.status(v).set_locked(mesh.is_boundary(v));
    mesh.update_face_normals();

    OpenMesh::Decimater::DecimaterT<Kernel> decimater(mesh);
    OpenMesh::Decimater::ModQuadricT<Kernel>::Handle quadric;
    OpenMesh::Decimater::ModHausdorffT<Kernel>::Handle distance;
    OpenMesh::Decimater::ModNormalFlippingT<Kernel>::Handle turn;
    decimater.add(quadric);
    decimater.add(distance);
    decimater.add(turn);
    decimater.module(quadric).unset_max_err();
    decimater.module(distance).set_tolerance(error);
    decimater.module(turn).set_max_normal_deviation(static_cast<float>(kMostTurn));
    if (!decimater.initialize()) return;
    decimater.decimate(0);

    const std::size_t points = wall.points.size(), triangles = wall.triangles.size();
    wall.triangles.clear();
    for (const auto f : mesh.faces()) {
        if (mesh.status(f).deleted()) continue;
        Corners c{};
        std::size_t k = 0;
        for (const auto v : mesh.fv_range(f)) c.at(k++) = static_cast<std::uint32_t>(v.idx());
        wall.triangles.push_back(c);
    }
    drop_unused_vertices(wall);
    context.note("decimated",
                 "coarsened within " + short_text(error) + " of the surface: " + std::to_string(points) +
                     " vertices became " + std::to_string(wall.points.size()) + ", " + counted(triangles, "triangle") +
                     " became " + std::to_string(wall.triangles.size()),
                 static_cast<double>(wall.points.size()), static_cast<double>(points));
}

}  // namespace lumenline
