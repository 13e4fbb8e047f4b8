#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace lumenline {

/// Location and spread of a sample; NaN where it has too few values.
struct Description {
    std::size_t count = 0;
    double mean = std::numeric_limits<double>::quiet_NaN(), sd = mean;  ///< sd with n - 1
    double median = mean, lower_quartile = mean, upper_quartile = mean;
    double least = mean, largest = mean;
};

/// @param values  finite
/// @cost O(n log n)
Description describe(std::span<const double> values);

/// Value below which a share of the sample lies, linear between order statistics (type 7 of Hyndman & Fan 1996, the
/// rule of R and NumPy). @param sorted  ascending, not empty @param share  0 to 1
double quantile(std::span<const double> sorted, double share);

/// Ranks from 1, ties sharing the mean of theirs.
std::vector<double> ranks(std::span<const double> values);

}  // namespace lumenline
