#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/vec3.h"
#include "engine/geometry/edge_update.h"

namespace lumenline {

/// |grad T| = 1/R (Antiga et al. 2003, eq. 5), with the exact cost of segments.
struct InverseRadiusMetric {
    /// An edge of a polygon, as its other vertices see it.
    struct Edge {
        Edge(const TimedPoint& from, const TimedPoint& to) : a(from), b(to) {}
        [[nodiscard]] double arrival(const TimedPoint& w) const { return inner_arrival(a, b, w.x, w.radius); }

        const TimedPoint &a, &b;
    };
    static double arrival(const TimedPoint& a, const TimedPoint& w) { return vertex_arrival(a, w.x, w.radius); }
    /// Times above this are not worth a new one: 1e-7 of the time.
    static double worth_below(double time, double /*radius*/) { return (1 - 1e-7) * time; }
};

/// |grad T| = 1 (eq. 6). A time that is linear along an edge makes a plane front, for which the update
/// is closed: with e = b - a of length L, D = T(b) - T(a), q = w - a and h the height of w over the edge,
/// T(w) = T(a) + (D q.e + h L sqrt(L^2 - D^2)) / L^2.
struct UnitMetric {
    struct Edge {
        Edge(const TimedPoint& from, const TimedPoint& to)
            : a(from), e(to.x - from.x), length2(squared_norm(e)), rise(to.time - from.time) {
            const double squared = length2 - rise * rise;
            run = squared > 0 ? std::sqrt(squared) : 0.0;
        }
        /// +inf where the ray would not start inside the edge.
        [[nodiscard]] double arrival(const TimedPoint& w) const {
            const Vec3 q = w.x - a.x;
            const double along = dot(q, e);
            const double squared = squared_norm(q) * length2 - along * along;
            const double height = squared > 0 ? std::sqrt(squared) : 0.0;
            const double start = along * run - height * rise;
            if (!(start > 0 && start < length2 * run)) return std::numeric_limits<double>::infinity();
            return a.time + (rise * along + run * height) / length2;
        }

        /// Where on the edge the ray starts, 0 to 1, if inside.
        [[nodiscard]] double start_of_ray(const TimedPoint& w) const {
            const Vec3 q = w.x - a.x;
            const double along = dot(q, e);
            const double squared = squared_norm(q) * length2 - along * along;
            const double height = squared > 0 ? std::sqrt(squared) : 0.0;
            return (along * run - height * rise) / (length2 * run);
        }

        const TimedPoint& a;
        Vec3 e;
        double length2, rise, run;
    };
    static double arrival(const TimedPoint& a, const TimedPoint& w) { return a.time + distance(a.x, w.x); }
    /// Times above this are not worth a new one: 1e-5 of the ball radius. On the axis of a round tube thousands of
    /// polygons lie within a thousandth of the radius; a tenth of the bound doubles the time of the march there, for
    /// distances that change by 2e-5 R in the mean and 6e-4 R at most.
    static double worth_below(double time, double radius) { return time - 1e-5 * radius; }
};

}  // namespace lumenline
