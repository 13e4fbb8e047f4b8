// Endpoints of open tubes (their openings extended by engine/condition) and of closed surfaces with
// given points, and every refusal.
#include "engine/endpoints/endpoints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/condition/condition.h"
#include "engine/endpoints/anchor.h"
#include "engine/geometry/segment_cost.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

struct Model {
    Surface surface;
    VoronoiComplex complex;
    Diagnostics findings;

    Endpoints find(const EndpointOptions& options = {}) {
        StageContext context(Stage::kEndpoints);
        Endpoints endpoints = find_endpoints(surface, complex, options, context);
        findings = context.diagnostics();
        return endpoints;
    }

    /// The code with which the options are refused; none if they are not.
    [[nodiscard]] std::optional<ErrorCode> refusal(const EndpointOptions& options) const {
        StageContext context(Stage::kEndpoints);
        try {
            find_endpoints(surface, complex, options, context);
        } catch (const StageError& error) {
            EXPECT_EQ(error.stage(), Stage::kEndpoints);
            return error.code();
        }
        return std::nullopt;
    }
};

Model model_of(Surface surface) {
    Model model;
    model.complex = test::complex_of(surface);
    model.surface = std::move(surface);
    return model;
}

Surface conditioned(const TriangleSoup& soup, const ConditionOptions& options = {}) {
    StageContext context(Stage::kCondition);
    return condition_surface(soup, options, context);
}

constexpr double kLength = 30, kRadius = 5;

/// A straight tube along z whose radius falls linearly from 5 to (1 - taper) 5.
TriangleSoup open_tube(double taper, Vec3 offset = {}) {
    PhantomOptions options;
    options.length = kLength;
    options.points_around = 20;
    options.jitter = 0.2;
    TriangleSoup soup = to_soup(make_phantom(options));
    for (Vec3& p : soup.points) {
        const double factor = 1 - taper * p.z / kLength;
        p = Vec3{factor * p.x, factor * p.y, p.z} + offset;
    }
    return soup;
}

constexpr double kBend = 5.5;  // of the hairpin's axis: a gap of 1 between the legs' walls

Model closed_hairpin() {
    PhantomOptions options;
    options.kind = PhantomKind::kHairpin;
    options.points_around = 40;
    options.bend_radius = kBend;
    options.jitter = 0.2;
    options.caps = true;
    return model_of(test::closed_surface(make_phantom(options)));
}

PhantomTruth hairpin_truth() {
    PhantomOptions options;
    options.kind = PhantomKind::kHairpin;
    options.bend_radius = kBend;
    return PhantomTruth(options);
}

EndpointOptions points(std::vector<Vec3> inlets, std::vector<Vec3> outlets) {
    return {EndpointMode::kPoints, std::move(inlets), std::move(outlets)};
}

TEST(Endpoints, LargestOpeningIsTheInlet) {
    for (const double taper : {0.3, -0.4}) {
        Model model = model_of(conditioned(open_tube(taper)));
        const Endpoints found = model.find();
        ASSERT_EQ(found.size(), 2U);
        EXPECT_EQ(found[0].role, EndpointRole::kInlet);
        EXPECT_EQ(found[1].role, EndpointRole::kOutlet);
        EXPECT_GT(found[0].radius, found[1].radius);
        const double inlet_z = taper > 0 ? 0 : kLength;
        EXPECT_NEAR(found[0].point.z, inlet_z, 1e-9 * kLength);  // end rings are plane
        EXPECT_NEAR(found[0].normal.z, taper > 0 ? -1 : 1, 1e-9);
        EXPECT_TRUE(model.findings.empty());
        for (const Endpoint& e : found) EXPECT_EQ(e.kind, EndpointKind::kBoundary);
    }
}

