// Refined lines of whole models against the known axis, and against the paths that they were made from.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/phantom/accuracy.h"
#include "engine/trace/ridge.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

struct Processed {
    Phantom phantom;
    ModelRecord record;

    [[nodiscard]] const Centerlines& lines() const { return *record.centerlines; }
    /// Ends included but for a quarter of the radius at the openings.
    [[nodiscard]] LineError error() const {
        const double a = phantom.truth.max_section_radius();
        return line_error(phantom.truth, lines().points, lines().radius, 0.25 * a, a,
                          phantom.truth.min_section_radius());
    }
};

Processed run(PhantomKind kind, int points_around, double noise, std::uint64_t seed,
              Refinement refine = Refinement::kMedial) {
    PhantomOptions options;
    options.kind = kind;
    options.points_around = points_around;
    options.jitter = 0.2;
    options.noise = noise;
    options.seed = seed;
    options.rotate = true;
    Processed result{make_phantom(options), {}};
    PipelineOptions pipeline = test::from_start_to_end(result.phantom.truth);
    pipeline.trace.refine = refine;
    result.record = test::run_pipeline(to_soup(result.phantom), pipeline);
    return result;
}

TEST(MedialLine, BentAndStenosedTubesAreFollowedToTwentiethsOfAPercent) {
    for (const PhantomKind kind : {PhantomKind::kTorus, PhantomKind::kHelix, PhantomKind::kStenosis}) {
        SCOPED_TRACE(phantom_name(kind));
        const Processed medial = run(kind, 40, 0, 21);
        ASSERT_FALSE(medial.record.failure.has_value());
        EXPECT_FALSE(test::has_finding(medial.record.diagnostics, "line_not_refined"));
        EXPECT_LT(medial.error().position_mean, 0.05);
        EXPECT_LT(medial.error().radius_mean, 0.1);
    }
}

TEST(MedialLine, NoiseMakesNoExcursions) {
    for (const double noise : {0.01, 0.05}) {
        const Processed medial = run(PhantomKind::kTorus, 30, noise, 22),
                        path = run(PhantomKind::kTorus, 30, noise, 22, Refinement::kPath);
        ASSERT_FALSE(medial.record.failure.has_value());
        EXPECT_LT(medial.lines().abscissa.back(), 1.01 * medial.phantom.truth.total_length());
        EXPECT_LT(medial.error().position_mean, 1.2 * path.error().position_mean);
        EXPECT_LT(test::distance_between_lines(medial.lines().points, path.lines().points),
                  0.15 * medial.phantom.truth.max_section_radius());
    }
}

TEST(MedialLine, ValuesOfALineBelongTogether) {
    const Processed medial = run(PhantomKind::kHelix, 20, 0.02, 23);
    const Centerlines& lines = medial.lines();
    ASSERT_EQ(lines.radius_error.size(), lines.points.size());
    ASSERT_EQ(lines.position_error.size(), lines.points.size());
    for (std::size_t i = 0; i < lines.points.size(); ++i) {
        EXPECT_GT(lines.radius_error[i], 0);
        EXPECT_GT(lines.position_error[i], 0);
        EXPECT_LE(lines.clearance[i], lines.ball_radius[i]);
        EXPECT_TRUE(medial.phantom.truth.inside(lines.points[i]) || i == 0 || i + 1 == lines.points.size());
    }
    EXPECT_TRUE(std::is_sorted(lines.path.line_abscissa.begin(), lines.path.line_abscissa.end()));
    EXPECT_EQ(lines.path.line_abscissa.front(), 0);
    EXPECT_NEAR(lines.path.line_abscissa.back(), lines.abscissa.back(), 1e-12 * lines.abscissa.back());
    const Processed path = run(PhantomKind::kHelix, 20, 0.02, 23, Refinement::kPath);
    EXPECT_TRUE(std::isnan(path.lines().position_error.front()));
    EXPECT_EQ(path.lines().path.points, lines.path.points);
}

