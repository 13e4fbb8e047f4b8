#pragma once

#include <vector>

#include "engine/core/vec3.h"

namespace lumenline {

/// Points with ball radius and arc length.
struct Polyline {
    std::vector<Vec3> points;
    std::vector<double> radius;    ///< [length]
    std::vector<double> abscissa;  ///< arc length from the first point [length]

    [[nodiscard]] std::size_t size() const { return points.size(); }
    void append(Vec3 x, double r);
};

/// The polyline cut at a plane near one of its ends: of the stretch from that end to where the line
/// first passes to the inner side (negative along `normal`), only the crossing point stays. Nothing
/// is cut when the end is on the inner side already; everything when the line never gets there.
/// @param at_front  the end: front or back
/// @returns the arc length cut off [length]
double cut_at_plane(Polyline& line, Vec3 origin, Vec3 normal, bool at_front);

/// The sharpest turn between two segments that follow each other.
struct Turn {
    double cosine = 1;  ///< 1 where the line goes straight on, -1 where it turns back
    Vec3 at;            ///< [length]
};
Turn sharpest_turn(const Polyline& line);

}  // namespace lumenline