TEST(Endpoints, NearlyEqualOpeningsAreWarnedOf) {
    for (const double taper : {0.0, 0.1}) {
        Model model = model_of(conditioned(open_tube(taper)));
        model.find();
        ASSERT_TRUE(test::has_finding(model.findings, "inlet_not_clear")) << "taper " << taper;
        EXPECT_EQ(model.findings[0].severity, Severity::kWarning);
        EXPECT_NEAR(model.findings[0].value, 1 / (1 - taper), 0.02);  // areas of jittered polygons
        EXPECT_EQ(model.findings[0].limit, 1.2);
    }
}

TEST(Endpoints, StatedInletIsTakenWithoutQuestions) {
    Model model = model_of(conditioned(open_tube(0.3)));
    for (const double z : {0.0, kLength})
        for (const EndpointMode mode : {EndpointMode::kAuto, EndpointMode::kBoundaries}) {
            const Endpoints found = model.find({mode, {{0.5, 0.5, z}}, {}});
            ASSERT_EQ(found.size(), 2U);
            EXPECT_NEAR(found[0].point.z, z, 1e-9 * kLength);
            EXPECT_EQ(found[0].role, EndpointRole::kInlet);
            EXPECT_TRUE(model.findings.empty());
        }
}

TEST(Endpoints, AnchorOfAnExtendedOpeningIsOnTheAxisBeyondThePlane) {
    Model model = model_of(conditioned(open_tube(0.3)));
    for (const Endpoint& e : model.find()) {
        const double height = dot(e.anchor - e.point, e.normal);
        EXPECT_GT(height, 0);
        EXPECT_LT(height, model.surface.openings[at(e.opening)].extension_length);
        // A few percent of the radius: the centroid of a jittered ring of 20 and the medial axis differ.
        EXPECT_LT(std::hypot(e.anchor.x, e.anchor.y), 0.03 * e.radius);
        EXPECT_NEAR(e.anchor_radius, e.radius, 0.05 * e.radius);
    }
}

TEST(Endpoints, AnchorUnderAPlainCapIsWhereTheBallReachesTheCap) {
    ConditionOptions plain;
    plain.extension_radii = 0;
    Model model = model_of(conditioned(open_tube(0.3), plain));
    for (const Endpoint& e : model.find()) {
        EXPECT_NEAR(dot(e.anchor - e.point, e.normal), -e.radius, 0.1 * e.radius);
        EXPECT_LT(std::hypot(e.anchor.x, e.anchor.y), 0.05 * e.radius);
    }
}

TEST(Endpoints, SeedsHaveTheExactCostFromTheAnchor) {
    Model model = model_of(conditioned(open_tube(0.3)));
    for (const Endpoint& e : model.find()) {
        ASSERT_FALSE(e.seeds.empty());
        ASSERT_FALSE(e.anchor_polygons.empty());
        double least = std::numeric_limits<double>::infinity();
        VoronoiVertexId nearest;
        for (const Seed& s : e.seeds) {
            const double cost = segment_cost(distance(model.complex.vertices[at(s.vertex)], e.anchor),
                                             model.complex.ball_radius[at(s.vertex)] + e.anchor_radius);
            EXPECT_DOUBLE_EQ(s.time, cost);
            if (s.time < least) nearest = s.vertex;
            least = std::min(least, s.time);
        }
        EXPECT_EQ(e.anchor_vertex, nearest);
        for (const PolygonId p : e.anchor_polygons)
            for (const VoronoiVertexId v : model.complex.polygon(p))
                EXPECT_EQ(std::count_if(e.seeds.begin(), e.seeds.end(), [&](const Seed& s) { return s.vertex == v; }),
                          1);
    }
}

TEST(Endpoints, AnchorRadiusIsThatOfTheEmptyBallThere) {
    // On structured tubes the axis consists of bare edges, on jittered ones of polygons.
    for (const double jitter : {0.0, 0.2})
        for (const double scale : {1e-3, 1.0, 1e3}) {
            PhantomOptions options;
            options.kind = PhantomKind::kTorus;
            options.points_around = 24;
            options.jitter = jitter;
            options.rotate = true;
            options.scale = scale;
            Model model = model_of(conditioned(to_soup(make_phantom(options))));
            for (const Endpoint& e : model.find()) {
                double nearest = std::numeric_limits<double>::infinity();
                for (const Vec3& p : model.surface.points) nearest = std::min(nearest, distance(p, e.anchor));
                // Vertices within 1e-9 of the radius are one.
                EXPECT_NEAR(e.anchor_radius, nearest, 1e-7 * nearest) << "jitter " << jitter << ", scale " << scale;
            }
        }
}

