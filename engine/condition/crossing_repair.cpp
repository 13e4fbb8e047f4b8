#include "engine/condition/crossing_repair.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>

#include "engine/condition/cgal_repair.h"
#include "engine/condition/crossings.h"
#include "engine/condition/half_edges.h"
#include "engine/core/text.h"

// Patches are tried one by one, since one that cannot be mended must not keep the others from it. The new
// triangles span the loop as CGAL's minimal triangulation does and know nothing of the wall: hence the test of
// the whole afterwards, with the same predicates that found the crossings.

namespace lumenline {
namespace {

constexpr double kMostArea = 0.02;  // of a patch, per area of the wall
constexpr std::size_t kMostCrossings = 20000;
constexpr std::size_t kMostPatches = 200;  // each costs a test of the whole
constexpr int kMostRings = 3;

double area_of(const WallMesh& wall, const Corners& t) {
    return norm(cross(wall.points[t[1]] - wall.points[t[0]], wall.points[t[2]] - wall.points[t[0]])) / 2;
}

// Groups of crossing triangles that hang together by common corners, as lists of triangles: of a spike and the wall
// that it pierces, each is a group, and to take out one of them is enough.
std::vector<std::vector<std::uint32_t>> clusters_of(const WallMesh& wall,
                                                    const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) {
    std::vector<std::uint32_t> crossing;
    for (const auto& [a, b] : pairs) {
        crossing.push_back(a);
        crossing.push_back(b);
    }
    std::sort(crossing.begin(), crossing.end());
    crossing.erase(std::unique(crossing.begin(), crossing.end()), crossing.end());
    std::vector<std::uint32_t> parent(crossing.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](std::uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    const auto join = [&](std::uint32_t i, std::uint32_t j) {
        const std::uint32_t a = root(i), b = root(j);
        parent[std::max(a, b)] = std::min(a, b);
    };
    std::vector<std::uint32_t> last(wall.points.size(), kDropped);
    for (std::uint32_t i = 0; i < crossing.size(); ++i)
        for (const std::uint32_t v : wall.triangles[crossing[i]]) {
            if (last[v] != kDropped) join(last[v], i);
            last[v] = i;
        }
    std::vector<std::vector<std::uint32_t>> groups(crossing.size());
    for (std::uint32_t i = 0; i < crossing.size(); ++i) groups[root(i)].push_back(crossing[i]);
    std::erase_if(groups, [](const auto& g) { return g.empty(); });
    return groups;
}

class Patcher {
public:
    Patcher(const WallMesh& wall, const WallTopology& topology) : wall_(wall), topology_(topology) {
        for (const Corners& t : wall.triangles) area_ += area_of(wall, t);
    }

    // The wall without the patch of `rings` rings around `triangles`, filled; false if that is no local matter.
    bool fill(const std::vector<std::uint32_t>& triangles, int rings, WallMesh& result) const {
        const std::vector<char> removed = grow(triangles, rings);
        const Loop loop = rim(removed);
        if (loop.size() < 3) return false;
        std::vector<Vec3> corners;
        for (const std::uint32_t v : loop) corners.push_back(wall_.points[v]);
        const auto patch = triangulate_loop(corners, true);
        if (!patch) return false;
        result = wall_;
        const auto first = static_cast<std::uint32_t>(wall_.points.size());
        const auto n = static_cast<std::uint32_t>(loop.size());
        result.points.insert(result.points.end(), patch->points.begin(), patch->points.end());
        result.input_vertex.resize(result.points.size(), kDropped);
        result.triangles.clear();
        for (std::size_t t = 0; t < removed.size(); ++t)
            if (!removed[t]) result.triangles.push_back(wall_.triangles[t]);
        const auto vertex = [&](std::uint32_t v) { return v < n ? loop[v] : first + v - n; };
        for (const Corners& t : patch->triangles)
            result.triangles.push_back({vertex(t[0]), vertex(t[1]), vertex(t[2])});
        double area = 0;  // of the patch: a spike that it replaces may be larger than all that is around it
        for (std::size_t t = result.triangles.size() - patch->triangles.size(); t < result.triangles.size(); ++t)
            area += area_of(result, result.triangles[t]);
        if (area > kMostArea * area_) return false;
        drop_unused_vertices(result);
        return true;
    }

private:
    [[nodiscard]] std::vector<char> grow(const std::vector<std::uint32_t>& triangles, int rings) const {
        std::vector<char> in(wall_.triangles.size(), 0), touched(wall_.points.size(), 0);
        for (const std::uint32_t t : triangles) in[t] = 1;
        for (int ring = 0; ring < rings; ++ring) {
            for (std::size_t t = 0; t < in.size(); ++t)
                if (in[t])
                    for (const std::uint32_t v : wall_.triangles[t]) touched[v] = 1;
            for (std::size_t t = 0; t < in.size(); ++t) {
                const Corners& c = wall_.triangles[t];
                in[t] = touched[c[0]] != 0 || touched[c[1]] != 0 || touched[c[2]] != 0;
            }
        }
        return in;
    }

    // The one loop around the removed triangles; empty if there are several, or if it meets an opening or itself.
    [[nodiscard]] Loop rim(const std::vector<char>& removed) const {
        std::vector<std::uint32_t> next(wall_.points.size(), kDropped);
        std::vector<char> at_opening(wall_.points.size(), 0);
        for (const Loop& loop : topology_.loops)
            for (const std::uint32_t v : loop) at_opening[v] = 1;
        const HalfEdgePairs pairs = pair_half_edges(wall_.triangles, wall_.points.size());
        std::size_t sides = 0;
        std::uint32_t start = kDropped;
        for (std::uint32_t h = 0; h < pairs.opposite.size(); ++h) {
            if (!removed[h / 3]) continue;
            const std::uint32_t a = start_of(wall_.triangles, h), b = start_of(wall_.triangles, next_half_edge(h));
            if (at_opening[a]) return {};
            if (pairs.opposite[h] == kNoHalfEdge) return {};
            if (removed[pairs.opposite[h] / 3]) continue;
            if (next[a] != kDropped) return {};
            next[a] = b;  // along the removed triangle, as its replacement must run
            start = std::min(start, a);
            ++sides;
        }
        Loop loop;
        if (start == kDropped) return loop;
        for (std::uint32_t v = start; loop.size() < sides; v = next[v]) {
            loop.push_back(v);
            if (next[v] == start) break;
        }
        return loop.size() == sides ? loop : Loop();
    }

    const WallMesh& wall_;
    const WallTopology& topology_;
    double area_ = 0;
};

std::int64_t euler(const WallMesh& wall, const WallTopology& topology) {
    std::size_t boundary = 0;
    for (const Loop& loop : topology.loops) boundary += loop.size();
    return static_cast<std::int64_t>(wall.points.size()) -
           static_cast<std::int64_t>((3 * wall.triangles.size() + boundary) / 2) +
           static_cast<std::int64_t>(wall.triangles.size());
}

bool is_manifold(const WallMesh& wall) {
    const HalfEdgePairs pairs = pair_half_edges(wall.triangles, wall.points.size());
    return pairs.first_irregular == kNoHalfEdge &&
           find_split_vertex(wall.triangles, pairs, wall.points.size()) == kDropped;
}

}  // namespace

bool repair_crossings(WallMesh& wall, WallTopology& topology,
                      const std::vector<std::pair<std::uint32_t, std::uint32_t>>& all_pairs, StageContext& context) {
    auto pairs = all_pairs;
    const std::size_t before = pairs.size();
    std::size_t mended = 0, attempts = 0;
    std::vector<Vec3> given_up;  // places of clusters that could not be mended
    while (!pairs.empty() && pairs.size() < kMostCrossings && attempts < kMostPatches) {
        bool changed = false;
        for (const std::vector<std::uint32_t>& cluster : clusters_of(wall, pairs)) {
            const Vec3 place = wall.points[wall.triangles[cluster.front()][0]];
            if (std::find(given_up.begin(), given_up.end(), place) != given_up.end()) continue;
            const Patcher patcher(wall, topology);
            for (int rings = 1; rings <= kMostRings && !changed; ++rings) {
                context.check_cancelled();
                ++attempts;
                WallMesh trial;
                if (!patcher.fill(cluster, rings, trial) || !is_manifold(trial)) continue;
                WallTopology trial_topology = analyse_wall(trial);
                if (trial_topology.component_count != topology.component_count ||
                    trial_topology.loops.size() != topology.loops.size() ||
                    euler(trial, trial_topology) != euler(wall, topology))
                    continue;
                auto left = crossing_triangles(trial.points, trial.triangles, kMostCrossings);
                if (left.size() >= pairs.size()) continue;
                wall = std::move(trial);
                topology = std::move(trial_topology);
                pairs = std::move(left);
                ++mended;
                changed = true;
            }
            if (changed) break;
            given_up.push_back(place);
        }
        if (!changed) break;
    }
    if (mended == 0) return false;
    context.note("self_intersections_repaired",
                 std::to_string(mended) + (mended == 1 ? " patch" : " patches") +
                     " of the wall replaced where triangles crossed: " + std::to_string(before) +
                     " crossing pairs before, " + std::to_string(pairs.size()) + " after",
                 static_cast<double>(before), static_cast<double>(pairs.size()));
    return true;
}

}  // namespace lumenline
