#pragma once

#include "engine/core/endpoints.h"
#include "engine/core/options.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline {

/// Inlets and outlets of a model, anchored on its Voronoi complex; inlets first, each group in the
/// order given, or by descending size of the opening.
///
/// Openings: the anchor is the point of the complex nearest to the axis of the extended opening, a
/// little beyond its plane, so that lines start on the axis and are cut at the plane. Without an
/// inlet stated, the largest opening is the inlet; without outlets, all other openings are.
/// Given points: the anchor is the Voronoi vertex in whose ball the point lies deepest (deepest_vertex),
/// max R(v) - |v - p|; near an opening (mode auto, boundaries) the point means that opening.
/// @throws StageError kEndpointsMissing (closed surface, no points), kNoInlet, kNoOutlet,
///         kEndpointOutside (more than a quarter of the local radius outside of the lumen),
///         kEndpointAmbiguous (two branches that do not meet there hold the point equally deep, or
///         two points mean one opening)
/// @cost O(complex) per endpoint
Endpoints find_endpoints(const Surface& surface, const VoronoiComplex& complex, const EndpointOptions& options,
                         StageContext& context);

}  // namespace lumenline
