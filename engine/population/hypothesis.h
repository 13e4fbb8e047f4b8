#pragma once

#include <limits>
#include <span>
#include <vector>

namespace lumenline {

/// A value with its confidence interval.
struct Interval {
    double value = std::numeric_limits<double>::quiet_NaN(), low = value, high = value;
};

/// Outcome of a test of hypothesis; NaN where samples are too small or do not vary.
struct TestResult {
    double statistic = std::numeric_limits<double>::quiet_NaN(), p = statistic;
};

/// Difference of means a - b without assuming equal variances (Welch 1947), two-sided.
struct WelchResult {
    Interval difference;  ///< of the means
    TestResult test;      ///< t
    double freedom = std::numeric_limits<double>::quiet_NaN();
};
/// @param confidence  of the interval, 0 to 1
WelchResult welch_test(std::span<const double> a, std::span<const double> b, double confidence);

/// Whether values of a tend to exceed those of b (Mann & Whitney 1947), two-sided. Exact without ties where the smaller
/// sample has no more than 8 values, else the normal approximation with corrections for ties and continuity.
/// @returns U of a
TestResult mann_whitney_test(std::span<const double> a, std::span<const double> b);

/// Whether groups differ in spread: one-way analysis of variance of the distances from the groups' medians (Brown &
/// Forsythe 1974). @returns F
TestResult brown_forsythe_test(std::span<const std::vector<double>> groups);

/// p values adjusted for the share of false discoveries among the family (Benjamini & Hochberg 1995); NaN stays and
/// does not count.
std::vector<double> benjamini_hochberg(std::span<const double> p);

/// Product-moment correlation, with the interval of Fisher's transformation and the two-sided test by t.
struct CorrelationResult {
    Interval coefficient;
    double p = std::numeric_limits<double>::quiet_NaN();
};
CorrelationResult pearson_correlation(std::span<const double> x, std::span<const double> y, double confidence);

/// The same of the ranks (Spearman 1904); its interval is approximate.
CorrelationResult spearman_correlation(std::span<const double> x, std::span<const double> y, double confidence);

}  // namespace lumenline
