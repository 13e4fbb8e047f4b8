#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/core/ids.h"
#include "engine/core/vec3.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline {

/// Polylines with one value per point, all lines in one array (ragged: offsets + flat values).
struct PathLines {
    std::vector<std::uint32_t> offsets;  ///< (L+1)
    std::vector<Vec3> points;            ///< (Q) on the Voronoi complex [length]
    std::vector<double> ball_radius;     ///< (Q) R [length]
    std::vector<double> abscissa;        ///< (Q) arc length of the path from its source [length]
    std::vector<double> line_abscissa;   ///< (Q) abscissa of the final line's point it corresponds to [length]
    /// (Q) the same points as places of the complex; a and b none at anchors, which lie inside polygons
    /// (Endpoint::anchor_polygons). Not archived.
    std::vector<ComplexPoint> places;
};

/// A loop of the lumen: a handle, around both sides of which the front from one source runs, to meet itself behind it.
/// Where lines cover loops and a part has several sources, also a way from one to another, on which their fronts meet.
struct LumenLoop {
    EndpointId source;       ///< of its first side; that of the second is its line's
    Vec3 point;              ///< where the two sides meet; where lines cover the loop, their common end [length]
    double ball_radius = 0;  ///< of the Voronoi vertex where the fronts meet [length]
    double time = 0;         ///< when they meet there, as ArrivalField::time
};

/// Centerlines of one model. Points run from source to target; the lines end in the planes of
/// their openings (or at the anchors of given points). A loop has two lines, one down each side, which end in one
/// point: there the lines close to a graph with cycles.
struct Centerlines {
    std::vector<std::uint32_t> offsets;  ///< (L+1) into the arrays below
    std::vector<Vec3> points;            ///< (K) [length]
    std::vector<double> ball_radius;     ///< (K) of the largest ball around it that holds no site [length]
    std::vector<double> clearance;       ///< (K) distance to the triangulated surface [length]
    std::vector<double> radius;          ///< (K) best estimate of the maximal inscribed ball's radius [length]
    std::vector<double> radius_error;    ///< (K) estimated error of `radius` [length]
    std::vector<double> position_error;  ///< (K) estimated distance from the true line; NaN = no estimate [length]
    std::vector<double> abscissa;        ///< (K) arc length from the line's first point [length]
    std::vector<EndpointId> source;      ///< (L)
    std::vector<EndpointId> target;      ///< (L) none: it ends where its loop's sides meet
    std::vector<LoopId> loop;            ///< (L) loop of whose two lines it is one; none: it ends at its target
    std::vector<LumenLoop> loops;        ///< (H) found on a surface of genus > 0, whether lines cover them or not
    PathLines path;                      ///< (L lines) the descent paths on the complex

    [[nodiscard]] std::size_t line_count() const { return source.size(); }
};

}  // namespace lumenline
