// Arrival times on phantoms: the known time along a straight round channel, invariants of a first
// arrival, and fields that are not at the fixed point, which the residual must show.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/eikonal/eikonal.h"
#include "engine/geometry/segment_cost.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

PhantomOptions options_of(PhantomKind kind, double jitter, int points_around = 20) {
    return test::capped_options(kind, jitter, points_around, 30);
}

struct Model {
    explicit Model(const PhantomOptions& options)
        : phantom(make_phantom(options)), surface(test::closed_surface(phantom)), complex(test::complex_of(surface)) {}

    [[nodiscard]] VoronoiVertexId vertex_near(Vec3 x) const {
        std::size_t best = 0;
        for (std::size_t v = 1; v < complex.vertex_count(); ++v)
            if (squared_norm(complex.vertices[v] - x) < squared_norm(complex.vertices[best] - x)) best = v;
        return VoronoiVertexId(best);
    }
    [[nodiscard]] VoronoiVertexId vertex_at(double share) const {
        return vertex_near(phantom.truth.position(share * phantom.truth.total_length()));
    }

    Phantom phantom;
    Surface surface;
    VoronoiComplex complex;
};

std::vector<PhantomOptions> all_shapes() {
    std::vector<PhantomOptions> shapes;
    for (const double jitter : {0.0, 0.2})
        for (const PhantomKind kind : {PhantomKind::kCylinder, PhantomKind::kTorus, PhantomKind::kHelix,
                                       PhantomKind::kStenosis, PhantomKind::kHairpin})
            shapes.push_back(options_of(kind, jitter));
    shapes.push_back(options_of(PhantomKind::kCylinder, 0.2));
    shapes.back().b = 2;
    return shapes;
}

ArrivalField solve(const Model& model, std::vector<Seed> seeds) { return test::field_of(model.complex, seeds); }

TEST(Eikonal, FieldsAreAtTheFixedPointOfTheirUpdate) {
    for (const PhantomOptions& options : all_shapes()) {
        const Model model(options);
        const std::vector<Seed> seeds{{model.vertex_at(0.1), 0}};
        const ArrivalField field = solve(model, seeds);
        // Improvements below 1e-7 are not made; several may add up at one vertex.
        EXPECT_LE(field.residual, 1e-6) << phantom_name(options.kind) << " jitter " << options.jitter;
        EXPECT_EQ(field.residual, eikonal_residual(model.complex, field.time, seeds, kResidualStride));
        EXPECT_LE(eikonal_residual(model.complex, field.time, seeds), 1e-6) << phantom_name(options.kind);
        EXPECT_EQ(field.reached, static_cast<std::size_t>(std::count_if(field.time.begin(), field.time.end(),
                                                                        [](double t) { return t < kInfinity; })));
        EXPECT_EQ(field.reached, model.complex.vertex_count());
    }
}

TEST(Eikonal, FieldsOfExactlyRoundTubesAreAtTheFixedPointToo) {
    // Clusters of tiny polygons around the axis: an arrival may rest on times that are improved afterwards, by which
    // the ray's start, sought for a constant cost, moves: up to a ten-thousandth of the time.
    PhantomOptions tube = options_of(PhantomKind::kCylinder, 0, 32), hairpin = options_of(PhantomKind::kHairpin, 0, 20);
    tube.length = 50;
    hairpin.leg_length = 40;
    for (const PhantomOptions& options : {tube, hairpin}) {
        const Model model(options);
        const ArrivalField field = solve(model, {{model.vertex_near(model.phantom.truth.position(5)), 0}});
        EXPECT_LE(eikonal_residual(model.complex, field.time,
                                   std::vector<Seed>{{model.vertex_near(model.phantom.truth.position(5)), 0}}),
                  1e-4)
            << phantom_name(options.kind);
    }
}

