#include "engine/condition/wall_topology.h"

#include <OpenMesh/Core/Mesh/Traits.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <mutex>
#include <string>
#include <utility>

#include "engine/core/text.h"

// OpenMesh reports a triangle that does not fit by an invalid handle and a line on its own error
// stream; the handle is checked and the stream silenced.
//
// Splitting a vertex where two holes touch merges them into one loop that passes the place twice.
// Capping the holes one by one with a single vertex there gives a manifold again, so such copies
// are joined and the loop is cut: walking along it with a stack, a place met again closes a loop
// of its own. A loop of two edges is a slit, and joining the copies has closed it.

namespace lumenline {
namespace {

struct WallTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};
using Kernel = OpenMesh::TriMesh_ArrayKernelT<WallTraits>;

void silence_openmesh() {
    static std::once_flag once;
    std::call_once(once, [] {
        omerr().disable();
        omlog().disable();
    });
}

int signed_index(std::size_t i) { return static_cast<int>(i); }

Kernel build_kernel(const WallMesh& wall) {
    silence_openmesh();
    Kernel mesh;
    mesh.reserve(wall.points.size(), wall.points.size() + wall.triangles.size(), wall.triangles.size());
    for (const Vec3& p : wall.points) mesh.add_vertex({p.x, p.y, p.z});
    for (std::size_t t = 0; t < wall.triangles.size(); ++t) {
        const Corners& c = wall.triangles[t];
        const auto face =
            mesh.add_face(OpenMesh::VertexHandle(signed_index(c[0])), OpenMesh::VertexHandle(signed_index(c[1])),
                          OpenMesh::VertexHandle(signed_index(c[2])));
        if (!face.is_valid())
            refuse(ErrorCode::kNonManifold, "the triangle at " + short_text(wall.points[c[0]]) +
                                                " does not fit its neighbours in a manifold surface; repair it");
    }
    return mesh;
}

std::uint32_t unsigned_index(OpenMesh::VertexHandle v) { return static_cast<std::uint32_t>(v.idx()); }

std::vector<Loop> boundary_loops(const Kernel& mesh) {
    std::vector<Loop> loops;
    std::vector<char> visited(mesh.n_halfedges(), 0);
    for (const auto start : mesh.halfedges()) {
        if (!mesh.is_boundary(start) || visited[static_cast<std::size_t>(start.idx())]) continue;
        Loop loop;
        OpenMesh::HalfedgeHandle h = start;
        do {
            visited[static_cast<std::size_t>(h.idx())] = 1;
            loop.push_back(unsigned_index(mesh.from_vertex_handle(h)));
            h = mesh.next_halfedge_handle(h);
        } while (h != start);
        loops.push_back(std::move(loop));
    }
    return loops;
}

void sort_loops(std::vector<Loop>& loops) {
    for (Loop& loop : loops) std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    std::sort(loops.begin(), loops.end());
}

void label_components(const Kernel& mesh, WallTopology& topology) {
    topology.component.assign(mesh.n_vertices(), kDropped);
    std::vector<OpenMesh::VertexHandle> stack;
    for (const auto seed : mesh.vertices()) {
        if (topology.component[unsigned_index(seed)] != kDropped) continue;
        topology.component[unsigned_index(seed)] = topology.component_count;
        stack.push_back(seed);
        while (!stack.empty()) {
            const OpenMesh::VertexHandle v = stack.back();
            stack.pop_back();
            for (auto neighbour = mesh.cvv_iter(v); neighbour.is_valid(); ++neighbour) {
                std::uint32_t& label = topology.component[unsigned_index(*neighbour)];
                if (label != kDropped) continue;
                label = topology.component_count;
                stack.push_back(*neighbour);
            }
        }
        ++topology.component_count;
    }
}

// Cuts one loop wherever it meets a place again; `joined` maps a copy to the vertex it becomes.
void cut_loop(const Loop& loop, const WallMesh& wall, std::vector<std::uint32_t>& joined, std::vector<Loop>& result) {
    Loop open;
    for (const std::uint32_t v : loop) {
        const auto met = std::find_if(open.begin(), open.end(),
                                      [&](std::uint32_t w) { return wall.input_vertex[w] == wall.input_vertex[v]; });
        if (met == open.end()) {
            open.push_back(v);
            continue;
        }
        joined[v] = *met;
        if (open.end() - met > 2) result.emplace_back(met, open.end());
        open.erase(met + 1, open.end());
    }
    if (open.size() > 2) result.push_back(std::move(open));
}

bool repeats_a_place(const Loop& loop, const WallMesh& wall) {
    std::vector<std::uint32_t> places;
    for (const std::uint32_t v : loop) places.push_back(wall.input_vertex[v]);
    std::sort(places.begin(), places.end());
    return std::adjacent_find(places.begin(), places.end()) != places.end();
}

}  // namespace

WallTopology analyse_wall(const WallMesh& wall) {
    const Kernel mesh = build_kernel(wall);
    WallTopology topology;
    topology.loops = boundary_loops(mesh);
    sort_loops(topology.loops);
    label_components(mesh, topology);
    return topology;
}

void pinch_loops(WallMesh& wall, WallTopology& topology) {
    std::vector<std::uint32_t> joined(wall.points.size());
    for (std::size_t v = 0; v < joined.size(); ++v) joined[v] = static_cast<std::uint32_t>(v);
    std::vector<Loop> loops;
    bool changed = false;
    for (const Loop& loop : topology.loops) {
        if (!repeats_a_place(loop, wall)) {
            loops.push_back(loop);
            continue;
        }
        cut_loop(loop, wall, joined, loops);
        changed = true;
    }
    if (!changed) return;
    for (Corners& t : wall.triangles)
        for (std::uint32_t& v : t) v = joined[v];
    for (Loop& loop : loops)
        for (std::uint32_t& v : loop) v = joined[v];
    const std::vector<std::uint32_t> renumbered = drop_unused_vertices(wall);
    for (Loop& loop : loops)
        for (std::uint32_t& v : loop) v = renumbered[v];
    sort_loops(loops);
    topology.loops = std::move(loops);
    std::size_t kept = 0;
    for (std::size_t v = 0; v < renumbered.size(); ++v)
        if (renumbered[v] != kDropped) topology.component[kept++] = topology.component[v];
    topology.component.resize(kept);
}

}  // namespace lumenline