TEST(Endpoints, GivenPointsAreAnchoredAtTheDeepestBall) {
    Model model = model_of(conditioned(open_tube(0)));
    const Endpoints found = model.find(points({{0.3, 0, 4}}, {{-2, 1, 20}, {0, 0, 12}}));
    ASSERT_EQ(found.size(), 3U);
    for (const Endpoint& e : found) {
        EXPECT_EQ(e.kind, EndpointKind::kPoint);
        EXPECT_TRUE(e.opening.is_none());
        double depth = -std::numeric_limits<double>::infinity();
        for (std::size_t v = 0; v < model.complex.vertex_count(); ++v)
            depth = std::max(depth, model.complex.ball_radius[v] - distance(model.complex.vertices[v], e.point));
        EXPECT_DOUBLE_EQ(e.anchor_radius - distance(e.anchor, e.point), depth);
        EXPECT_EQ(e.anchor, model.complex.vertices[at(e.anchor_vertex)]);
        ASSERT_EQ(e.seeds.size(), 1U);
        EXPECT_EQ(e.seeds[0].time, 0);
        EXPECT_EQ(e.radius, e.anchor_radius);
    }
    EXPECT_EQ(found[0].role, EndpointRole::kInlet);
    EXPECT_EQ(found[1].role, EndpointRole::kOutlet);
    EXPECT_EQ(found[2].role, EndpointRole::kOutlet);
}

TEST(Endpoints, PointNearAnOpeningMeansTheOpeningUnlessPointsAreAskedFor) {
    Model model = model_of(conditioned(open_tube(0)));
    const Endpoints automatic = model.find({EndpointMode::kAuto, {{1, 1, 0.5}}, {{0, 0, 15}}});
    EXPECT_EQ(automatic[0].kind, EndpointKind::kBoundary);
    EXPECT_EQ(automatic[1].kind, EndpointKind::kPoint);
    const Endpoints explicit_points = model.find(points({{1, 1, 0.5}}, {{0, 0, 15}}));
    EXPECT_EQ(explicit_points[0].kind, EndpointKind::kPoint);
}

TEST(Endpoints, PointOutsideIsRefusedBeyondAQuarterOfTheRadius) {
    const Model model = model_of(test::closed_surface(make_phantom([] {
        PhantomOptions options;
        options.length = kLength;
        options.points_around = 24;
        options.jitter = 0.2;
        options.caps = true;
        return options;
    }())));
    const Vec3 outlet{0, 0, 25};
    EXPECT_EQ(model.refusal(points({{kRadius * 1.15, 0, 10}}, {outlet})), std::nullopt);
    EXPECT_EQ(model.refusal(points({{kRadius * 1.40, 0, 10}}, {outlet})), ErrorCode::kEndpointOutside);
    EXPECT_EQ(model.refusal(points({{1000, 0, 10}}, {outlet})), ErrorCode::kEndpointOutside);
    EXPECT_EQ(model.refusal(points({outlet}, {{0, 0, -1000}})), ErrorCode::kEndpointOutside);
}

TEST(Endpoints, PointWhoseDistancesOverflowIsRefused) {
    const Model model = closed_hairpin();
    const Vec3 inside{kBend, 0, 3};
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const double far : {1e21, 1e154, -1e300, kInfinity, std::nan("")}) {
        EXPECT_EQ(model.refusal(points({{far, far, far}}, {inside})), ErrorCode::kEndpointOutside) << far;
        EXPECT_EQ(model.refusal(points({inside}, {{0, 0, far}})), ErrorCode::kEndpointOutside) << far;
        for (const InletRule::Kind kind : {InletRule::Kind::kPoint, InletRule::Kind::kNearest}) {
            EndpointOptions options = points({}, {inside});
            options.inlet_rules.emplace_back();
            options.inlet_rules.back().kind = kind;
            options.inlet_rules.back().point = {0, far, 0};
            EXPECT_EQ(model.refusal(options), ErrorCode::kEndpointOutside) << far;
        }
    }
}