TEST(Eikonal, EveryVertexButTheSeedHasACauseAndNoneIsLaterThanAnyWayToIt) {
    for (const PhantomOptions& options : all_shapes()) {
        const Model model(options);
        const VoronoiVertexId seed = model.vertex_at(0.1);
        const ArrivalField field = solve(model, {{seed, 0}});
        const VoronoiComplex& c = model.complex;
        for (std::size_t v = 0; v < c.vertex_count(); ++v) {
            bool has_earlier = false;
            double cheapest = kInfinity;
            for (const PolygonId p : c.polygons_of(VoronoiVertexId(v)))
                for (const VoronoiVertexId w : c.polygon(p)) {
                    if (at(w) == v) continue;
                    has_earlier = has_earlier || field.time[at(w)] < field.time[v];
                    cheapest =
                        std::min(cheapest, field.time[at(w)] + segment_cost(distance(c.vertices[at(w)], c.vertices[v]),
                                                                            c.ball_radius[at(w)] + c.ball_radius[v]));
                }
            EXPECT_TRUE(has_earlier || v == at(seed));
            ASSERT_LE(field.time[v], cheapest * (1 + 1e-6));  // improvements below 1e-7 are not made
        }
        EXPECT_EQ(field.time[at(seed)], 0);
    }
}

TEST(EikonalResidual, RejectsOneTimeRaisedOrLowered) {
    const Model model(options_of(PhantomKind::kTorus, 0.2));
    const std::vector<Seed> seeds{{model.vertex_at(0.1), 0}};
    const ArrivalField field = solve(model, seeds);
    test::Random random(21);
    for (int i = 0; i < 60; ++i) {
        const std::size_t v = random.below(field.time.size());
        if (v == at(seeds[0].vertex)) continue;
        for (const double factor : {0.5, 0.999, 1.001, 2.0}) {
            std::vector<double> wrong = field.time;
            wrong[v] *= factor;
            EXPECT_GT(eikonal_residual(model.complex, wrong, seeds), 4e-4) << "vertex " << v << " times " << factor;
        }
    }
}

TEST(EikonalResidual, RejectsAVertexLeftUnreached) {
    const Model model(options_of(PhantomKind::kTorus, 0.2));
    const std::vector<Seed> seeds{{model.vertex_at(0.1), 0}};
    ArrivalField field = solve(model, seeds);
    // The latest vertex causes no other time: nothing but its own absence can show.
    *std::max_element(field.time.begin(), field.time.end()) = kInfinity;
    EXPECT_GT(eikonal_residual(model.complex, field.time, seeds), 1e-6);
}

TEST(EikonalResidual, RejectsATimeThatIsNoNumber) {
    const Model model(options_of(PhantomKind::kTorus, 0.2));
    const std::vector<Seed> seeds{{model.vertex_at(0.1), 0}};
    ArrivalField field = solve(model, seeds);
    *std::max_element(field.time.begin(), field.time.end()) = std::nan("");
    EXPECT_FALSE(eikonal_residual(model.complex, field.time, seeds) <= 1e-6);
}

TEST(EikonalResidual, RejectsATimeOfZeroThatIsNoSeeds) {
    const Surface part = test::closed_surface(make_phantom(options_of(PhantomKind::kTorus, 0.2)));
    PhantomOptions far = options_of(PhantomKind::kCylinder, 0.2);
    far.offset = {200, 0, 0};
    const Surface both = test::disjoint_union(part, test::closed_surface(make_phantom(far)));
    const VoronoiComplex complex = test::complex_of(both);
    const std::vector<Seed> seeds{{VoronoiVertexId(0), 0}};
    ArrivalField field = test::field_of(complex, seeds);
    for (double& t : field.time)
        if (t == kInfinity) t = 0;  // the classical mistake with unreached parts
    EXPECT_GT(eikonal_residual(complex, field.time, seeds), 1e-6);
}

TEST(EikonalResidual, RejectsAFieldOfOtherSeeds) {
    const Model model(options_of(PhantomKind::kTorus, 0.2));
    const ArrivalField field = solve(model, {{model.vertex_at(0.1), 0.5}});
    EXPECT_GT(eikonal_residual(model.complex, field.time, std::vector<Seed>{{model.vertex_at(0.9), 0.5}}), 1e-2);
}

