#pragma once

#include "engine/core/centerlines.h"
#include "engine/core/endpoints.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"
#include "engine/core/surface_character.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline {

/// Relates every site to the centerlines over the Voronoi complex (Antiga et al. 2003, section 2.2).
///
/// |grad T~| = 1 is solved from the paths of all lines at once (eq. 6); D_g(p) = |pole(p) - p| + T~(pole(p)) (eq. 7);
/// the descent of T~ from the pole ends in c(p), with D_e(p) = |c(p) - p|; NTD(p) = T~(pole(p)) / D_g(p) (eq. 8).
/// D_e <= |pole(p) - p| + descent_length to rounding; D_e <= D_g up to the march's error. The refined variants take
/// the medial ball that touches the surface at p in the place of the pole's (medial_ball.h).
///
/// Sites that no path joins to a line hold NaN and no id, and are counted (note sites_unreached).
/// @param centerlines  with the places of its paths
/// @returns arrays per site and statistics over the wall, without extensions, caps and end zones
/// @cost about one bare Delaunay triangulation of the sites: 8 us per site at 7k, 13 us at 156k
SurfaceCharacter characterize_surface(const Surface& surface, const VoronoiComplex& complex, const Endpoints& endpoints,
                                      const Centerlines& centerlines, StageContext& context);

}  // namespace lumenline