TEST(Endpoints, PointBetweenTwoLegsIsRefused) {
    const Model model = closed_hairpin();
    const PhantomTruth truth = hairpin_truth();
    const Vec3 start = truth.position(5), left = truth.position(20), right = truth.position(truth.total_length() - 20);
    ASSERT_NEAR(distance(left, right), 2 * kBend, 1e-9);
    const Vec3 gap = lerp(left, right, 0.5), across = normalized(right - left);
    EXPECT_EQ(model.refusal(points({start}, {gap})), ErrorCode::kEndpointAmbiguous);
    // The legs' depths differ by twice the step, and differences up to a tenth of the radius are no decision.
    for (const double step : {-0.2, -0.1, 0.1, 0.2})
        EXPECT_EQ(model.refusal(points({start}, {gap + step * across})), ErrorCode::kEndpointAmbiguous)
            << step << " from the middle of the gap";
}

TEST(Endpoints, PointWithinOneOfTwoLegsIsAccepted) {
    const Model model = closed_hairpin();
    const PhantomTruth truth = hairpin_truth();
    const Vec3 start = truth.position(5), left = truth.position(20), right = truth.position(truth.total_length() - 20);
    for (const double share : {0.0, 0.1, 0.25, 0.4})  // 0.45 is the wall
        for (const auto& [leg, other] : {std::pair{left, right}, std::pair{right, left}})
            EXPECT_EQ(model.refusal(points({start}, {lerp(leg, other, share)})), std::nullopt);
    // In the bend both sides of the tube belong to one branch.
    EXPECT_EQ(model.refusal(points({start}, {truth.position(0.5 * truth.total_length())})), std::nullopt);
}

TEST(Endpoints, TwoPointsOfOneOpeningAreRefused) {
    const Model model = model_of(conditioned(open_tube(0.3)));
    EXPECT_EQ(model.refusal({EndpointMode::kAuto, {{0, 0, 0}}, {{1, 0, 0}}}), ErrorCode::kEndpointAmbiguous);
    EXPECT_EQ(model.refusal({EndpointMode::kAuto, {{0, 0, 0}, {1, 0, 0}}, {}}), ErrorCode::kEndpointAmbiguous);
}

TEST(Endpoints, TwoPointsAtOnePlaceAreRefused) {
    const Model model = closed_hairpin();
    const PhantomTruth truth = hairpin_truth();
    EXPECT_EQ(model.refusal(points({truth.position(5)}, {truth.position(5)})), ErrorCode::kEndpointAmbiguous);
    EXPECT_EQ(model.refusal(points({truth.position(5)}, {truth.position(20), truth.position(20)})),
              ErrorCode::kEndpointAmbiguous);
}

TEST(Endpoints, ClosedSurfaceWithoutPointsHasItsTipsUnlessOtherEndsAreAskedFor) {
    const Model model = closed_hairpin();
    const Vec3 p = hairpin_truth().position(5);
    EXPECT_EQ(model.refusal({}), std::nullopt);
    EXPECT_EQ(model.refusal({EndpointMode::kAuto, {p}, {}}), std::nullopt);
    EXPECT_EQ(model.refusal({EndpointMode::kAuto, {}, {p}}), std::nullopt);
    EXPECT_EQ(model.refusal({EndpointMode::kBoundaries, {}, {}}), ErrorCode::kEndpointsMissing);
    EXPECT_EQ(model.refusal({EndpointMode::kCaps, {}, {}}), ErrorCode::kEndpointsMissing);
    EXPECT_EQ(model.refusal(points({p}, {})), ErrorCode::kEndpointsMissing);
    EXPECT_EQ(model.refusal(points({}, {p})), ErrorCode::kEndpointsMissing);
    EXPECT_EQ(model.refusal({EndpointMode::kBoundaries, {p}, {hairpin_truth().position(20)}}),
              ErrorCode::kEndpointsMissing);
    EXPECT_EQ(model.refusal(points({}, {})), ErrorCode::kEndpointsMissing);
}

