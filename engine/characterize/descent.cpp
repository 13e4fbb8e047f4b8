// T~ falls from point to point, so a descent ends: an edge's inside is left for a lower point or for the lower of its
// own ends, which may be as high as it; a vertex always has a lower point, the one that its time came from.
// A descent that comes to a vertex goes on as the descent from there: the stack of vertices that wait for each other
// unwinds from the path upwards.
#include "engine/characterize/descent.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumenline {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kUnknown = ~0U;

}  // namespace

Descent::Descent(const VoronoiComplex& complex, const PathPieces& pieces, std::span<const TimedPoint> nodes)
    : complex_(complex), pieces_(pieces), nodes_(nodes), known_(complex.vertex_count(), kUnknown) {}

void Descent::try_polygon(PolygonId p, const Here& here, Step& best) const {
    if (pieces_.crosses(p)) {
        const PathFoot foot = pieces_.nearest(p, here.x, here.radius);
        if (foot.distance <= best.value) best = {foot.distance, {}, foot, p};
    }
    const auto loop = complex_.polygon(p);
    const ComplexPoint& place = here.place;
    const std::size_t n = loop.size();
    const TimedPoint target{here.x, here.radius, here.time};
    for (std::size_t i = 0; i < n; ++i) {
        const VoronoiVertexId a = loop[i], b = loop[i + 1 == n ? 0 : i + 1];
        const double ta = nodes_[at(a)].time, tb = nodes_[at(b)].time;
        const bool own_end = a == place.a || a == place.b;
        if (ta < here.time || (own_end && !place.is_vertex() && ta <= here.time)) {
            const double value = ta + distance(here.x, nodes_[at(a)].x);
            if (value < best.value) best = {value, {a, a, 0}, {}, p};
        }
        if (n == 2 || !(std::min(ta, tb) < here.time) || !(std::max(ta, tb) < kInfinity)) continue;
        if (own_end && (b == place.a || b == place.b || place.is_vertex())) continue;
        if (place.is_vertex() && b == place.a) continue;
        const TimedPoint &pa = nodes_[at(a)], &pb = nodes_[at(b)];
        const UnitMetric::Edge edge(pa, pb);
        const double value = edge.arrival(target);
        if (!(value < best.value)) continue;
        const double t = edge.start_of_ray(target);
        if (t > 0 && t < 1 && (1 - t) * ta + t * tb < here.time) best = {value, {a, b, t}, {}, p};
    }
}

Descent::Here Descent::arrive(const ComplexPoint& place) const {
    const double time = place.is_vertex()
                            ? nodes_[at(place.a)].time
                            : (1 - place.t) * nodes_[at(place.a)].time + place.t * nodes_[at(place.b)].time;
    return {position(complex_, place), complex_.ball_radius[at(place.a)], time, place, {}};
}

Descent::Step Descent::best_step(const Here& here) const {
    Step best{kInfinity, {}, {}, {}};
    for (const PolygonId p : complex_.polygons_of(here.place.a)) {
        if (p == here.through) continue;
        const auto loop = complex_.polygon(p);
        if (here.place.is_vertex() || std::find(loop.begin(), loop.end(), here.place.b) != loop.end())
            try_polygon(p, here, best);
    }
    // Back into the polygon just crossed: a point there would have been better from the start, up to the linear T~.
    if (!(best.value < kInfinity) && !here.through.is_none()) try_polygon(here.through, here, best);
    return best;
}

DescentEnd Descent::from(VoronoiVertexId v) {
    /// A vertex and how far it is, along the descent, to the next one of the stack.
    struct Waiting {
        VoronoiVertexId vertex;
        double length;
    };
    std::vector<Waiting> stack;
    DescentEnd end;
    while (known_[at(v)] == kUnknown) {
        stack.push_back({v, 0});
        Here here = arrive({v, v, 0});
        Step step = here.time < kInfinity ? best_step(here) : Step{kInfinity, {}, {}, {}};
        double& length = stack.back().length;
        while (step.value < kInfinity && !step.place.a.is_none() && !step.place.is_vertex()) {
            Here next = arrive(step.place);
            next.through = step.through;
            length += distance(here.x, next.x);
            here = next;
            step = best_step(here);
        }
        if (!step.place.a.is_none()) {
            length += distance(here.x, complex_.vertices[at(step.place.a)]);
            v = step.place.a;
            continue;
        }
        end.foot = step.foot;
        end.length = end.reached() ? step.foot.distance : 0;
        break;
    }
    if (known_[at(v)] != kUnknown) end = ends_[known_[at(v)]];
    const VoronoiVertexId first = stack.empty() ? v : stack.front().vertex;
    for (; !stack.empty(); stack.pop_back()) {
        end.length += stack.back().length;
        known_[at(stack.back().vertex)] = static_cast<std::uint32_t>(ends_.size());
        ends_.push_back(end);
    }
    return ends_[known_[at(first)]];
}

double Descent::distance_at(PolygonId p, Vec3 x, double radius) const {
    Step best{kInfinity, {}, {}, {}};
    try_polygon(p, {x, radius, kInfinity, {}, {}}, best);
    return best.value;
}

}  // namespace lumenline
