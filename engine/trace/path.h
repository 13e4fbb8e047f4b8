#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/core/endpoints.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline {

/// A polyline on the complex from a source's anchor over points on polygon edges to a target's
/// anchor. Consecutive points share a polygon.
struct ComplexPath {
    Vec3 start, end;                          ///< anchors [length]
    double start_radius = 0, end_radius = 0;  ///< ball radii there [length]
    std::vector<ComplexPoint> inner;

    [[nodiscard]] std::size_t size() const { return inner.size() + 2; }
};

/// Traces the path of a target back to the source by dynamic programming: from the point reached,
/// the best next point is the one on the edges of the polygons around it that minimises its time
/// plus the exact cost between the two. There is no step size.
/// @param time  arrival times from `source`
/// @returns nothing where the target was not reached
/// @cost O(polygons crossed)
std::optional<ComplexPath> trace_back(const VoronoiComplex& complex, std::span<const double> time,
                                      const Endpoint& source, const Endpoint& target);

/// Slides the inner points along their edges to the shortest path, in the metric 1/R, of the
/// polygon strip that the path crosses. Points at vertices stay.
/// @returns the cost saved, dimensionless, >= 0
/// @cost O(points) per Newton step, a dozen steps
double relax_path(const VoronoiComplex& complex, ComplexPath& path);

/// Cost of the path, the integral of 1/R along it (Antiga et al. 2003, eq. 1), dimensionless.
double path_cost(const VoronoiComplex& complex, const ComplexPath& path);

/// Removes inner points nearer to the one before than `share` of their ball radius.
void thin_path(const VoronoiComplex& complex, ComplexPath& path, double share);

}  // namespace lumenline