TEST(MedialLine, EstimatesCoverTheErrorsOfRoundTubes) {
    double radius_error = 0, position_error = 0, radius_estimate = 0, position_estimate = 0, covered = 0, count = 0;
    for (std::uint64_t seed = 31; seed < 34; ++seed) {
        const Processed medial = run(PhantomKind::kTorus, 40, 0.05, seed);
        const PhantomTruth& truth = medial.phantom.truth;
        const Centerlines& lines = medial.lines();
        for (std::size_t i = 1; i + 1 < lines.points.size(); ++i, ++count) {
            const double off = truth.distance_to_axis(lines.points[i]);
            radius_error += std::fabs(lines.radius[i] - truth.inscribed_radius(truth.abscissa_of(lines.points[i])));
            radius_estimate += lines.radius_error[i];
            position_error += off;
            position_estimate += lines.position_error[i];
            covered += off <= lines.position_error[i] ? 1 : 0;
        }
    }
    EXPECT_GT(covered, 0.9 * count);
    // Measured: 4 for the position, whose estimate knows nothing of neighbours' help; 1.2 for the radius.
    EXPECT_LT(position_estimate, 6 * position_error);
    EXPECT_GT(radius_estimate, 0.8 * radius_error);
    EXPECT_LT(radius_estimate, 3 * radius_error);
}

TEST(MedialLine, EstimatesAreNumbersInStrongNoise) {
    for (const std::uint64_t seed : {41U, 42U}) {
        const Processed medial = run(PhantomKind::kCylinder, 20, 0.1, seed);
        for (const double e : medial.lines().radius_error) EXPECT_TRUE(std::isfinite(e));
        for (const double e : medial.lines().position_error) EXPECT_TRUE(std::isfinite(e));
    }
}

TEST(MedialLine, LinesOfOneRootCoincideWhereTheirPathsDo) {
    PhantomOptions options;
    options.kind = PhantomKind::kTorus;
    options.points_around = 24;
    options.jitter = 0.2;
    options.caps = true;
    const Phantom phantom = make_phantom(options);
    const PhantomTruth& truth = phantom.truth;
    const double length = truth.total_length();
    const test::Traced traced = test::trace_closed(test::closed_surface(phantom), {truth.position(0.1 * length)},
                                                   {truth.position(0.9 * length), truth.position(0.6 * length)});
    ASSERT_EQ(traced.lines.line_count(), 2U);
    const auto one = test::part(traced.lines.points, traced.lines.offsets, 0);
    const auto other = test::part(traced.lines.points, traced.lines.offsets, 1);
    std::size_t same = 0;
    while (same < std::min(one.size(), other.size()) && one[same] == other[same]) ++same;
    EXPECT_GT(same, other.size() / 2);
}

TEST(Ridge, NodeBetweenFourWallsComesToTheirMiddle) {
    RidgeProblem problem;
    for (int i = 0; i < 5; ++i) {
        RidgeNode node;
        node.position = {0.1, -0.05, 0.5 * i};
        node.axes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}};
        node.radius = 1;
        node.reach = 0.3;
        node.first = static_cast<std::uint32_t>(problem.bounds.size());
        for (const Vec3 n : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}}) {
            WallBound bound;
            bound.value = 1 - dot(n, node.position);
            bound.gradient = {-n.x, -n.y};
            problem.bounds.push_back(bound);
        }
        node.last = static_cast<std::uint32_t>(problem.bounds.size());
        problem.nodes.push_back(node);
    }
    ASSERT_TRUE(solve_ridge(problem, 1e-10));
    for (const RidgeNode& node : problem.nodes) {
        EXPECT_NEAR(node.position.x + node.move[0], 0, 1e-6);
        EXPECT_NEAR(node.position.y + node.move[1], 0, 1e-6);
        EXPECT_NEAR(node.radius, 1, 1e-6);
    }
}

TEST(Ridge, LineOnASheetIsDrawnStraight) {
    // Two parallel walls: nothing but tension acts along the sheet.
    RidgeProblem problem;
    for (int i = 0; i < 7; ++i) {
        RidgeNode node;
        node.position = {i % 2 == 0 ? 0.0 : 0.1, 0, 0.5 * i};
        node.axes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}};
        node.radius = 1;
        node.reach = i == 0 || i == 6 ? 0 : 0.5;
        node.first = static_cast<std::uint32_t>(problem.bounds.size());
        for (const double side : {1.0, -1.0}) {
            WallBound bound;
            bound.value = 1;
            bound.gradient = {0, -side};
            problem.bounds.push_back(bound);
        }
        node.last = static_cast<std::uint32_t>(problem.bounds.size());
        problem.nodes.push_back(node);
    }
    ASSERT_TRUE(solve_ridge(problem, 1e-10));
    for (const RidgeNode& node : problem.nodes) {
        EXPECT_NEAR(node.position.x + node.move[0], 0, 1e-5);
        EXPECT_NEAR(node.move[1], 0, 1e-6);
    }
}

}  // namespace
}  // namespace lumenline
