// A queue with stale entries: a vertex may wait in it more than once and counts when it first comes out.
#include "engine/endpoints/shortest_paths.h"

#include <functional>
#include <queue>
#include <utility>

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
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const Seed& s : seeds)
        if (s.time < paths.cost[at(s.vertex)]) {
            paths.cost[at(s.vertex)] = s.time;
            queue.emplace(s.time, s.vertex.value);
        }
    std::vector<bool> done(count, false);
    for (std::size_t settled = 0; !queue.empty();) {
        const auto [cost, v] = queue.top();
        queue.pop();
        if (done[v]) continue;
        done[v] = true;
        if (++settled % kCancelStride == 0) context.check_cancelled();
        const Vec3 from = complex.vertices[v];
        const double radius = complex.ball_radius[v];
        for (const PolygonId p : complex.polygons_of(VoronoiVertexId(v)))
            for (const VoronoiVertexId w : complex.polygon(p)) {
                if (done[at(w)]) continue;
                const double step = distance(from, complex.vertices[at(w)]);
                const double reached = cost + segment_cost(step, radius + complex.ball_radius[at(w)]);
                if (!(reached < paths.cost[at(w)])) continue;
                paths.cost[at(w)] = reached;
                paths.length[at(w)] = paths.length[v] + step;
                paths.parent[at(w)] = VoronoiVertexId(v);
                queue.emplace(reached, w.value);
            }
    }
    return paths;
}

}  // namespace lumenline
