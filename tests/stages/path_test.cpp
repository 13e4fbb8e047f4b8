// Paths on the complex: what they cost, and that relaxing them finds a stationary point of exactly
// that cost.
#include "engine/trace/path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry/segment_cost.h"
#include "engine/phantom/accuracy.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

PhantomOptions options_of(PhantomKind kind, double jitter, int points_around = 24) {
    return test::capped_options(kind, jitter, points_around, 40);
}

std::vector<PhantomOptions> jittered_shapes() {
    std::vector<PhantomOptions> shapes;
    for (const PhantomKind kind : {PhantomKind::kCylinder, PhantomKind::kTorus, PhantomKind::kHelix,
                                   PhantomKind::kStenosis, PhantomKind::kHairpin})
        shapes.push_back(options_of(kind, 0.2));
    shapes.push_back(options_of(PhantomKind::kCylinder, 0.2));
    shapes.back().b = 2.5;
    return shapes;
}

/// A phantom with a source near its start and a target near its end, and the march between them.
struct Scene {
    explicit Scene(const PhantomOptions& options)
        : phantom(make_phantom(options)), surface(test::closed_surface(phantom)), complex(test::complex_of(surface)) {
        const double length = phantom.truth.total_length();
        endpoints = test::endpoints_at(surface, complex, {phantom.truth.position(0.15 * length)},
                                       {phantom.truth.position(0.85 * length)});
        field = test::field_of(complex, endpoints[0].seeds);
        arrival = std::numeric_limits<double>::infinity();
        for (const Seed& s : endpoints[1].seeds) arrival = std::min(arrival, field.time[at(s.vertex)] + s.time);
    }
    [[nodiscard]] ComplexPath path() const {
        return trace_back(complex, field.time, endpoints[0], endpoints[1]).value();
    }
    /// As engine/trace relaxes it: without points on top of each other.
    [[nodiscard]] ComplexPath thinned_path() const {
        ComplexPath thinned = path();
        thin_path(complex, thinned, 1e-2);
        return thinned;
    }

    Phantom phantom;
    Surface surface;
    VoronoiComplex complex;
    Endpoints endpoints;
    ArrivalField field;
    double arrival = 0;
};

bool share_a_polygon(const VoronoiComplex& complex, const ComplexPoint& x, const ComplexPoint& y) {
    const auto holds = [&](PolygonId p, VoronoiVertexId v) {
        const auto loop = complex.polygon(p);
        return std::find(loop.begin(), loop.end(), v) != loop.end();
    };
    const auto polygons = complex.polygons_of(x.a);
    return std::any_of(polygons.begin(), polygons.end(),
                       [&](PolygonId p) { return holds(p, x.b) && holds(p, y.a) && holds(p, y.b); });
}

TEST(TraceBack, PathCostsAboutTheArrivalTimeAndNoLessThanTheStraightLineInTheLargestBall) {
    for (const PhantomOptions& options : jittered_shapes()) {
        SCOPED_TRACE(phantom_name(options.kind));
        const Scene scene(options);
        const ComplexPath path = scene.path();
        const double cost = path_cost(scene.complex, path);
        // Times are linear along edges and so not the cost of any one path: seen up to 1e-3, largest where
        // polygons are as wide as the radius.
        EXPECT_LE(cost, scene.arrival * 1.003);
        EXPECT_GE(cost, scene.arrival * 0.97);
        const double largest = *std::max_element(scene.complex.ball_radius.begin(), scene.complex.ball_radius.end());
        EXPECT_GE(cost, distance(path.start, path.end) / largest);
        for (std::size_t i = 0; i + 1 < path.inner.size(); ++i)
            EXPECT_TRUE(share_a_polygon(scene.complex, path.inner[i], path.inner[i + 1])) << "point " << i;
        EXPECT_EQ(path.start, scene.endpoints[0].anchor);
        EXPECT_EQ(path.end, scene.endpoints[1].anchor);
    }
}

TEST(TraceBack, StraightStructuredChannelGivesItsAxis) {
    const Scene scene(options_of(PhantomKind::kCylinder, 0));
    const ComplexPath path = scene.path();
    ASSERT_GT(path.inner.size(), 10U);
    for (const ComplexPoint& p : path.inner)
        EXPECT_LT(scene.phantom.truth.distance_to_axis(position(scene.complex, p)), 1e-9 * 40);  // merged within 1e-9 R
}

TEST(TraceBack, UnreachedTargetHasNoPath) {
    const Scene scene(options_of(PhantomKind::kTorus, 0.2));
    std::vector<double> time = scene.field.time;
    std::fill(time.begin(), time.end(), std::numeric_limits<double>::infinity());
    EXPECT_FALSE(trace_back(scene.complex, time, scene.endpoints[0], scene.endpoints[1]).has_value());
}