struct ChannelTime {
    double time = 0, length = 0;  ///< between two vertices on or near the axis
};

ChannelTime channel_time(int points_around, double jitter, std::uint64_t seed) {
    PhantomOptions options = options_of(PhantomKind::kCylinder, jitter, points_around);
    options.length = 40;
    options.seed = seed;
    const Model model(options);
    const VoronoiVertexId a = model.vertex_at(0.25), b = model.vertex_at(0.75);
    const Vec3 apart = model.complex.vertices[at(b)] - model.complex.vertices[at(a)];
    return {solve(model, {{a, 0}}).time[at(b)], std::fabs(dot(apart, model.phantom.truth.tangent(0)))};
}

TEST(Eikonal, StructuredRoundChannelTakesTheTimeBetweenItsRings) {
    // Balls on the axis touch the nearest ring: R^2 = a^2 + x^2 for a distance x from its plane, and the time
    // from ring to ring is 2 asinh(h / 2a).
    PhantomOptions options = options_of(PhantomKind::kCylinder, 0);
    options.rotate = false;
    const Model model(options);
    const VoronoiVertexId a = model.vertex_at(0.25), b = model.vertex_at(0.75);
    const double rows = std::round(30 / (model.phantom.edge_length * std::sqrt(0.75))), spacing = 30 / rows;
    const double length = distance(model.complex.vertices[at(a)], model.complex.vertices[at(b)]);
    const double rings = std::round(length / spacing);
    EXPECT_NEAR(length, rings * spacing, 1e-9);
    EXPECT_NEAR(solve(model, {{a, 0}}).time[at(b)], rings * 2 * std::asinh(0.5 * spacing / 5), 1e-9);
}

TEST(Eikonal, StraightRoundChannelTakesItsLengthOverItsRadius) {
    const auto mean_error = [](int points_around) {
        double sum = 0;
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const auto [time, length] = channel_time(points_around, 0.2, seed);
            sum += std::fabs(time - length / 5) / (length / 5);
        }
        return sum / 4;
    };
    const double coarse = mean_error(12), middle = mean_error(24), fine = mean_error(48);
    EXPECT_LT(middle, 0.01);
    // First order at least, with room for the scatter of four seeds.
    EXPECT_LT(middle, 0.7 * coarse);
    EXPECT_LT(fine, 0.7 * middle);
    RecordProperty("errors", std::to_string(coarse) + " " + std::to_string(middle) + " " + std::to_string(fine));
}

TEST(Eikonal, MarchOutAndBackTakesTheSameTime) {
    const Model model(options_of(PhantomKind::kHelix, 0.2));
    const VoronoiVertexId a = model.vertex_at(0.05), b = model.vertex_at(0.95);
    const double out = solve(model, {{a, 0}}).time[at(b)], back = solve(model, {{b, 0}}).time[at(a)];
    EXPECT_NEAR(out, back, 0.003 * out);  // the discretisations of the two fronts differ
}

TEST(Eikonal, UnreachablePartStaysInfinite) {
    const Surface part = test::closed_surface(make_phantom(options_of(PhantomKind::kTorus, 0.2)));
    PhantomOptions far = options_of(PhantomKind::kCylinder, 0.2);
    far.offset = {200, 0, 0};
    const Surface both = test::disjoint_union(part, test::closed_surface(make_phantom(far)));
    const VoronoiComplex complex = test::complex_of(both);
    std::size_t start = 0;
    while (complex.vertices[start].x > 100) ++start;
    const ArrivalField field = test::field_of(complex, std::vector<Seed>{{VoronoiVertexId(start), 0}});
    std::size_t reached = 0;
    for (std::size_t v = 0; v < complex.vertex_count(); ++v) {
        EXPECT_EQ(field.time[v] < kInfinity, complex.vertices[v].x < 100);
        EXPECT_FALSE(std::isnan(field.time[v]));
        reached += complex.vertices[v].x < 100;
    }
    EXPECT_EQ(field.reached, reached);
    EXPECT_LT(reached, complex.vertex_count());
}

