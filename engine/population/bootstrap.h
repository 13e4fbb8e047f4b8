#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/population/hypothesis.h"

namespace lumenline {

/// Values of one subject, which are not independent of each other.
using Cluster = std::vector<double>;

/// Difference of the means of all values, a - b, with the percentile interval of `draws` samples of whole subjects
/// with replacement (Davison & Hinkley 1997, section 3.8). The same arguments give the same interval.
/// @returns NaN where either side has fewer than two subjects
/// @cost O(draws x values)
Interval bootstrap_difference(std::span<const Cluster> a, std::span<const Cluster> b, double confidence,
                              std::size_t draws, std::uint64_t seed);

}  // namespace lumenline
