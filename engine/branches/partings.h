#pragma once

#include <span>
#include <vector>

#include "engine/core/centerlines.h"

namespace lumenline {

/// One centerline.
struct LineView {
    std::span<const Vec3> points;      ///< [length]
    std::span<const double> radius;    ///< [length]
    std::span<const double> abscissa;  ///< [length]

    [[nodiscard]] double length() const { return abscissa.back(); }
    [[nodiscard]] Vec3 position(double s) const;
    [[nodiscard]] double radius_at(double s) const;
    /// The last point at or before `s` that has one after it.
    [[nodiscard]] std::size_t segment(double s) const;
    /// Abscissa of the point nearest to x between `from` and `to`.
    [[nodiscard]] double foot(Vec3 x, double from, double to) const;
};

std::vector<LineView> views_of(const Centerlines& lines);
/// The line from its end to its start; `storage` holds it.
struct ReversedLine {
    std::vector<Vec3> points;
    std::vector<double> radius, abscissa;
    [[nodiscard]] LineView view() const { return {points, radius, abscissa}; }
};
ReversedLine reversed(const LineView& line);

/// Where a line leaves the tube of another one that starts where it does (Antiga & Steinman 2004, section II.B).
struct Parting {
    bool leaves = false;  ///< else it stays in the tube to its end
    /// The last point, before `exit`, whose ball reaches no farther than the exit: up to here the lines are one
    /// [length]
    double touch = 0;
    double exit = 0;  ///< where the line passes through the surface of the other one's tube [length]
};

/// @param other  the line whose inscribed balls, with those between its points, are the tube
/// @cost O(points up to the exit)
Parting part(const LineView& line, const LineView& other);

}  // namespace lumenline