TEST(Endpoints, OpenSurfaceWithoutEnoughEndpointsIsRefused) {
    const Model model = model_of(conditioned(open_tube(0.3)));
    EXPECT_EQ(model.refusal({EndpointMode::kAuto, {{0, 0, 0}, {0, 0, kLength}}, {}}), ErrorCode::kNoOutlet);
    EXPECT_EQ(model.refusal(points({{0, 0, 5}}, {})), ErrorCode::kEndpointsMissing);
    EXPECT_EQ(model.refusal({EndpointMode::kBoundaries, {{0, 0, 15}}, {}}), ErrorCode::kEndpointOutside);
}

TEST(Endpoints, StatedOutletsAreTheOnlyOnes) {
    TriangleSoup soup = open_tube(0.3);
    const TriangleSoup other = open_tube(0.5, {40, 0, 0});
    for (auto t : other.triangles) {
        for (std::uint32_t& v : t) v += static_cast<std::uint32_t>(soup.points.size());
        soup.triangles.push_back(t);
    }
    soup.points.insert(soup.points.end(), other.points.begin(), other.points.end());
    Model model = model_of(conditioned(soup));
    ASSERT_EQ(model.surface.openings.size(), 4U);
    EXPECT_EQ(model.find({EndpointMode::kAuto, {{0, 0, 0}}, {}}).size(), 4U);
    const Endpoints found = model.find({EndpointMode::kAuto, {{0, 0, 0}}, {{40, 0, 0}}});
    ASSERT_EQ(found.size(), 2U);
    EXPECT_NEAR(found[1].point.x, 40, 0.1 * kRadius);
    const Endpoints swapped = model.find({EndpointMode::kAuto, {{40, 0, kLength}, {0, 0, kLength}}, {}});
    ASSERT_EQ(swapped.size(), 4U);
    EXPECT_NEAR(swapped[0].point.x, 40, 0.1 * kRadius) << "inlets in the order given";
    EXPECT_EQ(swapped[1].role, EndpointRole::kInlet);
    EXPECT_GT(swapped[2].radius, swapped[3].radius * 0.99) << "outlets by descending size";
}

TEST(NearestOnComplex, AgreesWithBruteForceOverAllPolygons) {
    const Model model = closed_hairpin();
    const VoronoiComplex& c = model.complex;
    test::Random random(25);
    for (int i = 0; i < 60; ++i) {
        const Vec3 x = c.vertices[random.below(c.vertex_count())] + random.uniform(0, 8) * random.direction();
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t p = 0; p < c.polygon_count(); ++p) {
            const auto loop = c.polygon(PolygonId(p));
            const auto vertex = [&](std::size_t k) { return c.vertices[at(loop[k])]; };
            // A fan of triangles covers a convex polygon; a bare edge is a triangle without area.
            for (std::size_t k = 1; k < std::max<std::size_t>(loop.size() - 1, 2); ++k)
                least = std::min(least, test::distance_to_triangle(x, vertex(0), vertex(k),
                                                                   vertex(std::min(k + 1, loop.size() - 1))));
        }
        const NearestOnComplex found = nearest_on_complex(model.surface, c, x);
        // A polygon of nearly no area has its foot off by the rounding of its plane.
        EXPECT_NEAR(found.distance, least, 1e-7 * model.surface.diagonal);
        EXPECT_NEAR(distance(found.point, x), found.distance, 1e-12 * model.surface.diagonal);
        EXPECT_FALSE(found.polygons.empty());
    }
}

}  // namespace
}  // namespace lumenline
