// The inward normal leaves the site's Voronoi cell where the ball around the point of the ray loses the site's
// monopoly, at the least |e|^2 / (2 e.n) over the other sites, e their offset. For the sites nearby that formula is all
// noise: an error d of the normal changes it by the share 2 d r / |e|, of the first order of the edge at least, so that
// the ray seems to leave through a wall of the narrow cell long before the medial axis, through a polygon that reaches
// the surface and is not in the complex. That is where a twenty-fifth of the rays was lost, and why the largest error
// did not fall. There the fitted curvature bounds the radius; the other sites are used as they are.
// The centre is then brought to the nearest point of the site's polygons, which lie within rounding of it where
// the ray leaves through one, and within the second order of the edge at the rim of a medial sheet.
// A site in the trough of a noisy wall touches no such ball: all its polygons, if it has any, lie between it and its
// neighbours. It borrows those of its neighbours that lead across; on real surfaces one site in four has to.
#include "engine/characterize/medial_ball.h"

#include <algorithm>
#include <iterator>

#include "engine/geometry/nearest_on_polygon.h"

namespace lumenline {

SiteSurroundings::SiteSurroundings(const Surface& surface, const VoronoiComplex& complex)
    : neighbours_(surface), offsets_(surface.site_count() + 1, 0) {
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

MedialBalls::MedialBalls(const Surface& surface, const VoronoiComplex& complex, const SiteSurroundings& around)
    : surface_(surface), complex_(complex), around_(around), fit_(surface, around.neighbours()) {}

void MedialBalls::gather(SiteId site) {
    candidates_.assign(around_.polygons_of(site).begin(), around_.polygons_of(site).end());
    const auto leads_across = [&](PolygonId q) {
        const auto [s, t] = complex_.polygon_sites[at(q)];
        return !fit_.is_near(s) || !fit_.is_near(t);
    };
    if (std::any_of(candidates_.begin(), candidates_.end(), leads_across)) return;
    const std::size_t own = candidates_.size();
    for (const auto ring : {fit_.first_ring(), fit_.second_ring()}) {
        for (const SiteId neighbour : ring)
            std::ranges::copy_if(around_.polygons_of(neighbour), std::back_inserter(candidates_), leads_across);
        if (candidates_.size() > own) return;
    }
}

BallCentre MedialBalls::at_site(SiteId site) {
    const LocalShape shape = fit_.at_site(site);
    gather(site);
    BallCentre best;
    if (candidates_.empty()) return best;
    const Vec3 p = surface_.points[at(site)];
    double inverse = shape.curvature_max;
    PolygonId exit = candidates_.front();
    for (const PolygonId q : candidates_)
        for (const SiteId other : complex_.polygon_sites[at(q)]) {
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
    for (const PolygonId q : candidates_) {
        if (q == exit) continue;
        // No point of a polygon is nearer than the plane it lies in, the bisector of its sites.
        const auto [s, t] = complex_.polygon_sites[at(q)];
        const Vec3 a = surface_.points[at(s)], b = surface_.points[at(t)], e = b - a;
        const double height = dot(x - 0.5 * (a + b), e);
        if (height * height >= least * squared_norm(e)) continue;
        const Vec3 y = nearest_on_polygon(surface_, complex_, q, x).point;
        if (const double d = squared_norm(y - x); d < least) {
            least = d;
            best = {y, q};
        }
    }
    return best;
}

}  // namespace lumenline
