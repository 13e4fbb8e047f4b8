// The inward normal leaves the site's Voronoi cell where the ball around the point of the ray loses the site's
// monopoly, at the least |e|^2 / (2 e.n) over the other sites, e their offset. For the sites nearby that formula is all
// noise: an error d of the normal changes it by the share 2 d r / |e|, of the first order of the edge at least, so that
// the ray seems to leave through a wall of the narrow cell long before the medial axis, through a polygon that reaches
// the surface and is not in the complex. That is where a twenty-fifth of the rays was lost, and why the largest error
// did not fall. There the fitted curvature bounds the radius; the other sites are used as they are.
// The centre is then brought to the nearest point of the site's polygons, which lie within rounding of it where
// the ray leaves through one, and within the second order of the edge at the rim of a medial sheet.
#include "engine/characterize/medial_ball.h"

#include "engine/geometry/nearest_on_polygon.h"

namespace lumenline {

MedialBalls::MedialBalls(const Surface& surface, const VoronoiComplex& complex)
    : surface_(surface), complex_(complex), fit_(surface), offsets_(surface.site_count() + 1, 0) {
    for (const auto& sites : complex.polygon_sites)
        for (const SiteId s : sites)
            if (!s.is_none()) ++offsets_[at(s) + 1];
    for (std::size_t i = 0; i + 1 < offsets_.size(); ++i) offsets_[i + 1] += offsets_[i];
    polygons_.resize(offsets_.back());
    std::vector<std::uint32_t> next(offsets_.begin(), offsets_.end() - 1);
    for (std::size_t p = 0; p < complex.polygon_count(); ++p)
        for (const SiteId s : complex.polygon_sites[p])
            if (!s.is_none()) polygons_[next[at(s)]++] = PolygonId(p);
}

BallCentre MedialBalls::at_site(SiteId site) {
    const auto polygons = polygons_of(site);
    BallCentre best;
    if (polygons.empty()) return best;
    const LocalShape shape = fit_.at_site(site);
    const Vec3 p = surface_.points[at(site)];
    double inverse = shape.curvature_max;
    PolygonId exit = polygons.front();
    for (const PolygonId q : polygons) {
        const auto [s, t] = complex_.polygon_sites[at(q)];
        const SiteId other = s == site ? t : s;
        if (fit_.is_near(other)) continue;
        const Vec3 e = surface_.points[at(other)] - p;
        const double needed = 2 * dot(e, shape.inward) / squared_norm(e);
        if (!(needed > inverse)) continue;
        inverse = needed;
        exit = q;
    }
    if (!(inverse > 0)) return best;
    const Vec3 x = p + (1 / inverse) * shape.inward;
    best = {nearest_on_polygon(surface_, complex_, exit, x).point, exit};
    double least = squared_norm(best.x - x);
    for (const PolygonId q : polygons) {
        if (q == exit) continue;
        // No point of a polygon is nearer than the plane it lies in, the bisector of its sites.
        const auto [s, t] = complex_.polygon_sites[at(q)];
        const Vec3 e = surface_.points[at(s == site ? t : s)] - p;
        const double length2 = squared_norm(e), height = dot(x - p, e) - 0.5 * length2;
        if (height * height >= least * length2) continue;
        const Vec3 y = nearest_on_polygon(surface_, complex_, q, x).point;
        if (const double d = squared_norm(y - x); d < least) {
            least = d;
            best = {y, q};
        }
    }
    return best;
}

}  // namespace lumenline
