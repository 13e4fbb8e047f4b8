// The heap's ties go by place in it, which depends on the numbering alone: equal costs are rare, and only an order
// among them.
#include "engine/endpoints/shortest_paths.h"

#include "engine/geometry/heap.h"
#include "engine/geometry/segment_cost.h"

namespace lumenline {

namespace {

constexpr std::size_t kCancelStride = 1 << 14;  // vertices between two looks at the stop flag

}  // namespace

ShortestPaths shortest_paths(const VoronoiComplex& complex, std::span<const Seed> seeds, StageContext& context) {
    const std::size_t count = complex.vertex_count();
    ShortestPaths paths;
    paths.cost.assign(count, std::numeric_limits<double>::infinity());
    paths.length.assign(count, 0);
    paths.parent.assign(count, VoronoiVertexId());
    IndexedHeap heap;
    heap.reset(count);
    const auto key = [&paths](std::uint32_t v) { return paths.cost[v]; };
    for (const Seed& s : seeds)
        if (s.time < paths.cost[at(s.vertex)]) {
            paths.cost[at(s.vertex)] = s.time;
            heap.push_or_decrease(s.vertex.value, key);
        }
    std::vector<bool> done(count, false);
    for (std::size_t settled = 0; !heap.empty();) {
        const std::uint32_t v = heap.pop(key);
        const double cost = paths.cost[v];
        done[v] = true;
        if (++settled % kCancelStride == 0) context.check_cancelled();
        const Vec3 from = complex.vertices[v];
        const double radius = complex.ball_radius[v];
        for (const PolygonId p : complex.polygons_of(VoronoiVertexId(v)))
            for (const VoronoiVertexId w : complex.polygon(p)) {
                if (done[at(w)] || !(cost < paths.cost[at(w)])) continue;
                const double step = distance(from, complex.vertices[at(w)]);
                const double reached = cost + segment_cost(step, radius + complex.ball_radius[at(w)]);
                if (!(reached < paths.cost[at(w)])) continue;
                paths.cost[at(w)] = reached;
                paths.length[at(w)] = paths.length[v] + step;
                paths.parent[at(w)] = VoronoiVertexId(v);
                heap.push_or_decrease(w.value, key);
            }
    }
    return paths;
}

}  // namespace lumenline
