// Analytic fronts: the plane wave where the cost is constant, the point source where it is radial;
// and the minimizer against a search.
#include "engine/geometry/edge_update.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/stages/support.h"

namespace lumenline {
namespace {

/// Value at t of the time at w through the point t of the edge, for a constant cost.
double time_through(Vec3 a, Vec3 b, Vec3 w, double time_a, double time_b, double f, double t) {
    return (1 - t) * time_a + t * time_b + f * distance(w, lerp(a, b, t));
}

/// Least of a convex function on [0, 1], by golden sections.
template <class G>
double least_value(const G& g) {
    constexpr double kGolden = 0.61803398874989485;
    double lo = 0, hi = 1;
    for (int i = 0; i < 80; ++i) {
        const double x = hi - kGolden * (hi - lo), y = lo + kGolden * (hi - lo);
        (g(x) < g(y) ? hi : lo) = g(x) < g(y) ? y : x;
    }
    return std::min({g(0.5 * (lo + hi)), g(0.0), g(1.0)});
}

TEST(EdgeUpdate, PlaneWaveOverATriangleIsReproducedToRounding) {
    test::Random random(3);
    constexpr double kFar = 1e9;  // sites so far away that 1/R is constant to rounding
    int crossed = 0;
    for (int i = 0; i < 2000; ++i) {
        const auto in_plane = [&] { return Vec3{random.uniform(0, 1), random.uniform(0, 1), 0}; };
        const Vec3 a = in_plane(), b = in_plane(), w = in_plane();
        const double angle = random.uniform(0, 6.3);
        const Vec3 wave{std::cos(angle), std::sin(angle), 0};
        // The ray to w along the wave must cross the edge from the side of the edge.
        const double det = cross(b - a, wave).z;
        const double t = cross(w - a, wave).z / det, back = cross(b - a, w - a).z / -det;
        if (!(t > 0.05 && t < 0.95 && back < -0.05) || std::fabs(det) < 0.1) continue;
        ++crossed;
        const auto time = [&](Vec3 x) { return (2 + dot(x, wave)) / kFar; };
        const Arrival arrival = edge_arrival({a, kFar, time(a)}, {b, kFar, time(b)}, w, kFar);
        // A handful of roundings of numbers up to 4 / kFar.
        EXPECT_NEAR(arrival.time * kFar, time(w) * kFar, 4e-15);
        // The start of the ray is a root: it carries half the digits of an angle that grazes the edge.
        EXPECT_NEAR(arrival.t, t, 1e-12);
    }
    EXPECT_GT(crossed, 200);
}

TEST(EdgeUpdate, ArrivalFromThePointNearestToTheSitesHasTheClosedForm) {
    // R = sqrt(h^2 + rho^2) in the plane of equidistance; radial rays are straight: T = asinh(rho / h).
    test::Random random(4);
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
        const double h = std::pow(10, random.uniform(-1, 1)), r1 = random.uniform(0, 3), r2 = random.uniform(0, 3);
        const double angle = random.uniform(0, 6.3);
        const Vec3 u{std::cos(angle), std::sin(angle), 0};
        const double exact = std::asinh(r1 / h) + std::fabs(std::asinh(r2 / h) - std::asinh(r1 / h));
        const TimedPoint from{r1 * u, std::hypot(r1, h), std::asinh(r1 / h)};
        worst = std::max(worst, std::fabs(vertex_arrival(from, r2 * u, std::hypot(r2, h)) - exact));
    }
    EXPECT_LT(worst, 1e-12);  // roundings of 1 - L/(R1+R2), which is above 1e-3 here
}

TEST(EdgeUpdate, RadialFrontAcrossAnEdgeConvergesToSecondOrderAtLeast) {
    constexpr double kHeight = 0.4;
    const auto node = [&](Vec3 x) {
        return TimedPoint{x, std::hypot(norm(x), kHeight), std::asinh(norm(x) / kHeight)};
    };
    const Vec3 middle{1.1, 0.3, 0};
    const auto error = [&](double size) {
        double worst = 0;
        for (int i = 0; i < 12; ++i) {
            const double angle = 0.5 * i;
            const Vec3 u{std::cos(angle), std::sin(angle), 0}, v{-u.y, u.x, 0};
            const TimedPoint a = node(middle - 0.5 * size * u), b = node(middle + 0.6 * size * u);
            const Vec3 w = middle + (dot(v, middle) > 0 ? size : -size) * v;
            if (std::fabs(dot(u, middle)) > 0.5 * norm(middle)) continue;  // the ray would pass beside the edge
            const Arrival arrival = edge_arrival(a, b, w, std::hypot(norm(w), kHeight));
            worst = std::max(worst, std::fabs(arrival.time - node(w).time));
        }
        return worst;
    };
    for (const double size : {0.2, 0.1, 0.05, 0.025}) {
        EXPECT_LT(error(0.5 * size), error(size) / 3.5) << "size " << size;  // 4 but for terms of third order
        EXPECT_LT(error(size), 0.5 * size * size / (kHeight * kHeight));
    }
}

TEST(EdgeUpdate, ArrivalIsAnUpperBoundThatIsNearlyTheLeastTimeOverTheEdge) {
    test::Random random(5);
    double worst = 0;
    for (int i = 0; i < 3000; ++i) {
        const double h = random.uniform(0.3, 2), size = 0.3 * h;
        const auto in_plane = [&] { return Vec3{random.uniform(0, size), random.uniform(0, size), 0}; };
        const Vec3 shift{random.uniform(-2, 2), random.uniform(-2, 2), 0}, site{0, 0, h};
        const Vec3 a = in_plane() + shift, b = in_plane() + shift, w = in_plane() + shift;
        const double ra = distance(a, site), rb = distance(b, site), rw = distance(w, site);
        const double ta = random.uniform(0, 1), tb = ta + random.uniform(-1, 1) * segment_cost(distance(a, b), ra + rb);
        const auto exact = [&](double t) {
            const Vec3 x = lerp(a, b, t);
            return (1 - t) * ta + t * tb + segment_cost(distance(x, w), distance(x, site) + rw);
        };
        const double least = least_value(exact);
        const Arrival arrival = edge_arrival({a, ra, ta}, {b, rb, tb}, w, rw);
        EXPECT_GE(arrival.time, least - 1e-14);
        EXPECT_NEAR(arrival.time, exact(arrival.t), 1e-13);  // its time belongs to its start
        worst = std::max(worst, arrival.time - least);
    }
    // The start is off by the cost's relative variation over the triangle, at most 0.3 sqrt(2) here; the
    // time by its square times the cost of the triangle's size, below 0.4.
    EXPECT_LT(worst, 0.3 * 0.3 * 2 * 0.4);
    RecordProperty("largest_excess", std::to_string(worst));
}

TEST(PlanarMinimizer, AgreesWithASearchWhateverTheSlope) {
    test::Random random(6);
    for (int i = 0; i < 5000; ++i) {
        const Vec3 a = random.in_box({-1, -1, -1}, {1, 1, 1}), b = random.in_box({-1, -1, -1}, {1, 1, 1}),
                   w = random.in_box({-1, -1, -1}, {1, 1, 1});
        const double f = std::pow(10, random.uniform(-2, 2));
        const double slope = random.uniform(-1.5, 1.5);  // beyond 1 no ray leaves the edge's inside
        const double ta = random.uniform(0, 1), tb = ta + slope * f * distance(a, b);
        const double t = planar_minimizer(a, b, w, ta, tb, f);
        ASSERT_GE(t, 0);
        ASSERT_LE(t, 1);
        const auto value = [&](double x) { return time_through(a, b, w, ta, tb, f, x); };
        EXPECT_NEAR(value(t), least_value(value), 1e-13 * (1 + f)) << "slope " << slope;
        if (slope >= 1) {
            EXPECT_EQ(t, 0);
        }
        if (slope <= -1) {
            EXPECT_EQ(t, 1);
        }
    }
}

TEST(PlanarMinimizer, EdgeWithoutLengthGivesItsEarlierEnd) {
    const Vec3 a{1, 2, 3}, w{0, 0, 1};
    EXPECT_EQ(planar_minimizer(a, a, w, 1, 2, 1), 0);
    EXPECT_EQ(planar_minimizer(a, a, w, 2, 1, 1), 1);
    EXPECT_EQ(planar_minimizer(a, a, w, 1, 1, 1), 0);
    const Arrival arrival = edge_arrival({a, 2, 1.5}, {a, 2, 1.0}, w, 1);
    EXPECT_DOUBLE_EQ(arrival.time, 1.0 + segment_cost(distance(a, w), 3));
}

TEST(PlanarMinimizer, TargetOnTheLineOfTheEdgeIsReachedFromAnEnd) {
    const Vec3 a{0, 0, 0}, b{1, 0, 0};
    EXPECT_EQ(planar_minimizer(a, b, {3, 0, 0}, 0, 0.2, 1), 1);   // through b
    EXPECT_EQ(planar_minimizer(a, b, {-2, 0, 0}, 0, 0.2, 1), 0);  // through a
    // On the edge itself every point before it gives a slower way than the point itself when times are equal.
    EXPECT_DOUBLE_EQ(planar_minimizer(a, b, {0.25, 0, 0}, 1, 1, 1), 0.25);
}

}  // namespace
}  // namespace lumenline
