// Every offer of every polygon is made again on the finished field. Only an edge or vertex earlier
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
        const Arrival across = edge_arrival(node(i), node(j), w.x, w.radius);
        if (across.t > 0 && across.t < 1) least = std::min(least, across.time);
    }
    return least;
}

}  // namespace

double eikonal_residual(const VoronoiComplex& complex, std::span<const double> time, std::span<const Seed> seeds) {
    std::vector<double> update(complex.vertex_count(), kInfinity);
    for (std::size_t p = 0; p < complex.polygon_count(); ++p) {
        const auto polygon = complex.polygon(PolygonId(p));
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const std::size_t v = at(polygon[i]);
            update[v] = std::min(update[v], least_offer(complex, time, polygon, i));
        }
    }
    for (const Seed& s : seeds) update[at(s.vertex)] = std::min(update[at(s.vertex)], s.time);
    double residual = 0;
    for (std::size_t v = 0; v < time.size(); ++v) {
        if (time[v] == update[v]) continue;
        if (!(time[v] > 0 && time[v] < kInfinity)) return kInfinity;  // unreached, though an offer stands; or uncaused
        residual = std::max(residual, std::fabs(time[v] - update[v]) / time[v]);
    }
    return residual;
}

}  // namespace lumenline
