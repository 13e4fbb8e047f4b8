#pragma once

#include "engine/core/options.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline {

/// Embedded Voronoi diagram of a closed surface's sites (Antiga et al. 2003, eqs. 3-4).
///
/// Vertices are circumcentres inside the lumen; coincident ones are merged. Polygons are kept when
/// all their vertices are inside ("complete vertex loops"); Voronoi edges that bound no such
/// polygon are kept as bare edges, or the axis of an exactly circular tube would fall apart.
/// Poles are the farthest inside Voronoi vertices (Amenta et al. 2001).
/// @returns never empty
/// @throws StageError kNoLumen when no circumcentre is inside
/// @cost about 1.4 x CGAL's Delaunay triangulation, which it contains; 1.2 kB per site at the peak
VoronoiComplex build_voronoi(const Surface& surface, const VoronoiOptions& options, StageContext& context);

}  // namespace lumenline
