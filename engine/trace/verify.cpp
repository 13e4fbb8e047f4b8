// The ball of a point's clearance holds nothing of the surface: where the balls of two points overlap,
// both points are in the lumen or neither is. So the exact inside test is asked for the first point of
// the first line only, and a segment stays inside when the balls of its ends cover it, or those of its
// halves. Rounding of the input moves balls by about its own size: the tolerance on R is 1e-6 R plus twice the
// distance within which the complex merges vertices.
#include "engine/trace/verify.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry/inside_test.h"

namespace lumenline {

LineVerifier::LineVerifier(const Surface& surface) : surface_(surface), distance_(surface.points, surface.triangles) {}

bool LineVerifier::inside(Vec3 x, double clearance) {
    for (const Ball& b : known_)
        if (distance(x, b.centre) < clearance + b.radius) return true;
    if (!inside_surface(surface_.points, surface_.triangles, x)) return false;
    known_.push_back({x, clearance});
    return true;
}

SurfaceDistance::Nearest LineVerifier::nearest(Vec3 x, SurfaceDistance::Nearest& last) {
    const auto [entry, is_new] = walls_.try_emplace(x);
    if (is_new) entry->second = distance_.nearest(x, last.point, last.triangle);
    return last = entry->second;
}

double LineVerifier::empty_ball_radius(Vec3 x) {
    const auto [entry, is_new] = balls_.try_emplace(x);
    if (is_new) entry->second = distance_.nearest_vertex(x, std::numeric_limits<double>::infinity());
    return entry->second;
}

bool LineVerifier::segment_inside(Vec3 a, Vec3 b, double clearance_a, double clearance_b, int depth,
                                  SurfaceDistance::Nearest& last) {
    if (distance(a, b) < clearance_a + clearance_b) return true;
    if (depth == 0) return false;
    const Vec3 middle = lerp(a, b, 0.5);
    const double clearance = nearest(middle, last).distance;
    return segment_inside(a, middle, clearance_a, clearance, depth - 1, last) &&
           segment_inside(middle, b, clearance, clearance_b, depth - 1, last);
}

LineCheck LineVerifier::check(const Polyline& line) {
    LineCheck result;
    const auto& first = surface_.triangles.front();
    SurfaceDistance::Nearest last{0, surface_.points[at(first[0])], TriangleId(0)};
    for (std::size_t i = 0; i < line.size(); ++i) {
        const Vec3 x = line.points[i];
        const double r = line.radius[i];
        const SurfaceDistance::Nearest wall = nearest(x, last);
        result.clearance.push_back(wall.distance);
        const auto& t = surface_.triangles[at(wall.triangle)];
        const double rho =
            covering_radius(surface_.points[at(t[0])], surface_.points[at(t[1])], surface_.points[at(t[2])]);
        const double tolerance = 1e-6 * r + 2 * std::min(64 * surface_.coordinate_rounding, 1e-3 * r);
        const double upper = std::sqrt(wall.distance * wall.distance + rho * rho);
        result.ball_excess =
            std::max({result.ball_excess, (wall.distance - r - tolerance) / r, (r - upper - tolerance) / r});
        const bool ok = i == 0
                            ? inside(x, wall.distance)
                            : segment_inside(line.points[i - 1], x, result.clearance[i - 1], wall.distance, 20, last);
        if (result.inside && !ok) {
            result.inside = false;
            result.outside_at = x;
        }
    }
    return result;
}

}  // namespace lumenline
