#pragma once

#include <vector>

#include "engine/core/stage_context.h"
#include "engine/core/surface.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline {

/// The blind end of a vessel.
struct Tip {
    VoronoiVertexId vertex;  ///< on the axis, about one local radius inside the end
    VoronoiVertexId end;     ///< outermost vertex of the complex
    Vec3 direction;          ///< unit, along the axis out of the lumen
    double length = 0;       ///< by which the vessel juts out of the balls of larger vessels [length]
    double ratio = 0;        ///< the same in mean radii of that stretch
};

/// Blind ends, by descending distance along the lumen from one of the two that lie farthest apart in
/// their connected part of the complex; that one first.
///
/// A tip is a maximum of the length of the paths of least cost from there. The branch it belongs to runs
/// back to where the tip's part of the complex joins one that reaches farther (the merge tree of the
/// length); of it counts what lies outside of the balls of the paths already accepted, up to the wall
/// beyond the tip. The tip is accepted if that is longer than `tip_length` mean radii of the same
/// stretch, and than two median edges of the wall. Where two fronts meet on the far side of a loop there is a maximum too, which is no tip.
/// The ends of openings are none either.
/// @param tip_length  least length of a branch beyond the wall of its parent [local radii]
/// @cost O(V log V)
std::vector<Tip> find_tips(const Surface& surface, const VoronoiComplex& complex, double tip_length,
                           StageContext& context);

}  // namespace lumenline
