// Every offer of the polygons around a vertex is made again on the finished field. Only an edge or vertex earlier
// than v can be the cause of its time, which spares half the work.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/eikonal/eikonal.h"

namespace lumenline {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Least arrival at the polygon's vertex number `target` that the polygon offers.
double least_offer(const VoronoiComplex& complex, std::span<const double> time,
                   std::span<const VoronoiVertexId> polygon, std::size_t target) {
    const auto node = [&](std::size_t i) {
        const std::size_t v = at(polygon[i]);
        return TimedPoint{complex.vertices[v], complex.ball_radius[v], time[v]};
    };
    const TimedPoint w = node(target);
    const std::size_t n = polygon.size();
    double least = kInfinity;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t j = i + 1 == n ? 0 : i + 1;
        const double ti = time[at(polygon[i])], tj = time[at(polygon[j])];
        if (i != target && ti < w.time) least = std::min(least, vertex_arrival(node(i), w.x, w.radius));
        const bool opposite = i != target && j != target && n > 2;
        if (!opposite || !(std::min(ti, tj) < w.time) || !(std::max(ti, tj) < kInfinity)) continue;
        least = std::min(least, inner_arrival(node(i), node(j), w.x, w.radius));
    }
    return least;
}

}  // namespace

double eikonal_residual(const VoronoiComplex& complex, std::span<const double> time, std::span<const Seed> seeds,
                        std::size_t stride) {
    std::vector<Seed> fixed(seeds.begin(), seeds.end());
    std::sort(fixed.begin(), fixed.end(), [](const Seed& a, const Seed& b) { return a.vertex < b.vertex; });
    double residual = 0;
    auto seed = fixed.begin();
    for (std::size_t v = 0; v < time.size(); v += stride) {
        double update = kInfinity;
        for (; seed != fixed.end() && at(seed->vertex) <= v; ++seed)
            if (at(seed->vertex) == v) update = std::min(update, seed->time);
        for (const PolygonId p : complex.polygons_of(VoronoiVertexId(v))) {
            const auto polygon = complex.polygon(p);
            std::size_t i = 0;
            while (at(polygon[i]) != v) ++i;
            update = std::min(update, least_offer(complex, time, polygon, i));
        }
        if (time[v] == update) continue;
        if (!(time[v] > 0 && time[v] < kInfinity)) return kInfinity;  // unreached, though an offer stands; or uncaused
        residual = std::max(residual, std::fabs(time[v] - update) / time[v]);
    }
    return residual;
}

}  // namespace lumenline
