#include "engine/condition/wall_radius.h"

#include <algorithm>
#include <cmath>

// A shrinking ball: from the largest radius asked for, the ball that touches the triangle's middle from
// inside shrinks until it also touches the nearest point of the wall found within it. The middle of a
// triangle and its own plane are used, not a vertex and its mean normal: at the corner of a tube of few
// sides every ball along the mean normal cuts the two sides next to it, however small it is. What counts is the
// last radius that an opposite wall gave: beside the middle of a flat side, or beside the rim of a flat end, the ball
// shrinks further until it fits into the corner, and that says nothing of the vessel.

namespace lumenline {
namespace {

constexpr double kSlack = 0.02;  // of the radius, within which a ball counts as free
constexpr int kMostSteps = 40;   // of shrinking; a handful is usual
// Between the normals of the two walls; in a tube of five sides -0.81. The other wall's is the way from the centre to
// its nearest point, which is one where triangles meet too.
constexpr double kOppositeCosine = -0.6;

std::vector<std::array<SiteId, 3>> as_sites(const std::vector<Corners>& triangles) {
    std::vector<std::array<SiteId, 3>> sites;
    sites.reserve(triangles.size());
    for (const Corners& t : triangles) sites.push_back({SiteId(t[0]), SiteId(t[1]), SiteId(t[2])});
    return sites;
}

}  // namespace

WallRadius::WallRadius(const WallMesh& wall)
    : wall_(wall), triangles_(as_sites(wall.triangles)), distance_(wall.points, triangles_) {}

Vec3 WallRadius::unit_normal(std::size_t t) const {
    const Corners& c = wall_.triangles[t];
    const Vec3 a = wall_.points[c[0]];
    return normalized(cross(wall_.points[c[1]] - a, wall_.points[c[2]] - a));
}

double WallRadius::at(std::uint32_t t, double largest) const {
    const Corners& c = wall_.triangles[t];
    const Vec3 origin = wall_.points[c[0]];
    const Vec3 p = origin + (1.0 / 3) * ((wall_.points[c[1]] - origin) + (wall_.points[c[2]] - origin));
    const Vec3 outward = unit_normal(t);
    if (outward == Vec3{}) return largest;
    double r = largest, found = largest;
    for (int step = 0; step < kMostSteps; ++step) {
        const Vec3 centre = p - r * outward;
        const auto nearest = distance_.nearest(centre, p, TriangleId(std::size_t{t}));
        if (nearest.distance >= (1 - kSlack) * r) return found;
        const Vec3 d = nearest.point - p;
        const double depth = -dot(d, outward);
        if (!(depth > 0)) return found;
        r = std::min((1 - kSlack / 2) * r, squared_norm(d) / (2 * depth));
        const Vec3 way = nearest.point - centre;
        const double side = dot(way, unit_normal(lumenline::at(nearest.triangle))) < 0 ? -1 : 1;  // -1 = from outside
        if (side * dot(outward, way) < kOppositeCosine * nearest.distance) found = r;
    }
    return found;
}

}  // namespace lumenline
