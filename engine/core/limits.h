#pragma once

namespace lumenline {

/// Largest absolute coordinate of surfaces and points, and one over the least extent of a surface: squares and cubes of
/// anything between are finite, not zero, and far from the limits of a double.
inline constexpr double kLargestCoordinate = 1e20;

}  // namespace lumenline
