#pragma once

#include <span>
#include <utility>
#include <vector>

#include "engine/core/branch_tables.h"

namespace lumenline {

/// y = at_zero + slope x.
struct StraightFit {
    double slope, at_zero;
    [[nodiscard]] double operator()(double x) const { return at_zero + slope * x; }
};

/// Line by repeated medians (Siegel 1982): up to half of the points may lie anywhere. Of more than 96 points every so
/// many count. NaN with fewer than two different x.
/// @param x  ascending
/// @cost O(n^2), n at most 96
StraightFit repeated_median(std::span<const double> x, std::span<const double> y);

/// Middle of the values, the mean of the middle two; NaN of none. Reorders them.
double median_of(std::vector<double>& values);

/// @param weighted  value and weight; values that are NaN are left out
/// @returns         NaN of none; of one the standard deviation is NaN
Distribution distribution_of(std::vector<std::pair<double, double>> weighted);

}  // namespace lumenline
