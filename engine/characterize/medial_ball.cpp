#include "engine/characterize/medial_ball.h"

#include <limits>

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
    // The curvature speaks for the neighbours, the bisectors for all others.
    double inverse = shape.curvature_max > 0 ? shape.curvature_max : 0;
    for (const PolygonId q : polygons) {
        const auto [s, t] = complex_.polygon_sites[at(q)];
        const SiteId other = s == site ? t : s;
        if (fit_.is_near(other)) continue;
        const Vec3 e = surface_.points[at(other)] - p;
        const double inv = 2 * dot(e, shape.inward) / squared_norm(e);
        if (inv > inverse) inverse = inv;
    }
    if (!(inverse > 0)) return best;
    const Vec3 x = p + (1 / inverse) * shape.inward;
    double least = std::numeric_limits<double>::infinity();
    for (const PolygonId q : polygons) {
        const Vec3 y = nearest_on_polygon(surface_, complex_, q, x).point;
        if (const double d = squared_norm(y - x); d < least) {
            least = d;
            best = {y, q};
        }
    }
    return best;
}

}  // namespace lumenline
