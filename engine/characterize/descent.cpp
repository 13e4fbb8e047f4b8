// T~ falls from point to point, so a descent ends: an edge's inside is left for a lower point or for the lower of its
// own ends, which may be as high as it; a vertex always has a lower point, the one that its time came from.
// A descent that comes to a vertex goes on as the descent from there. One that comes to an edge whose two ends, both
// lower than its start, descend to nearby places of one line goes on between their descents, in proportion: its length,
// interpolated, bounds that of a line between their ends. Walking every descent to the end would cost as many steps as
// there are polygons on the way, which grows with the mesh.
#include "engine/characterize/descent.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumenline {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTogether = 2;  // edge lengths between two descents that go on as one

}  // namespace

Descent::Descent(const VoronoiComplex& complex, const PathPieces& pieces, const PathLines& path,
                 const MarchWorkspace& march)
    : complex_(complex),
      pieces_(pieces),
      path_(path),
      time_(march.time),
      through_(march.through),
      state_(complex.vertex_count()),
      ends_(complex.vertex_count()) {}

void Descent::store(VoronoiVertexId v, const DescentEnd& end) {
    std::atomic<State>& state = state_[at(v)];
    State expected = State::kUnknown;
    if (state.compare_exchange_strong(expected, State::kBeingStored, std::memory_order_acq_rel)) {
        ends_[at(v)] = end;
        state.store(State::kKnown, std::memory_order_release);
        state.notify_all();
        return;
    }
    state.wait(State::kBeingStored, std::memory_order_acquire);  // another thread copies the same end
}

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
        const double ta = time_[at(a)], tb = time_[at(b)];
        const bool own_end = a == place.a || a == place.b;
        if (ta < here.time || (own_end && !place.is_vertex() && ta <= here.time)) {
            const double value = ta + distance(here.x, complex_.vertices[at(a)]);
            if (value < best.value) best = {value, {a, a, 0}, {}, p};
        }
        if (n == 2 || !(std::min(ta, tb) < here.time) || !(std::max(ta, tb) < kInfinity)) continue;
        if (own_end && (b == place.a || b == place.b || place.is_vertex())) continue;
        if (place.is_vertex() && b == place.a) continue;
        const TimedPoint pa = node(a), pb = node(b);
        const UnitMetric::Edge edge(pa, pb);
        const double value = edge.arrival(target);
        if (!(value < best.value)) continue;
        const double t = edge.start_of_ray(target);
        if (t > 0 && t < 1 && (1 - t) * ta + t * tb < here.time) best = {value, {a, b, t}, {}, p};
    }
}

Descent::Here Descent::arrive(const ComplexPoint& place) const {
    const double time =
        place.is_vertex() ? time_[at(place.a)] : (1 - place.t) * time_[at(place.a)] + place.t * time_[at(place.b)];
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

Descent::Step Descent::first_step(VoronoiVertexId v, const Here& here) const {
    Step best{kInfinity, {}, {}, {}};
    if (!(here.time < kInfinity)) return best;
    try_polygon(through_[at(v)], here, best);
    return best.value < kInfinity ? best : best_step(here);
}

bool Descent::joined(const ComplexPoint& place, DescentEnd& end) const {
    const DescentEnd &a = ends_[at(place.a)], &b = ends_[at(place.b)];
    if (!a.reached() || a.foot.line != b.foot.line) return false;
    const auto along = [&](const PathFoot& foot) {
        const double from = path_.abscissa[foot.point];
        return from + foot.share * (path_.abscissa[foot.point + 1] - from);
    };
    const double sa = along(a.foot), sb = along(b.foot);
    if (std::fabs(sa - sb) > kTogether * distance(complex_.vertices[at(place.a)], complex_.vertices[at(place.b)]))
        return false;
    const double s = (1 - place.t) * sa + place.t * sb;
    std::uint32_t k = a.foot.point;
    const std::uint32_t last = b.foot.point;
    while (k < last && path_.abscissa[k + 1] < s) ++k;
    while (k > last && path_.abscissa[k] > s) --k;
    const double step = path_.abscissa[k + 1] - path_.abscissa[k];
    end.foot = a.foot;
    end.foot.point = k;
    end.foot.share = step > 0 ? std::clamp((s - path_.abscissa[k]) / step, 0.0, 1.0) : 0.0;
    end.foot.x = lerp(path_.points[k], path_.points[k + 1], end.foot.share);
    end.length =
        (1 - place.t) * a.length + place.t * b.length + distance(end.foot.x, lerp(a.foot.x, b.foot.x, place.t));
    return true;
}

bool Descent::walk(VoronoiVertexId v, std::vector<VoronoiVertexId>& needed, DescentEnd& end) const {
    Here here = arrive({v, v, 0});
    double length = 0;
    const auto need = [&](VoronoiVertexId w) {
        if (!known(w)) needed.push_back(w);
    };
    for (Step step = first_step(v, here);; step = best_step(here)) {
        if (step.place.a.is_none()) {
            end = {step.foot, step.foot.line.is_none() ? 0 : length + step.foot.distance};
            return true;
        }
        Here next = arrive(step.place);
        next.through = step.through;
        length += distance(here.x, next.x);
        if (step.place.is_vertex()) {
            need(step.place.a);
            if (!needed.empty()) return false;
            end = ends_[at(step.place.a)];
            end.length += length;
            return true;
        }
        if (std::max(time_[at(step.place.a)], time_[at(step.place.b)]) < time_[at(v)]) {
            need(step.place.a);
            need(step.place.b);
            if (!needed.empty()) return false;
            if (joined(step.place, end)) {
                end.length += length;
                return true;
            }
        }
        here = next;
    }
}

DescentEnd Descent::from(VoronoiVertexId v) {
    std::vector<VoronoiVertexId> stack{v}, needed;
    while (!stack.empty()) {
        const VoronoiVertexId top = stack.back();
        DescentEnd end;
        needed.clear();
        if (known(top)) {
            stack.pop_back();
        } else if (walk(top, needed, end)) {
            store(top, end);
            stack.pop_back();
        } else {
            stack.insert(stack.end(), needed.begin(), needed.end());
        }
    }
    return ends_[at(v)];
}

double Descent::distance_at(PolygonId p, Vec3 x, double radius) const {
    Step best{kInfinity, {}, {}, {}};
    try_polygon(p, {x, radius, kInfinity, {}, {}}, best);
    return best.value;
}

}  // namespace lumenline
