#pragma once

#include <string>

#include "engine/core/endpoints.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"
#include "engine/core/voronoi_complex.h"
#include "engine/endpoints/tips.h"

namespace lumenline {

/// Throws the StageError of this stage.
[[noreturn]] void refuse_endpoints(ErrorCode code, const std::string& sentence);

/// Endpoint at an opening, not anchored yet.
Endpoint end_of_opening(const Surface& surface, OpeningId id);

/// Anchors the endpoint of an opening on its axis, a little beyond its plane; leaves others as they are.
/// Warns (endpoint_off_axis) where the complex comes no nearer to the axis than a radius.
/// @cost O(complex)
void anchor_end(const Surface& surface, const VoronoiComplex& complex, Endpoint& e, StageContext& context);

/// Endpoint at a given point, anchored at the vertex in whose ball it lies deepest. Warns
/// (endpoint_off_axis) where it lies in no ball.
/// @param name  of the point in messages
/// @throws StageError kEndpointOutside, kEndpointAmbiguous
/// @cost O(complex)
Endpoint endpoint_at_point(const VoronoiComplex& complex, Vec3 point, const std::string& name, StageContext& context);

/// Endpoint at a blind tip, anchored at its vertex.
Endpoint endpoint_at_tip(const VoronoiComplex& complex, const Tip& tip);

}  // namespace lumenline
