#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/stage_context.h"
#include "engine/core/voronoi_complex.h"
#include "engine/geometry/heap.h"
#include "engine/geometry/march_metric.h"

namespace lumenline {

/// Scratch of a march; reusable from call to call, one per concurrent march.
struct MarchWorkspace {
    std::vector<TimedPoint> nodes;
    std::vector<bool> accepted;
    IndexedHeap heap;
};

/// Fast Marching on polygonal non-manifolds (Antiga et al. 2003, section 2.1), to the fixed point.
///
/// When a vertex is accepted, every polygon around it offers its other vertices an arrival straight from
/// it and across its two edges there. Where a polygon is so obtuse that such an offer beats a time already
/// accepted, that vertex enters the heap again: one pass alone leaves times up to a tenth too late in such
/// sectors, and lines a third less accurate; doing so costs 5 % more pops. Improvements too small are not
/// worth it (Metric::worth_below): without this bound clusters of tiny polygons on the axis of round tubes
/// would circulate rounding errors.
/// @cost O(V log V)
template <class Metric>
class PolygonMarch {
public:
    PolygonMarch(const VoronoiComplex& complex, MarchWorkspace& work) : complex_(complex), work_(work) {
        const std::size_t n = complex.vertex_count();
        work.nodes.resize(n);
        for (std::size_t v = 0; v < n; ++v)
            work.nodes[v] = {complex.vertices[v], complex.ball_radius[v], std::numeric_limits<double>::infinity()};
        work.accepted.assign(n, false);
        work.heap.reset(n);
    }

    void seed(VoronoiVertexId v, double time) { offer(v.value, time); }

    /// @returns the number of vertices reached
    /// @throws StageError kInterrupted
    std::size_t run(const StageContext& context) {
        std::size_t reached = 0, pops = 0;
        while (!work_.heap.empty()) {
            if (pops++ % 65536 == 0) context.check_cancelled();
            const std::uint32_t v = work_.heap.pop(key());
            reached += work_.accepted[v] ? 0 : 1;
            work_.accepted[v] = true;
            for (const PolygonId p : complex_.polygons_of(VoronoiVertexId(v))) offer_polygon(complex_.polygon(p), v);
        }
        return reached;
    }

    /// Times of all vertices, when the march is done.
    [[nodiscard]] std::vector<double> times() const {
        std::vector<double> time(work_.nodes.size());
        for (std::size_t v = 0; v < time.size(); ++v) time[v] = work_.nodes[v].time;
        return time;
    }

private:
    /// Heap order: the time of a node.
    struct Key {
        const TimedPoint* nodes;
        double operator()(std::uint32_t v) const { return nodes[v].time; }
    };
    [[nodiscard]] Key key() const { return {work_.nodes.data()}; }

    void offer(std::uint32_t v, double time) {
        if (!(time < Metric::worth_below(work_.nodes[v]))) return;
        work_.nodes[v].time = time;
        work_.heap.push_or_decrease(v, key());
    }

    void offer_polygon(std::span<const VoronoiVertexId> polygon, std::uint32_t v) {
        const TimedPoint& from = work_.nodes[v];
        std::size_t i = 0;
        while (polygon[i].value != v) ++i;
        const std::size_t n = polygon.size();
        const std::uint32_t before = polygon[i == 0 ? n - 1 : i - 1].value,
                            after = polygon[i + 1 == n ? 0 : i + 1].value;
        const TimedPoint* ends[2] = {work_.accepted[before] ? &work_.nodes[before] : nullptr,
                                     work_.accepted[after] && after != before ? &work_.nodes[after] : nullptr};
        std::optional<typename Metric::Edge> edges[2];
        for (const VoronoiVertexId to : polygon) {
            const std::uint32_t w = to.value;
            if (w == v) continue;
            const TimedPoint& target = work_.nodes[w];
            double best = from.time < target.time ? Metric::arrival(from, target) : target.time;
            for (int k = 0; k < 2; ++k) {
                const TimedPoint* end = ends[k];
                if (end == nullptr || end == &target || !(std::min(from.time, end->time) < target.time)) continue;
                if (!edges[k]) edges[k].emplace(from, *end);
                best = std::min(best, edges[k]->arrival(target));
            }
            offer(w, best);
        }
    }

    const VoronoiComplex& complex_;
    MarchWorkspace& work_;
};

}  // namespace lumenline
