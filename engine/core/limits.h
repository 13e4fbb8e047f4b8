#pragma once

namespace lumenline {

/// Largest absolute coordinate of surfaces and points: squares and cubes of anything below are finite and far from the
/// limit of a double.
inline constexpr double kLargestCoordinate = 1e20;

}  // namespace lumenline
