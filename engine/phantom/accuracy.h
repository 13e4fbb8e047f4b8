#pragma once

#include <span>

#include "engine/core/vec3.h"
#include "engine/phantom/phantom.h"

namespace lumenline {

/// Error of a line against a phantom's truth, in percent, mean and standard deviation over arc length.
struct LineError {
    double position_mean = 0, position_sigma = 0;  ///< distance to the axis / position_norm
    double radius_mean = 0, radius_sigma = 0;      ///< |radius - inscribed radius| / radius_norm
    double length_used = 0;                        ///< of the line, between the excluded ends [length]
};

/// Compares a polyline with radii (linear along each segment) with the truth at the middles of
/// pieces no longer than 1/256 of the section's least radius: a tenth of an edge for up to 160
/// points around. The inscribed radius is the one at the nearest axis point. What lies within
/// `exclude_ends` of either end of the axis, or beyond it, is left out.
///
/// @param points         the line, any direction
/// @param radius         one per point [length]
/// @param exclude_ends   >= 0 [length]
/// @param position_norm  100 % of the position error; customarily the section's greatest radius
/// @param radius_norm    100 % of the radius error; customarily the section's least radius
/// @throws std::invalid_argument if the spans differ in length, a norm is not positive, or nothing
///         of the line is left to compare
LineError line_error(const PhantomTruth& truth, std::span<const Vec3> points, std::span<const double> radius,
                     double exclude_ends, double position_norm, double radius_norm);

}  // namespace lumenline
