// Ends of surfaces that state none: blind tips of closed tubes, loops, mixtures, rules for inlets, and an
// order that survives another numbering, rotation and scale.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>

#include "engine/condition/condition.h"
#include "engine/endpoints/endpoints.h"
#include "engine/endpoints/tips.h"
#include "io/mesh/mesh_io.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

struct Found {
    Endpoints ends;
    Diagnostics findings;
    std::optional<ErrorCode> refusal;
};

Found find_on(const Surface& surface, const EndpointOptions& options) {
    const VoronoiComplex complex = test::complex_of(surface);
    StageContext context(Stage::kEndpoints);
    Found found;
    try {
        found.ends = find_endpoints(surface, complex, options, context);
    } catch (const StageError& error) {
        found.refusal = error.code();
    }
    found.findings = context.diagnostics();
    return found;
}

Surface conditioned(const TriangleSoup& soup, FlatCaps caps = FlatCaps::kKeep) {
    ConditionOptions options;
    options.check_self_intersections = false;
    options.flat_caps = caps;
    StageContext context(Stage::kCondition);
    return condition_surface(soup, options, context);
}

PhantomOptions capped(PhantomKind kind) {
    PhantomOptions options;
    options.kind = kind;
    options.points_around = 24;
    options.bend_radius = kind == PhantomKind::kHairpin ? 6 : 20;
    options.jitter = 0.2;
    options.caps = true;
    options.rotate = true;
    return options;
}

EndpointOptions asked(EndpointModes modes) {
    EndpointOptions options;
    options.mode = modes;
    return options;
}

EndpointOptions by_rule(const InletRule& rule, EndpointModes modes = EndpointMode::kAuto) {
    EndpointOptions options = asked(modes);
    options.inlet_rules = {rule};
    return options;
}

/// Tube along z of radius 5 to 4 with an open end at z = 0 and a blind one at z = 40.
TriangleSoup half_open_tube() {
    PhantomOptions options;
    options.length = 40;
    options.points_around = 24;
    options.jitter = 0.2;
    options.caps = true;
    TriangleSoup soup = to_soup(make_phantom(options));
    std::erase_if(soup.triangles, [&](const auto& t) {
        return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return std::fabs(soup.points[v].z) < 1e-9; });
    });
    for (Vec3& p : soup.points) p = {(1 - p.z / 200) * p.x, (1 - p.z / 200) * p.y, p.z};
    return soup;
}

TriangleSoup gastric_vein() { return read_surface(LUMENLINE_SOURCE_DIR "/examples/liver/gastric_vein.vtk"); }

TriangleSoup renumbered(const TriangleSoup& soup, std::uint64_t seed) {
    test::Random random(seed);
    std::vector<std::uint32_t> to(soup.points.size());
    std::iota(to.begin(), to.end(), 0U);
    for (std::size_t i = to.size(); i > 1; --i) std::swap(to[i - 1], to[random.below(i)]);
    TriangleSoup result = soup;
    for (std::size_t i = 0; i < to.size(); ++i) result.points[to[i]] = soup.points[i];
    for (auto& t : result.triangles)
        for (std::uint32_t& v : t) v = to[v];
    for (std::size_t i = result.triangles.size(); i > 1; --i)
        std::swap(result.triangles[i - 1], result.triangles[random.below(i)]);
    return result;
}

TEST(Tips, ClosedTubesHaveTwoNearTheirEnds) {
    for (const PhantomKind kind :
         {PhantomKind::kCylinder, PhantomKind::kTorus, PhantomKind::kHelix, PhantomKind::kHairpin}) {
        const Phantom phantom = make_phantom(capped(kind));
        const Found found = find_on(test::closed_surface(phantom), asked(EndpointMode::kTips));
        ASSERT_EQ(found.ends.size(), 2U) << phantom_name(kind);
        const double length = phantom.truth.total_length();
        for (const Endpoint& e : found.ends) {
            EXPECT_EQ(e.kind, EndpointKind::kTip);
            EXPECT_TRUE(e.opening.is_none());
            const double s = phantom.truth.abscissa_of(e.point), from_end = std::min(s, length - s);
            // The ball that touches a flat end is one radius inside of it, and rings are half a radius apart.
            EXPECT_GT(from_end, 0.7 * 5);
            EXPECT_LT(from_end, 2 * 5) << phantom_name(kind);  // the least growth is looked for within two radii
            EXPECT_LT(phantom.truth.distance_to_axis(e.point), 0.15 * 5) << phantom_name(kind);
            const Vec3 out = s < length / 2 ? -phantom.truth.tangent(s) : phantom.truth.tangent(s);
            EXPECT_GT(dot(e.normal, out), 0.8) << phantom_name(kind);
        }
        EXPECT_TRUE(test::has_finding(found.findings, "inlet_not_clear"));
    }
}

TEST(Tips, EdgesOfAFlatLumenAreNone) {
    PhantomOptions options = capped(PhantomKind::kCylinder);
    options.a = 6;
    options.b = 2;
    options.points_around = 40;
    EXPECT_EQ(find_on(test::closed_surface(make_phantom(options)), asked(EndpointMode::kTips)).ends.size(), 2U);
}

