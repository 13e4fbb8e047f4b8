// The closed form is held against quadrature of 1/|x - p| in planes of equidistance, and the series
// against the logarithm in extended precision.
#include "engine/geometry/segment_cost.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/stages/support.h"

namespace lumenline {
namespace {

/// Integral of 1/|x - p| from a to b: Gauss-Legendre with five nodes on each of `panels` pieces.
double integral_of_inverse_radius(Vec3 p, Vec3 a, Vec3 b, int panels) {
    constexpr std::array<double, 3> kNode{0.0, 0.53846931010568309, 0.90617984593866399};
    constexpr std::array<double, 3> kWeight{0.56888888888888889, 0.47862867049936647, 0.23692688505618909};
    long double sum = 0;
    for (int i = 0; i < panels; ++i)
        for (std::size_t k = 0; k < 3; ++k)
            for (const int side : {-1, 1}) {
                if (k == 0 && side == 1) continue;
                const double t = (i + 0.5 * (1 + side * kNode[k])) / panels;
                sum += static_cast<long double>(0.5 * kWeight[k] / distance(lerp(a, b, t), p));
            }
    return static_cast<double>(sum / panels) * distance(a, b);
}

TEST(SegmentCost, EqualsTheIntegralOfTheInverseRadiusInThePlaneOfEquidistance) {
    test::Random random(1);
    double worst = 0;
    for (int i = 0; i < 300; ++i) {
        const Vec3 n = random.direction(), u = any_perpendicular(n), v = cross(n, u);
        const double half = std::pow(10, random.uniform(-1, 1));  // half the distance of the two sites
        const Vec3 p = half * n;
        const auto in_plane = [&] { return random.uniform(-1, 1) * u + random.uniform(-1, 1) * v; };
        const Vec3 a = in_plane(), b = in_plane();
        const double exact = integral_of_inverse_radius(p, a, b, 400);
        // The sites are at least a 28th of the longest segment away: the panels' error is below 1e-14, and
        // 1 - L / (R1 + R2) keeps three digits less than a double has.
        for (const Vec3 site : {p, -p}) {
            const double cost = segment_cost(distance(a, b), distance(a, site) + distance(b, site));
            worst = std::max(worst, std::fabs(cost - exact) / exact);
        }
    }
    EXPECT_LT(worst, 1e-12);
}

TEST(SegmentCost, SeriesAndLogarithmAgreeWithTheInverseHyperbolicTangent) {
    // 1e-13 is what the header promises of the series; the logarithm's argument is within two roundings,
    // which weigh 2/y relative to the result.
    double worst = 0, worst_at = 0;
    for (double y = 1e-8; y < 0.99; y *= 1.001) {
        const auto exact = static_cast<double>(2 * std::atanh(static_cast<long double>(y)));
        const double error = std::fabs(segment_cost(y, 1) - exact) / exact;
        if (error > worst) worst_at = y;
        worst = std::max(worst, error);
    }
    EXPECT_LT(worst, 1e-13) << "at y = " << worst_at;
}

TEST(SegmentCost, DoesNotJumpWhereTheSeriesEnds) {
    // Neighbouring arguments must give neighbouring values wherever the switch is: at some round number.
    for (int i = 1; i < 100; ++i) {
        const double y = 0.01 * i, next = std::nextafter(y, 1.0), before = std::nextafter(y, 0.0);
        EXPECT_NEAR(segment_cost(next, 1), segment_cost(before, 1), 1e-13 * segment_cost(y, 1)) << "at y = " << y;
    }
}

TEST(SegmentCost, GrowsWithLengthAndStaysFiniteWhereRoundingReachesTheSumOfRadii) {
    EXPECT_EQ(segment_cost(0, 3), 0);
    double last = -1;
    for (int i = 0; i <= 1000; ++i) {
        const double cost = segment_cost(0.001 * i, 1);
        EXPECT_GT(cost, last);
        last = cost;
    }
    EXPECT_TRUE(std::isfinite(segment_cost(1, 1)));
    EXPECT_TRUE(std::isfinite(segment_cost(1 + 1e-12, 1)));
    EXPECT_EQ(segment_cost(2, 1), segment_cost(1, 1));
}

TEST(SegmentCost, DoesNotDependOnTheUnitOfLength) {
    for (const double scale : {1e-6, 1e-3, 1e3, 1e6})
        // One rounding each in length, sum and quotient.
        EXPECT_NEAR(segment_cost(0.3 * scale, 1.1 * scale), segment_cost(0.3, 1.1), 1e-15);
}

TEST(RadiusBetween, IsTheDistanceToTheSiteAllAlongTheSegment) {
    test::Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 p = random.in_box({-1, -1, -1}, {1, 1, 1}), a = random.in_box({-1, -1, -1}, {1, 1, 1}),
                   b = random.in_box({-1, -1, -1}, {1, 1, 1});
        const double t = random.uniform(0, 1), r = distance(lerp(a, b, t), p);
        // The square carries a few roundings of squares up to 12, and the root divides by 2 r.
        EXPECT_NEAR(radius_between(distance(a, p), distance(b, p), squared_norm(b - a), t), r, 1e-14 / r);
    }
    EXPECT_EQ(radius_between(2, 3, 1, 0), 2);
    EXPECT_EQ(radius_between(2, 3, 1, 1), 3);
    EXPECT_EQ(radius_between(1, 1, 5, 0.5), 0) << "a square below zero is a radius of zero";
}

}  // namespace
}  // namespace lumenline
