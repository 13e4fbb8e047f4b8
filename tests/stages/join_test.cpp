// Lines bent onto the centres of their openings.
#include "engine/trace/join.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/stages/support.h"

namespace lumenline {
namespace {

constexpr double kRadius = 5;

/// A line on the axis of a capped cylinder, between 10 and 40 of its 50 long axis.
struct AxisLine {
    Phantom phantom = make_phantom(test::capped_options(PhantomKind::kCylinder, 0.2, 24, 50));
    Surface surface = test::closed_surface(phantom);
    LineVerifier verifier{surface};
    MedialRefiner refiner{surface, verifier.surface_distance()};
    Endpoint from, to;
    FinalLine line;

    AxisLine() {
        for (double s = 10; s <= 40; s += 1) line.line.append(phantom.truth.position(s), kRadius);
        const std::size_t n = line.line.size();
        line.ball_radius.assign(n, kRadius);
        line.clearance.assign(n, 0.99 * kRadius);
        line.radius_error.assign(n, 0.01);
        line.position_error.assign(n, 0.02);
        for (int i = 0; i <= 60; ++i) line.path_to_line.push_back(0.5 * i);
        from.point = line.line.points.front();
        to.point = line.line.points.back();
        from.opening = to.opening = OpeningId(0);
    }
    [[nodiscard]] Vec3 across() const { return phantom.truth.frame(25).e1; }
};

TEST(Join, LineEndsAtTheCentresAndIsTheAxisElsewhere) {
    AxisLine axis;
    const double shift = 0.3 * kRadius;
    axis.from.point += shift * axis.across();
    axis.to.point += -0.5 * shift * axis.across();
    const auto bent = join_centres(axis.line, axis.from, axis.to, &axis.refiner, axis.verifier);
    ASSERT_TRUE(bent.has_value());
    const Polyline& line = bent->line;
    EXPECT_LT(distance(line.points.front(), axis.from.point), 1e-12 * kRadius);
    EXPECT_LT(distance(line.points.back(), axis.to.point), 1e-12 * kRadius);
    EXPECT_GT(sharpest_turn(line).cosine, 0.99);
    for (const Vec3& x : axis.line.line.points) {
        const double s = axis.phantom.truth.abscissa_of(x);
        if (s < 10 + kRadius || s > 40 - kRadius) continue;
        EXPECT_NE(std::find(line.points.begin(), line.points.end(), x), line.points.end());
    }
    for (std::size_t i = 0; i < line.size(); ++i) {
        const double off = axis.phantom.truth.distance_to_axis(line.points[i]);
        EXPECT_LE(off, shift * (1 + 1e-12));
        // Quadrics meet a cylinder; what is left is the rounding of the patches' feet.
        EXPECT_NEAR(line.radius[i], kRadius - off, 1e-4 * kRadius);
        EXPECT_NEAR(bent->position_error[i], 0.02 + off, 1e-9 * kRadius);
        EXPECT_LE(bent->clearance[i], bent->ball_radius[i]);
        if (i > 0 && line.abscissa[i] < 0.5 * line.abscissa.back()) {
            EXPECT_LE(off, axis.phantom.truth.distance_to_axis(line.points[i - 1]) + 1e-12 * kRadius);
        }
    }
    EXPECT_TRUE(std::is_sorted(bent->path_to_line.begin(), bent->path_to_line.end()));
    EXPECT_EQ(bent->path_to_line.front(), 0);
    EXPECT_EQ(bent->path_to_line.back(), line.abscissa.back());
}

TEST(Join, EndsWithoutOpeningStay) {
    AxisLine axis;
    axis.from.point += kRadius * axis.across();
    axis.from.opening = axis.to.opening = OpeningId();
    const auto bent = join_centres(axis.line, axis.from, axis.to, &axis.refiner, axis.verifier);
    ASSERT_TRUE(bent.has_value());
    EXPECT_EQ(bent->line.points, axis.line.line.points);
    EXPECT_EQ(bent->line.radius, axis.line.line.radius);
}

TEST(Join, CentreOutsideTheLumenIsRefused) {
    AxisLine axis;
    axis.from.point += 1.2 * kRadius * axis.across();
    EXPECT_FALSE(join_centres(axis.line, axis.from, axis.to, &axis.refiner, axis.verifier).has_value());
}

TEST(Join, LinesOfAModelEndWhereAsked) {
    PhantomOptions options;
    options.kind = PhantomKind::kTorus;
    options.points_around = 20;
    options.noise = 0.05;
    options.rotate = true;
    const Phantom phantom = make_phantom(options);
    for (const Refinement refine : {Refinement::kPath, Refinement::kMedial}) {
        PipelineOptions pipeline = test::from_start_to_end(phantom.truth);
        pipeline.characterize = false;
        pipeline.trace.refine = refine;
        const ModelRecord axis = test::run_pipeline(to_soup(phantom), pipeline);
        pipeline.trace.join = Join::kCentre;
        const ModelRecord centre = test::run_pipeline(to_soup(phantom), pipeline);
        ASSERT_FALSE(centre.failure.has_value());
        EXPECT_FALSE(test::has_finding(centre.diagnostics, "line_not_joined"));
        for (const Opening& o : centre.surface->openings) {
            const auto nearest = [&o](const Centerlines& lines) {
                return std::min(distance(lines.points.front(), o.point), distance(lines.points.back(), o.point));
            };
            EXPECT_LT(nearest(*centre.centerlines), 1e-9 * o.radius);
            EXPECT_GT(nearest(*axis.centerlines), 1e-4 * o.radius);  // the noise of the wall is 1.6 % of the radius
        }
        for (const Vec3& x : centre.centerlines->points)
            EXPECT_LT(phantom.truth.distance_to_axis(x), 0.1 * phantom.truth.max_section_radius());
        const auto& abscissa = centre.centerlines->path.line_abscissa;
        EXPECT_TRUE(std::is_sorted(abscissa.begin(), abscissa.end()));
        EXPECT_NEAR(abscissa.back(), centre.centerlines->abscissa.back(), 1e-12 * abscissa.back());
    }
}

}  // namespace
}  // namespace lumenline