TEST(Tips, NoiseOfTheWallIsNone) {
    PhantomOptions options = capped(PhantomKind::kTorus);
    options.noise = 0.1;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        options.seed = seed;
        EXPECT_EQ(find_on(test::closed_surface(make_phantom(options)), asked(EndpointMode::kTips)).ends.size(), 2U);
    }
}

TEST(Tips, LengthAskedForIsHeld) {
    // A lumen hardly longer than wide.
    PhantomOptions options = capped(PhantomKind::kCylinder);
    options.length = 12;
    const Surface stub = test::closed_surface(make_phantom(options));
    EXPECT_EQ(find_on(stub, asked(EndpointMode::kTips)).refusal, ErrorCode::kEndpointsMissing);
    options.length = 50;
    EndpointOptions long_ones = asked(EndpointMode::kTips);
    long_ones.tip_length = 1000;
    const Surface tube = test::closed_surface(make_phantom(options));
    EXPECT_EQ(find_on(tube, long_ones).refusal, ErrorCode::kEndpointsMissing);
    EXPECT_EQ(find_on(tube, asked(EndpointMode::kTips)).ends.size(), 2U);
}

TEST(Tips, RingHasNone) {
    TriangleSoup ring;
    constexpr std::size_t kAround = 60, kSection = 16;
    for (std::size_t i = 0; i < kAround; ++i)
        for (std::size_t k = 0; k < kSection; ++k) {
            const double u =
                2 * std::numbers::pi * (static_cast<double>(i) + 0.5 * static_cast<double>(k % 2)) / kAround;
            const double v = 2 * std::numbers::pi * static_cast<double>(k) / kSection;
            const double r = 20 + (3 + 0.3 * std::sin(3 * u)) * std::cos(v);
            ring.points.push_back({r * std::cos(u), r * std::sin(u), 3 * std::sin(v)});
            const auto at = [&](std::size_t a, std::size_t b) {
                return static_cast<std::uint32_t>((a % kAround) * kSection + b % kSection);
            };
            ring.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            ring.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
    const Surface surface = conditioned(ring);
    ASSERT_EQ(surface.genus, 1);
    StageContext context(Stage::kEndpoints);
    EXPECT_TRUE(find_tips(surface, test::complex_of(surface), 3, context).empty());
}

TEST(Ends, MixtureHasItsTipOnlyWhenAsked) {
    const Surface surface = conditioned(half_open_tube());
    ASSERT_EQ(surface.openings.size(), 1U);
    EXPECT_EQ(find_on(surface, asked(EndpointMode::kAuto)).refusal, ErrorCode::kNoOutlet);
    for (const EndpointMode openings : {EndpointMode::kAuto, EndpointMode::kBoundaries}) {
        const Found found = find_on(surface, asked(openings | EndpointModes(EndpointMode::kTips)));
        ASSERT_EQ(found.ends.size(), 2U);
        EXPECT_EQ(found.ends[0].kind, EndpointKind::kBoundary);
        EXPECT_EQ(found.ends[1].kind, EndpointKind::kTip);
        EXPECT_NEAR(found.ends[1].point.z, 36, 2.5);  // a radius of four inside, give or take half of it
    }
    // The open end is no tip of its own.
    EXPECT_EQ(find_on(surface, asked(EndpointMode::kTips)).refusal, ErrorCode::kNoOutlet);
    const Surface all = conditioned(half_open_tube(), FlatCaps::kOpen);
    const Found with_cap = find_on(all, asked(EndpointMode::kBoundaries | EndpointModes(EndpointMode::kCaps)));
    ASSERT_EQ(with_cap.ends.size(), 2U);
    EXPECT_EQ(with_cap.ends[1].kind, EndpointKind::kCap);
    EXPECT_NEAR(with_cap.ends[1].point.z, 40, 1e-9 * 40);  // caps are plane
    EXPECT_EQ(find_on(all, asked(EndpointMode::kBoundaries)).refusal, ErrorCode::kNoOutlet)
        << "a cap was not asked for";
}

TEST(Ends, AutoTakesTipsWhereThereIsNothingElseAndGivenPointsMeanThem) {
    const Surface surface = conditioned(gastric_vein());
    const Vec3 one{27.54, -177.74, -276.02}, other{-27.10, -187.21, -275.55};  // as examples/participants.tsv has them
    const Found found = find_on(surface, {});
    ASSERT_EQ(found.ends.size(), 2U);
    for (const Vec3 p : {one, other})
        EXPECT_TRUE(std::any_of(found.ends.begin(), found.ends.end(),
                                [&](const Endpoint& e) { return distance(e.point, p) < 3 * e.radius; }));
    EndpointOptions options;
    options.inlets = {one};
    const Found stated = find_on(surface, options);
    ASSERT_EQ(stated.ends.size(), 2U);
    EXPECT_EQ(stated.ends[0].kind, EndpointKind::kTip);
    EXPECT_LT(distance(stated.ends[0].point, one), 3 * stated.ends[0].radius);
    options.outlets = {other};
    for (const Endpoint& e : find_on(surface, options).ends) EXPECT_EQ(e.kind, EndpointKind::kPoint);
}

TEST(Ends, OrderAndPlacesSurviveRenumberingRotationAndScale) {
    const TriangleSoup soup = read_surface(LUMENLINE_SOURCE_DIR "/examples/liver/arteries.vtk");
    const Found plain = find_on(conditioned(soup), {});
    ASSERT_GE(plain.ends.size(), 8U);
    const std::vector<std::function<Vec3(Vec3)>> moves{[](Vec3 p) { return p; }, [](Vec3 p) { return 1e-3 * p; },
                                                       [](Vec3 p) {
                                                           return Vec3{p.y, p.z, p.x};
                                                       }};
    for (const auto& move : moves) {
        TriangleSoup moved = renumbered(soup, 7);
        for (Vec3& p : moved.points) p = move(p);
        moved.coordinate_rounding = norm(move({soup.coordinate_rounding, 0, 0}));
        const Found found = find_on(conditioned(moved), {});
        ASSERT_EQ(found.ends.size(), plain.ends.size());
        for (std::size_t i = 0; i < found.ends.size(); ++i) {
            EXPECT_EQ(found.ends[i].role, plain.ends[i].role);
            // The same Voronoi vertices up to rounding.
            EXPECT_LT(distance(found.ends[i].point, move(plain.ends[i].point)), 0.1 * found.ends[i].radius) << i;
        }
    }
}

TEST(Inlets, RulesPickAmongTheEnds) {
    TriangleSoup soup = half_open_tube();
    const Surface surface = conditioned(soup, FlatCaps::kOpen);
    ASSERT_EQ(surface.openings.size(), 2U);
    using Kind = InletRule::Kind;
    const auto inlet_z = [&](const InletRule& rule) {
        const Found found = find_on(surface, by_rule(rule));
        return found.ends.size() == 2 ? found.ends[0].point.z : std::nan("");
    };
    EXPECT_NEAR(inlet_z({Kind::kLargest, 2, 1, {}}), 0, 1e-6);
    EXPECT_NEAR(inlet_z({Kind::kSmallest, 2, 1, {}}), 40, 1e-6);
    EXPECT_NEAR(inlet_z({Kind::kHighest, 2, 1, {}}), 40, 1e-6);
    EXPECT_NEAR(inlet_z({Kind::kLowest, 2, 1, {}}), 0, 1e-6);
    EXPECT_NEAR(inlet_z({Kind::kNearest, 2, 1, {500, 0, 30}}), 40, 1e-6);
    EXPECT_NEAR(inlet_z({Kind::kBoundary, 2, 1, {}}), 0, 1e-6);
    EXPECT_NEAR(inlet_z({Kind::kBoundary, 2, 2, {}}), 40, 1e-6);
    EXPECT_EQ(find_on(surface, by_rule({Kind::kBoundary, 2, 3, {}})).refusal, ErrorCode::kNoInlet);
    const Found point = find_on(surface, by_rule({Kind::kPoint, 2, 1, {0.2, 0, 20}}));
    ASSERT_EQ(point.ends.size(), 3U);
    EXPECT_EQ(point.ends[0].kind, EndpointKind::kPoint);
    EndpointOptions both = by_rule({Kind::kHighest, 2, 1, {}});
    both.inlet_rules.push_back({Kind::kLowest, 2, 1, {}});
    EXPECT_EQ(find_on(surface, both).refusal, ErrorCode::kNoOutlet);
}

TEST(Inlets, EachPartOfTheLumenHasOne) {
    const auto tube = [](double x) {
        PhantomOptions options = capped(PhantomKind::kCylinder);
        options.rotate = false;
        options.offset = {x, 0, 0};
        return test::closed_surface(make_phantom(options));
    };
    const Surface two = test::disjoint_union(tube(0), tube(40));
    const Found found = find_on(two, asked(EndpointMode::kTips));
    ASSERT_EQ(found.ends.size(), 4U);
    EXPECT_EQ(found.ends[1].role, EndpointRole::kInlet);
    EXPECT_EQ(found.ends[2].role, EndpointRole::kOutlet);
    EXPECT_GT(std::fabs(found.ends[0].point.x - found.ends[1].point.x), 30);
}

TEST(Ends, PointFarFromTheAxisIsWarnedOf) {
    const Surface surface = test::closed_surface(make_phantom([] {
        PhantomOptions options = capped(PhantomKind::kCylinder);
        options.rotate = false;
        return options;
    }()));
    EndpointOptions options = asked(EndpointMode::kPoints);
    options.inlets = {{0, 0, 10}};
    options.outlets = {{0, 0, 40}};
    EXPECT_FALSE(test::has_finding(find_on(surface, options).findings, "endpoint_off_axis"));
    options.outlets = {{5.8, 0, 40}};
    EXPECT_TRUE(test::has_finding(find_on(surface, options).findings, "endpoint_off_axis"));
}

}  // namespace
}  // namespace lumenline
