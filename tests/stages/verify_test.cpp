// The verifier on the true axis of a hairpin, and on lines that are wrong in one way each.
#include "engine/trace/verify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/stages/support.h"

namespace lumenline {
namespace {

class LineVerification : public ::testing::Test {
protected:
    LineVerification() : phantom(make_phantom(hairpin())), surface(test::closed_surface(phantom)), verifier(surface) {}

    static PhantomOptions hairpin() {
        PhantomOptions options;
        options.kind = PhantomKind::kHairpin;
        options.points_around = 24;
        options.leg_length = 30;
        options.bend_radius = 6;  // a gap of 2 between the legs' walls
        options.jitter = 0.2;
        options.caps = true;
        options.rotate = true;
        return options;
    }

    /// The radius of the empty ball around x, by brute force.
    [[nodiscard]] double ball_radius_at(Vec3 x) const {
        double least2 = std::numeric_limits<double>::infinity();
        for (const Vec3& p : surface.points) least2 = std::min(least2, squared_norm(p - x));
        return std::sqrt(least2);
    }

    /// Points on the axis between two shares of its length, `aside` off it in the plane of the hairpin.
    [[nodiscard]] Polyline axis_line(double from, double to, int count, double aside = 0) const {
        Polyline line;
        for (int i = 0; i <= count; ++i) {
            const double share = from + (to - from) * i / count;
            const AxisFrame f = phantom.truth.frame(share * phantom.truth.total_length());
            const Vec3 x = f.origin + aside * f.e1;
            line.append(x, ball_radius_at(x));
        }
        return line;
    }

    Phantom phantom;
    Surface surface;
    LineVerifier verifier;
};

TEST_F(LineVerification, AcceptsTheAxisWithItsBalls) {
    const Polyline line = axis_line(0.05, 0.95, 200);
    const LineCheck check = verifier.check(line);
    EXPECT_TRUE(check.inside);
    EXPECT_LE(check.ball_excess, 0);
    ASSERT_EQ(check.clearance.size(), line.size());
    for (std::size_t i = 0; i < line.size(); ++i) {
        EXPECT_LE(check.clearance[i], line.radius[i] * (1 + 1e-12));
        EXPECT_GT(check.clearance[i], 0.95 * line.radius[i]);
    }
}

TEST_F(LineVerification, ClearanceIsTheDistanceToTheTriangles) {
    const Polyline line = axis_line(0.05, 0.95, 30, 1.5);
    const LineCheck check = verifier.check(line);
    for (std::size_t i = 0; i < line.size(); ++i) {
        double least = std::numeric_limits<double>::infinity();
        for (const auto& t : surface.triangles)
            least = std::min(least, test::distance_to_triangle(line.points[i], surface.points[at(t[0])],
                                                               surface.points[at(t[1])], surface.points[at(t[2])]));
        EXPECT_NEAR(check.clearance[i], least, 1e-12 * surface.diagonal);
    }
}

TEST_F(LineVerification, AcceptsALongSegmentInsideALeg) {
    // Much longer than the balls of its ends: it is halved until they cover it.
    EXPECT_TRUE(verifier.check(axis_line(0.03, 0.35, 1)).inside);
    EXPECT_TRUE(verifier.check(axis_line(0.03, 0.35, 1, 4)).inside);
}

TEST_F(LineVerification, RejectsALineMovedOutOfTheLumen) {
    for (const double aside : {5.5, -5.5, 12.0}) {
        const LineCheck check = verifier.check(axis_line(0.05, 0.35, 40, aside));
        const Vec3 x = check.outside_at;
        EXPECT_FALSE(check.inside) << "moved by " << aside;
        EXPECT_GT(phantom.truth.distance_to_axis(x), 4.9) << "moved by " << aside;
    }
}

TEST_F(LineVerification, RejectsOnePointOutside) {
    Polyline line = axis_line(0.05, 0.95, 100);
    line.points[50] += 30 * phantom.truth.frame(0).e2;
    const LineCheck check = verifier.check(line);
    EXPECT_FALSE(check.inside);
    EXPECT_EQ(check.outside_at, line.points[50]);
}

TEST_F(LineVerification, RejectsASegmentAcrossTheGap) {
    // Both ends are on the axis, in the two legs.
    Polyline line;
    for (const double share : {0.1, 0.9}) {
        const Vec3 x = phantom.truth.position(share * phantom.truth.total_length());
        line.append(x, ball_radius_at(x));
    }
    ASSERT_TRUE(phantom.truth.inside(line.points[0]) && phantom.truth.inside(line.points[1]));
    EXPECT_LT(distance(line.points[0], line.points[1]), 13);
    EXPECT_FALSE(verifier.check(line).inside);
}

TEST_F(LineVerification, RejectsRadiiThatAreTooLargeOrTooSmall) {
    for (const double factor : {0.9, 0.97, 1.03, 1.1}) {
        Polyline line = axis_line(0.05, 0.95, 100);
        line.radius[60] *= factor;
        const LineCheck check = verifier.check(line);
        EXPECT_TRUE(check.inside);
        EXPECT_GT(check.ball_excess, 0.001) << "factor " << factor;
    }
}

}  // namespace
}  // namespace lumenline
