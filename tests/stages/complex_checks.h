#pragma once

#include <string>

#include "engine/core/surface.h"
#include "engine/core/voronoi_complex.h"
#include "tests/stages/reference_complex.h"

namespace lumenline::test {

// Checks of a Voronoi complex against its definition. Each gives what is wrong in one sentence, or
// an empty text. `tolerance` is relative to the ball radius; to it comes what the rounding of the
// surface's coordinates allows.

/// Sizes, offsets, and both directions of the incidence between vertices and polygons.
std::string check_incidence(const Surface& surface, const VoronoiComplex& complex);

/// Every polygon is planar, convex, and its vertices are as far from its two sites as their radius says.
std::string check_polygons(const Surface& surface, const VoronoiComplex& complex, double tolerance);

/// No site is inside any ball, and one is on its sphere. Brute force over every `stride`-th vertex.
std::string check_balls(const Surface& surface, const VoronoiComplex& complex, double tolerance,
                        std::size_t stride = 1);

/// No vertex is outside of the surface.
std::string check_inside(const Surface& surface, const VoronoiComplex& complex);

/// No edge leaves the lumen: where one crosses the wall, it does so into another part of the lumen.
std::string check_edges(const Surface& surface, const VoronoiComplex& complex);

/// The polygons and bare edges are those of the reference, one for one.
std::string compare_polygons(const VoronoiComplex& complex, const ReferenceComplex& reference, double tolerance);

/// The poles are as far as the reference's, and absent where its are.
std::string compare_poles(const Surface& surface, const VoronoiComplex& complex, const ReferenceComplex& reference,
                          double tolerance);

/// No vertex of a site's polygons is farther from it than its pole.
std::string check_poles(const Surface& surface, const VoronoiComplex& complex, double tolerance);

/// Number of connected components of the complex.
std::size_t count_components(const VoronoiComplex& complex);

}  // namespace lumenline::test