TEST(TraceBack, SourceAndTargetInOnePolygonAreJoinedDirectly) {
    const Scene scene(options_of(PhantomKind::kCylinder, 0.2));
    const Endpoint& source = scene.endpoints[0];
    Endpoint target = source;
    const VoronoiVertexId neighbour = scene.complex.polygon(source.anchor_polygons[0])[0] == source.anchor_vertex
                                          ? scene.complex.polygon(source.anchor_polygons[0])[1]
                                          : scene.complex.polygon(source.anchor_polygons[0])[0];
    target.anchor = scene.complex.vertices[at(neighbour)];
    target.anchor_radius = scene.complex.ball_radius[at(neighbour)];
    target.anchor_polygons = {source.anchor_polygons[0]};
    target.seeds = {{neighbour, 0}};
    const auto path = trace_back(scene.complex, scene.field.time, source, target);
    ASSERT_TRUE(path.has_value());
    EXPECT_LE(
        path_cost(scene.complex, *path),
        segment_cost(distance(source.anchor, target.anchor), source.anchor_radius + target.anchor_radius) * (1 + 1e-9));
}

TEST(RelaxPath, NeverRaisesTheCostAndKeepsPointsOnTheirEdges) {
    for (const PhantomOptions& options : jittered_shapes()) {
        SCOPED_TRACE(phantom_name(options.kind));
        const Scene scene(options);
        ComplexPath path = scene.path();
        const double before = path_cost(scene.complex, path);
        const std::vector<ComplexPoint> traced = path.inner;
        const double saved = relax_path(scene.complex, path);
        const double after = path_cost(scene.complex, path);
        EXPECT_GE(saved, 0);
        EXPECT_NEAR(before - after, saved, 1e-12 * before);
        ASSERT_EQ(path.inner.size(), traced.size());
        for (std::size_t i = 0; i < traced.size(); ++i) {
            const ComplexPoint &p = path.inner[i], &q = traced[i];
            EXPECT_GE(p.t, 0);
            EXPECT_LE(p.t, 1);
            const bool same_edge = (p.a == q.a && p.b == q.b);
            const bool went_to_an_end = p.is_vertex() && (p.a == q.a || p.a == q.b);
            EXPECT_TRUE(same_edge || went_to_an_end);
        }
    }
}

TEST(RelaxPath, SecondTimeThereIsNothingToGain) {
    for (const PhantomOptions& options : jittered_shapes()) {
        SCOPED_TRACE(phantom_name(options.kind));
        const Scene scene(options);
        ComplexPath path = scene.thinned_path();
        relax_path(scene.complex, path);
        // The gradient is below 1e-10 when it ends, the gain its square.
        EXPECT_LE(relax_path(scene.complex, path), 1e-12 * path_cost(scene.complex, path));
    }
}

TEST(RelaxPath, ResultIsStationaryByFiniteDifferencesOfItsCost) {
    for (const PhantomOptions& options : jittered_shapes()) {
        SCOPED_TRACE(phantom_name(options.kind));
        const Scene scene(options);
        ComplexPath path = scene.thinned_path();
        relax_path(scene.complex, path);
        const auto place = [&](std::size_t i) { return position(scene.complex, path.inner[i]); };
        double largest = 0;
        std::size_t checked = 0;
        for (std::size_t i = 0; i < path.inner.size(); ++i) {
            ComplexPoint& p = path.inner[i];
            if (p.is_vertex()) continue;
            const double r = ball_radius(scene.complex, p), t = p.t;
            // Where two points have met, the cost has a kink.
            const double before = distance(place(i), i > 0 ? place(i - 1) : path.start),
                         after = distance(place(i), i + 1 < path.inner.size() ? place(i + 1) : path.end);
            if (std::min(before, after) < 1e-3 * r) continue;
            // Over steps of 1e-6 R the truncation is below 1e-12 / (1e-3)^2, the rounding 1e-15 / 1e-6.
            const double h = 1e-6 * r / distance(scene.complex.vertices[at(p.a)], scene.complex.vertices[at(p.b)]);
            if (t < h || t > 1 - h) continue;
            p.t = t + h;
            const double ahead = path_cost(scene.complex, path);
            p.t = t - h;
            const double behind = path_cost(scene.complex, path);
            p.t = t;
            largest = std::max(largest, std::fabs(ahead - behind) / 2e-6);
            ++checked;
        }
        EXPECT_GT(checked, 5U);
        EXPECT_LT(largest, 1e-6);  // cost per radius moved; order one before relaxing
    }
}

