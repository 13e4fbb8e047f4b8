#pragma once

#include "engine/core/surface.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline {

/// The point of a Voronoi polygon or bare edge nearest to some point in space.
struct NearestOnPolygon {
    Vec3 point;
    ComplexPoint place;  ///< on the polygon's boundary; a and b none where the point is inside the polygon

    [[nodiscard]] bool is_inside() const { return place.a.is_none(); }
};

/// Point of the segment ab nearest to x, as t in a + t (b - a); 0 where the segment has no length.
double nearest_on_segment(Vec3 a, Vec3 b, Vec3 x);

/// A polygon lies in the bisector plane of its two sites, so the distance is that of plane geometry.
/// @cost O(vertices of the polygon)
NearestOnPolygon nearest_on_polygon(const Surface& surface, const VoronoiComplex& complex, PolygonId p, Vec3 x);

}  // namespace lumenline
