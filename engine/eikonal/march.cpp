// Symbols of the paper: T = time, F = 1/R = the cost, R = ball radius (eq. 5).
// The nodes' position, radius and time lie together, since every update needs all three. An accepted
// vertex offers arrivals over the edges it forms with accepted neighbours. Where a polygon is so
// obtuse that such an offer beats a time already accepted, that vertex enters the heap again: one
// pass alone leaves times up to a tenth too late in such sectors, and lines a third less accurate;
// doing so costs 5 % more pops. Improvements below kImprovement are not worth it, and without this
// bound clusters of tiny polygons on the axis of round tubes would circulate rounding errors.
#include <algorithm>
#include <limits>

#include "engine/eikonal/eikonal.h"

namespace lumenline {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kImprovement = 1e-7;  // of the time

class March {
public:
    March(const VoronoiComplex& complex, EikonalWorkspace& work) : complex_(complex), work_(work) {
        const std::size_t n = complex.vertex_count();
        work.nodes.resize(n);
        for (std::size_t v = 0; v < n; ++v) work.nodes[v] = {complex.vertices[v], complex.ball_radius[v], kInfinity};
        work.accepted.assign(n, false);
        work.heap.reset(n);
    }

    void seed(const Seed& s) { offer(s.vertex.value, s.time); }

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

private:
    /// Heap order: the time of a node.
    struct Key {
        const TimedPoint* nodes;
        double operator()(std::uint32_t v) const { return nodes[v].time; }
    };
    [[nodiscard]] Key key() const { return {work_.nodes.data()}; }

    void offer(std::uint32_t v, double time) {
        if (!(time < (1 - kImprovement) * work_.nodes[v].time)) return;
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
        const TimedPoint* edge_ends[2] = {work_.accepted[before] ? &work_.nodes[before] : nullptr,
                                          work_.accepted[after] && after != before ? &work_.nodes[after] : nullptr};
        for (const VoronoiVertexId to : polygon) {
            const std::uint32_t w = to.value;
            if (w == v) continue;
            const TimedPoint& target = work_.nodes[w];
            double best = from.time < target.time ? vertex_arrival(from, target.x, target.radius) : target.time;
            for (const TimedPoint* end : edge_ends) {
                if (end == nullptr || end == &target || !(std::min(from.time, end->time) < target.time)) continue;
                best = std::min(best, inner_arrival(from, *end, target.x, target.radius));
            }
            offer(w, best);
        }
    }

    const VoronoiComplex& complex_;
    EikonalWorkspace& work_;
};

}  // namespace

ArrivalField solve_eikonal(const VoronoiComplex& complex, std::span<const Seed> seeds, EikonalWorkspace& work,
                           StageContext& context) {
    if (seeds.empty())
        throw StageError(Stage::kEikonal, ErrorCode::kNoSeed, "a front needs at least one vertex to start from");
    March march(complex, work);
    for (const Seed& s : seeds) march.seed(s);
    ArrivalField field;
    field.reached = march.run(context);
    field.time.resize(complex.vertex_count());
    for (std::size_t v = 0; v < field.time.size(); ++v) field.time[v] = work.nodes[v].time;
    field.residual = eikonal_residual(complex, field.time, seeds, kResidualStride);
    return field;
}

}  // namespace lumenline
