// Against published values, and against SciPy 1.10.1 and NumPy where no publication is named.
#include "engine/population/hypothesis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/population/agreement.h"
#include "engine/population/bootstrap.h"
#include "engine/population/describe.h"
#include "engine/population/regression.h"

namespace lumenline {
namespace {

using Values = std::vector<double>;

constexpr double kExact = 1e-12;  // relative: rounding of another order of the same sums

const Values kA{4.2, 5.1, 3.9, 6.4, 5.5, 4.8, 7.1, 5.0}, kB{6.1, 7.4, 5.9, 8.2, 6.6, 7.7, 9.0};
const Values kC{1, 2, 2, 3, 4, 4, 4, 5, 6, 7, 8, 9}, kD{2, 3, 4, 5, 5, 6, 7, 8, 8, 9, 10, 11};

void expect_near(double value, double expected, double relative = kExact) {
    EXPECT_NEAR(value, expected, relative * std::fabs(expected));
}

TEST(Describe, QuantilesAreThoseOfNumPy) {
    const Description d = describe(kA);
    EXPECT_EQ(d.count, 8U);
    expect_near(d.median, 5.05);
    expect_near(d.lower_quartile, 4.65);
    expect_near(d.upper_quartile, 5.725);
    Values sorted = kA;
    std::sort(sorted.begin(), sorted.end());
    expect_near(quantile(sorted, 0.05), 4.005);
    expect_near(quantile(sorted, 0.95), 6.855);
}

TEST(Describe, TooFewValuesHaveNoSpread) {
    EXPECT_TRUE(std::isnan(describe(Values{}).mean));
    EXPECT_EQ(describe(Values{3}).mean, 3);
    EXPECT_TRUE(std::isnan(describe(Values{3}).sd));
}

TEST(Ranks, TiesShareTheMeanOfTheirs) { EXPECT_EQ(ranks(Values{5, 1, 5, 0}), (Values{3.5, 2, 3.5, 1})); }

TEST(Welch, AgreesWithSciPy) {
    const WelchResult r = welch_test(kA, kB, 0.95);
    expect_near(r.test.statistic, -3.5304278401567895);
    expect_near(r.test.p, 0.003913658568090372, 1e-10);
    EXPECT_LT(r.difference.low, r.difference.value);
    EXPECT_LT(r.difference.high, 0) << "p < .05 and the interval leave zero out together";
}

TEST(Welch, SamplesThatDoNotVaryHaveNoTest) {
    const WelchResult r = welch_test(Values{2, 2}, Values{2, 2}, 0.95);
    EXPECT_EQ(r.difference.value, 0);
    EXPECT_TRUE(std::isnan(r.test.p));
}

TEST(MannWhitney, ExactWithoutTiesAgreesWithSciPy) {
    const TestResult r = mann_whitney_test(kA, kB);
    EXPECT_EQ(r.statistic, 5);
    expect_near(r.p, 0.005905205905205905, 1e-10);
}

TEST(MannWhitney, ApproximateWithTiesAgreesWithSciPy) {
    const TestResult r = mann_whitney_test(kC, kD);
    EXPECT_EQ(r.statistic, 43.5);
    expect_near(r.p, 0.10399302682646162, 1e-10);
}

TEST(BrownForsythe, AgreesWithSciPy) {
    const TestResult r = brown_forsythe_test(std::vector{kA, kB, kC});
    expect_near(r.statistic, 2.729706764144743);
    expect_near(r.p, 0.08547630489495449, 1e-10);
}

// Benjamini & Hochberg 1995, section 3.2: of fifteen hypotheses four are rejected at .05.
TEST(BenjaminiHochberg, RejectsWhatThePaperDoes) {
    const Values p{0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344,
                   0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0000};
    const Values q = benjamini_hochberg(p);
    EXPECT_EQ(std::count_if(q.begin(), q.end(), [](double v) { return v <= 0.05; }), 4);
    expect_near(q[0], 0.0015);
    EXPECT_TRUE(std::is_sorted(q.begin(), q.end()));
}

TEST(BenjaminiHochberg, MissingValuesStayMissingAndDoNotCount) {
    const Values q = benjamini_hochberg(Values{0.01, std::nan(""), 0.04});
    expect_near(q[0], 0.02);
    EXPECT_TRUE(std::isnan(q[1]));
    expect_near(q[2], 0.04);
}

TEST(Correlation, AgreesWithSciPy) {
    const CorrelationResult r = pearson_correlation(kC, kD, 0.95);
    expect_near(r.coefficient.value, 0.9750461988312729);
    expect_near(r.coefficient.low, 0.9108240301552678, 1e-10);
    expect_near(r.coefficient.high, 0.993182286061756, 1e-10);
    expect_near(r.p, 7.307782693633673e-08, 1e-6);
    const CorrelationResult s = spearman_correlation(kC, Values(kD.rbegin(), kD.rend()), 0.95);
    expect_near(s.coefficient.value, -0.9840846688455568);
    expect_near(s.p, 7.830220894337678e-09, 1e-6);
}

// NIST Statistical Reference Datasets, Norris: certified values of a straight line.
TEST(Regression, MeetsCertifiedValuesOfNorris) {
    const Values y{0.1, 338.8, 118.1, 888.0, 9.2,   228.1, 668.5, 998.5, 449.1, 778.9, 559.2, 0.3,
                   0.1, 778.1, 668.8, 339.3, 448.9, 10.8,  557.7, 228.3, 998.0, 888.8, 119.6, 0.3,
                   0.6, 557.6, 339.3, 888.0, 998.5, 778.9, 10.2,  117.6, 228.9, 668.4, 449.2, 0.2};
    const Values x{0.2, 337.4, 118.2, 884.6, 10.1,  226.5, 666.3, 996.3, 448.6, 777.0, 558.2, 0.4,
                   0.6, 775.5, 666.9, 338.0, 447.5, 11.6,  556.0, 228.1, 995.8, 887.6, 120.2, 0.3,
                   0.3, 556.8, 339.1, 887.2, 999.0, 779.0, 11.1,  118.3, 229.2, 669.1, 448.9, 0.5};
    const Regression r = fit_linear(y, std::vector<Predictor>{{"x", x}}, 0.95);
    ASSERT_EQ(r.terms.size(), 2U);
    expect_near(r.terms[0].coefficient.value, -0.262323073774029, 1e-9);
    expect_near(r.terms[1].coefficient.value, 1.00211681802045, 1e-12);
    expect_near(r.terms[0].error, 0.232818234301152, 1e-9);
    expect_near(r.terms[1].error, 0.429796848199937e-03, 1e-9);
    expect_near(r.r_squared, 0.999993745883712, 1e-12);
}

TEST(Regression, DependentPredictorsHaveNoFit) {
    const Values x{1, 2, 3, 4, 5}, twice{2, 4, 6, 8, 10};
    EXPECT_TRUE(fit_linear(kB, std::vector<Predictor>{{"x", Values(7, 1.0)}}, 0.95).terms.empty());
    EXPECT_TRUE(fit_linear(x, std::vector<Predictor>{{"x", x}, {"twice", twice}}, 0.95).terms.empty());
}

// Bland & Altman 1986, table 1: peak expiratory flow by two meters, first readings. The paper takes limits of 2 sd.
TEST(Agreement, MeetsBlandAndAltman) {
    const Values mini{512, 430, 520, 428, 500, 600, 364, 380, 658, 445, 432, 626, 260, 477, 259, 350, 451};
    const Values wright{494, 395, 516, 434, 476, 557, 413, 442, 650, 433, 417, 656, 267, 478, 178, 423, 427};
    const Agreement r = agreement(mini, wright, 0.95);
    EXPECT_NEAR(r.bias.value, -2.1, 0.05);
    EXPECT_NEAR(r.sd, 38.8, 0.05);
    EXPECT_NEAR(r.bias.low, -22.0, 0.1);
    EXPECT_NEAR(r.bias.high, 17.8, 0.1);
    EXPECT_NEAR(r.upper_limit.value, -2.1 + 1.96 * 38.8, 0.1);
    EXPECT_GT(r.icc.value, 0.9);
    EXPECT_LT(r.icc.low, r.icc.value);
    EXPECT_GT(r.icc.high, r.icc.value);
}

TEST(Agreement, EqualMeasurementsAgreeWholly) { EXPECT_EQ(agreement(kA, kA, 0.95).icc.value, 1); }

TEST(Bootstrap, DrawsAreTheSameEachTimeAndWidenWithDependence) {
    const std::vector<Cluster> a{{4, 4.1}, {5, 5.2}, {3.8, 3.9}, {6, 6.1}}, b{{6, 6.3}, {7, 7.1}, {5.9, 6}, {8, 8.1}};
    const Interval one = bootstrap_difference(a, b, 0.95, 2000, 1), again = bootstrap_difference(a, b, 0.95, 2000, 1);
    EXPECT_EQ(one.low, again.low);
    EXPECT_EQ(one.high, again.high);
    std::vector<Cluster> flat_a, flat_b;
    for (const Cluster& c : a)
        for (const double v : c) flat_a.push_back({v});
    for (const Cluster& c : b)
        for (const double v : c) flat_b.push_back({v});
    const Interval naive = bootstrap_difference(flat_a, flat_b, 0.95, 2000, 1);
    EXPECT_GT(one.high - one.low, 1.2 * (naive.high - naive.low)) << "two values of a subject are no two subjects";
}

}  // namespace
}  // namespace lumenline