/// A strip of quadrangles between rungs, with a path over all inner rungs. Only what paths need.
struct Strip {
    VoronoiComplex complex;
    ComplexPath path;
};

Strip random_strip(test::Random& random, std::size_t rungs) {
    Strip strip;
    VoronoiComplex& c = strip.complex;
    for (std::size_t i = 0; i < rungs; ++i)
        for (const double side : {-1.0, 1.0}) {
            c.vertices.push_back({0.4 * static_cast<double>(i) + random.uniform(-0.15, 0.15),
                                  side * random.uniform(0.2, 0.6), random.uniform(-0.1, 0.1)});
            c.ball_radius.push_back(random.uniform(1, 1.3));
        }
    strip.path.start = {-0.4, random.uniform(-0.5, 0.5), 0};
    strip.path.end = {0.4 * static_cast<double>(rungs), random.uniform(-0.5, 0.5), 0};
    strip.path.start_radius = strip.path.end_radius = 1.1;
    for (std::size_t i = 0; i < rungs; ++i)
        strip.path.inner.push_back({VoronoiVertexId(2 * i), VoronoiVertexId(2 * i + 1), random.uniform(0.01, 0.99)});
    return strip;
}

/// Minimises over one point after the other until nothing moves.
double coordinate_descent(const VoronoiComplex& complex, ComplexPath path) {
    double last = path_cost(complex, path);
    for (int sweep = 0; sweep < 500; ++sweep) {
        for (ComplexPoint& p : path.inner) {
            double lo = 0, hi = 1;
            for (int i = 0; i < 60; ++i) {
                const double x = lo + 0.382 * (hi - lo), y = lo + 0.618 * (hi - lo);
                p.t = x;
                const double at_x = path_cost(complex, path);
                p.t = y;
                (at_x < path_cost(complex, path) ? hi : lo) = at_x < path_cost(complex, path) ? y : x;
            }
            p.t = 0.5 * (lo + hi);
        }
        const double cost = path_cost(complex, path);
        if (last - cost < 1e-14) break;
        last = cost;
    }
    return last;
}

TEST(RelaxPath, FindsTheLeastCostOfRandomStrips) {
    test::Random random(23);
    for (int i = 0; i < 40; ++i) {
        Strip strip = random_strip(random, 6);
        const double least = coordinate_descent(strip.complex, strip.path);
        relax_path(strip.complex, strip.path);
        const double cost = path_cost(strip.complex, strip.path);
        EXPECT_NEAR(cost, least, 1e-9 * least) << "strip " << i;  // golden sections end at 1e-12 of an edge
        for (const ComplexPoint& p : strip.path.inner) {
            EXPECT_GE(p.t, 0);
            EXPECT_LE(p.t, 1);
        }
    }
}

TEST(RelaxPath, PathWithoutInnerPointsHasNothingToSave) {
    test::Random random(24);
    Strip strip = random_strip(random, 3);
    strip.path.inner.clear();
    EXPECT_EQ(relax_path(strip.complex, strip.path), 0);
    EXPECT_DOUBLE_EQ(path_cost(strip.complex, strip.path),
                     segment_cost(distance(strip.path.start, strip.path.end), 2.2));
}

TEST(ThinPath, RemovesOnlyPointsNearerThanTheShareOfTheirRadius) {
    const Scene scene(options_of(PhantomKind::kHelix, 0.2));
    for (const double share : {1e-6, 0.01, 0.2}) {
        ComplexPath path = scene.path();
        const std::vector<ComplexPoint> before = path.inner;
        thin_path(scene.complex, path, share);
        Vec3 last = path.start;
        for (const ComplexPoint& p : path.inner) {
            const Vec3 x = position(scene.complex, p);
            EXPECT_GT(distance(x, last), share * ball_radius(scene.complex, p));
            EXPECT_GT(distance(x, path.end), share * ball_radius(scene.complex, p));
            last = x;
        }
        // Every removed point is that near to the kept one before it, or to the end.
        std::size_t k = 0;
        last = path.start;
        for (const ComplexPoint& p : before) {
            const Vec3 x = position(scene.complex, p);
            if (k < path.inner.size() && x == position(scene.complex, path.inner[k])) {
                last = x;
                ++k;
                continue;
            }
            EXPECT_LE(std::min(distance(x, last), distance(x, path.end)), share * ball_radius(scene.complex, p));
        }
        EXPECT_EQ(k, path.inner.size());
    }
}

}  // namespace
}  // namespace lumenline
