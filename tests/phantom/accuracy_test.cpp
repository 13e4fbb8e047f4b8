#include "engine/phantom/accuracy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "tests/phantom/shapes.h"

namespace lumenline {
namespace {

struct Line {
    std::vector<Vec3> points;
    std::vector<double> radius;
};

// A line at the distance `offset` from the axis whose radius is `excess` too large.
Line line_beside(const PhantomTruth& truth, double offset, double excess, int count) {
    Line line;
    for (int i = 0; i <= count; ++i) {
        const double s = truth.total_length() * i / count;
        const AxisFrame f = truth.frame(s);
        line.points.push_back(f.origin + offset * f.e1);
        line.radius.push_back(truth.inscribed_radius(s) + excess);
    }
    return line;
}

TEST(LineError, ConstantOffsetIsMeasuredInPercentOfTheNorms) {
    for (const auto& [name, options] : test_shapes()) {
        const PhantomTruth truth(options);
        const double size = truth.min_section_radius();
        const Line line = line_beside(truth, 0.02 * size, -0.03 * size, 2000);
        const LineError error = line_error(truth, line.points, line.radius, size, 2 * size, size);
        // Chords of 1/2000 of the axis sag below 1e-4 of the radius; radii are linear between points.
        EXPECT_NEAR(error.position_mean, 1, 0.01) << name;
        EXPECT_NEAR(error.radius_mean, 3, 0.01) << name;
        EXPECT_LT(error.position_sigma, 0.01) << name;
        EXPECT_LT(error.radius_sigma, 0.01) << name;
        EXPECT_LT(error.length_used, truth.total_length() - 1.9 * size + 0.05 * truth.total_length()) << name;
        EXPECT_GT(error.length_used, 0.9 * (truth.total_length() - 2 * size)) << name;
    }
}

TEST(LineError, LinearOffsetHasTheMomentsOfAUniformDistribution) {
    const PhantomTruth truth(PhantomOptions{});
    const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 50}};
    const std::vector<double> radius{5, 6};
    const LineError error = line_error(truth, points, radius, 10, 5, 5);
    // From a fifth to four fifths of the way: mean 1/2, sigma 0.6 / sqrt(12); midpoint rule.
    EXPECT_NEAR(error.position_mean, 10, 0.01);
    EXPECT_NEAR(error.position_sigma, 20 * 0.6 / std::sqrt(12), 0.01);
    EXPECT_NEAR(error.radius_mean, 10, 0.01);
    EXPECT_NEAR(error.radius_sigma, 20 * 0.6 / std::sqrt(12), 0.01);
    EXPECT_NEAR(error.length_used, 0.6 * std::hypot(1, 50), 0.05);  // a piece at either end
}

TEST(LineError, WeightsByLengthNotByPoints) {
    const PhantomTruth truth(PhantomOptions{});
    std::vector<Vec3> points{{0, 0, 10}, {0, 0, 30}};                       // 20 long, exact
    for (int i = 0; i <= 100; ++i) points.push_back({1, 0, 30 + 0.1 * i});  // 10 long, off by one
    const std::vector<double> radius(points.size(), 5.0);
    const LineError error = line_error(truth, points, radius, 0, 1, 1);
    // The step of length 1 between both parts has the mean offset 1/2.
    EXPECT_NEAR(error.position_mean, 100 * (10 + 0.5) / 31, 0.01);
    EXPECT_NEAR(error.radius_mean, 0, 1e-12);
}

TEST(LineError, BeyondTheEndsNothingCounts) {
    const PhantomTruth truth(PhantomOptions{});
    const std::vector<Vec3> points{{0, 0, -40}, {0, 0, 80}};
    const std::vector<double> radius{5, 5};
    const LineError error = line_error(truth, points, radius, 0, 5, 5);
    EXPECT_NEAR(error.length_used, 50, 0.05);
    EXPECT_NEAR(error.position_mean, 0, 1e-12);
}

TEST(LineError, UnusableLinesAreRejected) {
    const PhantomTruth truth(PhantomOptions{});
    const std::vector<Vec3> points{{0, 0, 10}, {0, 0, 40}};
    const std::vector<double> radius{5, 5};
    EXPECT_THROW(line_error(truth, points, std::vector<double>{5}, 0, 5, 5), std::invalid_argument);
    EXPECT_THROW(line_error(truth, points, radius, 25, 5, 5), std::invalid_argument);
    EXPECT_THROW(line_error(truth, points, radius, -1, 5, 5), std::invalid_argument);
    EXPECT_THROW(line_error(truth, points, radius, 0, 0, 5), std::invalid_argument);
    EXPECT_THROW(line_error(truth, {}, {}, 0, 5, 5), std::invalid_argument);
    const std::vector<double> bad{5, std::numeric_limits<double>::quiet_NaN()};
    EXPECT_THROW(line_error(truth, points, bad, 0, 5, 5), std::invalid_argument);
}

}  // namespace
}  // namespace lumenline
