#include "engine/branches/robust.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/branches/junctions.h"

namespace lumenline {
namespace {

TEST(RepeatedMedian, NearlyHalfOfThePointsMayLieAnywhere) {
    std::vector<double> x, y;
    for (int k = 0; k < 41; ++k) {
        x.push_back(k);
        y.push_back(k % 7 < 4 ? 3 - 0.25 * k : 100.0 + k * k);
    }
    const StraightFit fit = repeated_median(x, y);
    EXPECT_NEAR(fit.slope, -0.25, 1e-12);
    EXPECT_NEAR(fit(8), 1, 1e-12);
}

TEST(RepeatedMedian, TooFewPointsGiveNoLine) {
    EXPECT_TRUE(std::isnan(repeated_median({}, {}).slope));
    EXPECT_TRUE(std::isnan(repeated_median(std::vector<double>{1}, std::vector<double>{2}).slope));
}

TEST(Distribution, WeightsCountAndMissingValuesDoNot) {
    const double nan = std::nan("");
    const Distribution d = distribution_of({{3, 1}, {1, 1}, {nan, 5}, {2, 2}, {7, 0}});
    EXPECT_DOUBLE_EQ(d.mean, 2);
    EXPECT_DOUBLE_EQ(d.sd, std::sqrt(0.5));
    EXPECT_EQ(d.min, 1);
    EXPECT_EQ(d.max, 3);
    EXPECT_DOUBLE_EQ(d.median, 2);
    EXPECT_DOUBLE_EQ(d.p25, 1 + 0.5 / 1.5);
    EXPECT_TRUE(std::isnan(distribution_of({{nan, 1}}).mean));
    EXPECT_TRUE(std::isnan(distribution_of({{3, 1}}).sd)) << "one value does not vary";
}

TEST(Murray, ExponentOfKnownRatios) {
    EXPECT_NEAR(murray_exponent({std::cbrt(0.5), std::cbrt(0.5)}), 3, 1e-9);
    EXPECT_NEAR(murray_exponent({0.6, 0.8}), 2, 1e-9);
    EXPECT_TRUE(std::isnan(murray_exponent({1.0, 0.5})));
    EXPECT_TRUE(std::isnan(murray_exponent({std::nan(""), 0.5})));
}

}  // namespace
}  // namespace lumenline
