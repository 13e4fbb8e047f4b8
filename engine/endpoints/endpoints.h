#pragma once

#include "engine/core/endpoints.h"
#include "engine/core/options.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline {

/// Inlets and outlets of a model, anchored on its Voronoi complex.
///
/// Ends: the modes say which count. Openings of the surface and flat caps that were taken off: the anchor is
/// the point of the complex nearest to the axis of the extended opening, a little beyond its plane, so that
/// lines start on the axis and are cut at the plane. Blind tips (find_tips). Given points: the anchor is the
/// Voronoi vertex in whose ball the point lies deepest (deepest_vertex), max R(v) - |v - p|. A given point
/// within one radius of an opening's centre or three of a tip means that end, unless the mode is points.
///
/// Roles: given inlets and those that rules pick among the ends are inlets; without either, the largest end
/// is. Where the lumen has several parts, each part with two ends or more gets an inlet by the same rule.
/// Outlets are the given ones, or all other ends.
///
/// Order: inlets, then outlets. What is given keeps the order given. Outlets that are found stand by the length
/// of the way along the wall's edges from the nearest inlet, which does not depend on how the triangles are
/// numbered, turned or scaled; paths over the complex would take three times as long. Lengths within 1e-6
/// are equal and go by radius, largest first; radii within 1e-6 by position.
///
/// @param context  receives warnings: inlet_not_clear, endpoint_off_axis, endpoint_unconnected
/// @throws StageError kEndpointsMissing (no ends, no points), kNoInlet, kNoOutlet,
///         kEndpointOutside (more than a quarter of the local radius outside of the lumen, or beyond 1e20),
///         kEndpointAmbiguous (two branches that do not meet there hold the point equally deep, or
///         two points mean one end)
/// @cost O(complex) per endpoint; O(V log V) for tips, and for the order of two outlets or more
Endpoints find_endpoints(const Surface& surface, const VoronoiComplex& complex, const EndpointOptions& options,
                         StageContext& context);

}  // namespace lumenline
