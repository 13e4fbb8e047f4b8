#pragma once

#include <string>
#include <vector>

#include "engine/core/model_record.h"
#include "engine/geometry/inside_test.h"

namespace lumenline::test {

/// All that contradicts the promises of characterize_surface, one sentence each:
/// D_g = |p - pole| + T~(pole); D_e = |p - c(p)| <= |p - pole| + descent_length; 0 <= NTD <= 1, in both variants;
/// c(p) on the path of its line, at its abscissa; NaN and none together, and exactly where T~ is infinite;
/// |T~(x) - T~(y)| <= |x - y| along polygon edges.
std::vector<std::string> character_violations(const ModelRecord& record);

/// Share of the wall's sites with D_e > (1 + tolerance) D_g.
double share_beyond_geodesic(const SurfaceCharacter& character, double tolerance);

/// The line that has the point nearest to x in a straight line, and that point.
struct NaivePoint {
    LineId line;
    Vec3 x;
};
NaivePoint naive_nearest(const Centerlines& lines, Vec3 x);

/// Does the straight segment from the wall's point a to b leave the lumen? Looked at in a hundred places.
bool leaves_lumen(const InsideTest& inside, Vec3 a, Vec3 b);

}  // namespace lumenline::test
