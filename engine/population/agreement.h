#pragma once

#include <span>

#include "engine/population/hypothesis.h"

namespace lumenline {

/// How well two measurements of the same subjects agree.
struct Agreement {
    std::size_t count = 0;  ///< of pairs
    Interval icc;           ///< ICC(A,1): two-way, absolute agreement, single measurement (McGraw & Wong 1996)
    Interval bias;          ///< mean of second - first
    double sd = std::numeric_limits<double>::quiet_NaN();  ///< of the differences
    Interval lower_limit, upper_limit;                     ///< of agreement: bias -+ 1.96 sd (Bland & Altman 1986)
};

/// @param first, second  of equal length, one pair per subject
/// @returns NaN throughout with fewer than three pairs
Agreement agreement(std::span<const double> first, std::span<const double> second, double confidence);

}  // namespace lumenline
