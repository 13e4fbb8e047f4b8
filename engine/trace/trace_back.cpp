// Steepest descent on a piecewise linear time field would need a step size and would follow the
// field's kinks. Instead each step asks for the point y on the boundary of the polygons around x
// that minimises T(y) + cost(y, x), with the same update as the march; T(y) must be below T(x), so
// the descent ends.
#include <algorithm>
#include <limits>

#include "engine/geometry/edge_update.h"
#include "engine/trace/path.h"

namespace lumenline {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Tracer {
public:
    Tracer(const VoronoiComplex& complex, std::span<const double> time, const Endpoint& source)
        : complex_(complex), time_(time), source_(source) {}

    std::optional<ComplexPath> run(const Endpoint& target) {
        ComplexPath path;
        path.start = source_.anchor;
        path.start_radius = source_.anchor_radius;
        path.end = target.anchor;
        path.end_radius = target.anchor_radius;
        position_ = target.anchor;
        radius_ = target.anchor_radius;
        current_time_ = kInfinity;
        polygons_ = target.anchor_polygons;
        while (step()) {
            if (at_source_) {
                std::reverse(path.inner.begin(), path.inner.end());
                return path;
            }
            path.inner.push_back(point_);
        }
        return std::nullopt;
    }

private:
    /// Moves to the best next point; false where none has an earlier time.
    bool step() {
        best_ = kInfinity;
        at_source_ = false;
        for (const PolygonId p : polygons_) try_source(p);
        for (const PolygonId p : polygons_) try_polygon(complex_.polygon(p));
        if (!(best_ < kInfinity)) return false;
        if (at_source_) return true;
        point_ = next_;
        position_ = position(complex_, point_);
        radius_ = ball_radius(complex_, point_);
        current_time_ = point_.is_vertex() ? time_[at(point_.a)]
                                           : (1 - point_.t) * time_[at(point_.a)] + point_.t * time_[at(point_.b)];
        find_polygons();
        return true;
    }

    void try_source(PolygonId p) {
        for (const PolygonId q : source_.anchor_polygons) {
            if (q != p) continue;
            // Times beside the source come from this very segment: rounding must not hide the tie.
            constexpr double kTie = 1 - 1e-12;
            const double cost =
                kTie * segment_cost(distance(position_, source_.anchor), radius_ + source_.anchor_radius);
            if (cost < best_) {
                best_ = cost;
                at_source_ = true;
            }
        }
    }

    void try_polygon(std::span<const VoronoiVertexId> polygon) {
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const VoronoiVertexId a = polygon[i], b = polygon[i + 1 == polygon.size() ? 0 : i + 1];
            const TimedPoint pa = timed(a);
            if (pa.time < current_time_) offer({a, a, 0.0}, vertex_arrival(pa, position_, radius_));
            const bool on_this_edge = (a == point_.a && b == point_.b) || (a == point_.b && b == point_.a);
            const bool at_its_end = point_.is_vertex() && (a == point_.a || b == point_.a);
            if (polygon.size() == 2 || on_this_edge || at_its_end) continue;
            const TimedPoint pb = timed(b);
            if (!(pa.time < kInfinity && pb.time < kInfinity)) continue;
            const Arrival across = edge_arrival(pa, pb, position_, radius_);
            if (across.t <= 0 || across.t >= 1) continue;
            if ((1 - across.t) * pa.time + across.t * pb.time < current_time_) offer({a, b, across.t}, across.time);
        }
    }

    void offer(const ComplexPoint& point, double time) {
        if (!(time < best_)) return;
        best_ = time;
        next_ = point;
        at_source_ = false;
    }

    void find_polygons() {
        polygons_.clear();
        for (const PolygonId p : complex_.polygons_of(point_.a)) {
            const auto loop = complex_.polygon(p);
            if (point_.is_vertex() || std::find(loop.begin(), loop.end(), point_.b) != loop.end())
                polygons_.push_back(p);
        }
    }

    [[nodiscard]] TimedPoint timed(VoronoiVertexId v) const {
        return {complex_.vertices[at(v)], complex_.ball_radius[at(v)], time_[at(v)]};
    }

    const VoronoiComplex& complex_;
    std::span<const double> time_;
    const Endpoint& source_;
    Vec3 position_;
    double radius_ = 0, current_time_ = 0;
    ComplexPoint point_;  // a == b == none at the target's anchor: belongs to no edge
    std::vector<PolygonId> polygons_;
    double best_ = 0;
    ComplexPoint next_;
    bool at_source_ = false;
};

}  // namespace

std::optional<ComplexPath> trace_back(const VoronoiComplex& complex, std::span<const double> time,
                                      const Endpoint& source, const Endpoint& target) {
    return Tracer(complex, time, source).run(target);
}

void thin_path(const VoronoiComplex& complex, ComplexPath& path, double share) {
    std::vector<ComplexPoint> kept;
    Vec3 last = path.start;
    for (const ComplexPoint& p : path.inner) {
        const Vec3 x = position(complex, p);
        const double r = ball_radius(complex, p);
        if (distance(x, last) <= share * r || distance(x, path.end) <= share * r) continue;
        kept.push_back(p);
        last = x;
    }
    path.inner = std::move(kept);
}

double path_cost(const VoronoiComplex& complex, const ComplexPath& path) {
    double cost = 0, radius = path.start_radius;
    Vec3 last = path.start;
    for (const ComplexPoint& p : path.inner) {
        const Vec3 x = position(complex, p);
        const double r = ball_radius(complex, p);
        cost += segment_cost(distance(x, last), r + radius);
        last = x;
        radius = r;
    }
    return cost + segment_cost(distance(path.end, last), path.end_radius + radius);
}

}  // namespace lumenline