TEST(Eikonal, WithoutSeedsItIsRefused) {
    const Model model(options_of(PhantomKind::kCylinder, 0.2, 12));
    try {
        solve(model, {});
        FAIL() << "a front from nowhere";
    } catch (const StageError& error) {
        EXPECT_EQ(error.code(), ErrorCode::kNoSeed);
        EXPECT_EQ(error.stage(), Stage::kEikonal);
    }
}

TEST(Eikonal, TwoSeedsGiveTheEarlierOfTheirFields) {
    const Model model(options_of(PhantomKind::kHairpin, 0.2));
    const Seed a{model.vertex_at(0.1), 0}, b{model.vertex_at(0.8), 0.7};
    const ArrivalField both = solve(model, {a, b}), first = solve(model, {a}), second = solve(model, {b});
    double latest = 0, excess = 0, deficit = 0;
    for (std::size_t v = 0; v < both.time.size(); ++v) {
        const double least = std::min(first.time[v], second.time[v]);
        latest = std::max(latest, both.time[v]);
        excess = std::max(excess, both.time[v] - least);
        deficit = std::max(deficit, least - both.time[v]);
    }
    // More offers never make an arrival later, but for improvements that are not made.
    EXPECT_LE(excess, 1e-6 * latest);
    // Where the fronts meet, an edge with ends of both interpolates between them: an error of its size.
    EXPECT_LE(deficit, 0.02 * latest);
    EXPECT_EQ(both.time[at(a.vertex)], 0);
    EXPECT_EQ(both.time[at(b.vertex)], 0.7);
}

TEST(Eikonal, LaterSeedOnlyDelaysTheFront) {
    const Model model(options_of(PhantomKind::kTorus, 0.2));
    const ArrivalField prompt = solve(model, {{model.vertex_at(0.1), 0}}),
                       late = solve(model, {{model.vertex_at(0.1), 3}});
    for (std::size_t v = 0; v < prompt.time.size(); ++v)
        ASSERT_NEAR(late.time[v], prompt.time[v] + 3, 2e-6 * late.time[v]);  // the bound on improvements is relative
}

TEST(Eikonal, TimesHaveNoUnit) {
    const Model model(options_of(PhantomKind::kHelix, 0.2));
    const Seed seed{model.vertex_at(0.1), 0};
    const ArrivalField field = solve(model, {seed});
    for (const double scale : {0x1p-20, 1e-3, 1e3}) {
        Model scaled = model;
        for (Vec3& p : scaled.complex.vertices) p = scale * p;
        for (double& r : scaled.complex.ball_radius) r *= scale;
        const ArrivalField other = solve(scaled, {seed});
        for (std::size_t v = 0; v < field.time.size(); ++v) {
            if (scale == 0x1p-20)
                ASSERT_EQ(other.time[v], field.time[v]);  // a power of two rounds nothing
            else
                ASSERT_NEAR(other.time[v], field.time[v], 1e-6 * field.time[v]);  // an improvement more or less
        }
    }
}

TEST(Eikonal, WorkspaceOfAnotherModelLeavesNoTrace) {
    const Model small(options_of(PhantomKind::kCylinder, 0.2, 12)), large(options_of(PhantomKind::kHelix, 0.2));
    StageContext context(Stage::kEikonal);
    EikonalWorkspace shared;
    const std::vector<Seed> seeds{{VoronoiVertexId(5), 0}};
    solve_eikonal(large.complex, seeds, shared, context);
    const ArrivalField reused = solve_eikonal(small.complex, seeds, shared, context);
    EXPECT_EQ(reused.time, solve(small, seeds).time);
}

}  // namespace
}  // namespace lumenline
