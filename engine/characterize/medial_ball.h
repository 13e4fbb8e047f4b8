#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/characterize/surface_fit.h"
#include "engine/core/surface.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline {

/// A place on the complex, in one polygon.
struct BallCentre {
    Vec3 x;
    PolygonId polygon;  ///< none = neither the site nor its neighbours have a polygon

    [[nodiscard]] bool found() const { return !polygon.is_none(); }
};

/// The maximal ball that touches the surface at a site.
class MedialBalls {
public:
    /// Keeps references. @cost O(triangles + polygons)
    MedialBalls(const Surface& surface, const VoronoiComplex& complex);

    /// Centre of the ball, brought to the nearest of the site's polygons, or of a neighbour's where none of its own
    /// lies between it and the other side.
    /// @cost 1 us
    BallCentre at_site(SiteId site);

private:
    void gather(SiteId site);
    [[nodiscard]] std::span<const PolygonId> polygons_of(SiteId site) const {
        return {polygons_.data() + offsets_[at(site)], polygons_.data() + offsets_[at(site) + 1]};
    }

    const Surface& surface_;
    const VoronoiComplex& complex_;
    SurfaceFit fit_;
    std::vector<std::uint32_t> offsets_;  ///< (N+1) into polygons_
    std::vector<PolygonId> polygons_;     ///< polygons dual to each site and another
    std::vector<PolygonId> candidates_;   ///< of the last site
};

}  // namespace lumenline
