#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/characterize/surface_fit.h"
#include "engine/core/surface.h"
#include "engine/core/voronoi_complex.h"
#include "engine/geometry/site_neighbours.h"

namespace lumenline {

/// A place on the complex, in one polygon.
struct BallCentre {
    Vec3 x;
    PolygonId polygon;  ///< none = neither the site nor its neighbours have a polygon

    [[nodiscard]] bool found() const { return !polygon.is_none(); }
};

/// What lies around each site: the sites joined to it by an edge, and the polygons dual to it and another.
class SiteSurroundings {
public:
    /// @cost O(triangles + polygons)
    SiteSurroundings(const Surface& surface, const VoronoiComplex& complex);

    [[nodiscard]] const SiteNeighbours& neighbours() const { return neighbours_; }
    [[nodiscard]] std::span<const PolygonId> polygons_of(SiteId site) const {
        return {polygons_.data() + offsets_[at(site)], polygons_.data() + offsets_[at(site) + 1]};
    }

private:
    SiteNeighbours neighbours_;
    std::vector<std::uint32_t> offsets_;  ///< (N+1) into polygons_
    std::vector<PolygonId> polygons_;
};

/// The maximal ball that touches the surface at a site.
class MedialBalls {
public:
    /// Keeps references; one per thread. @cost O(sites)
    MedialBalls(const Surface& surface, const VoronoiComplex& complex, const SiteSurroundings& around);

    /// Centre of the ball, brought to the nearest of the site's polygons, or of a neighbour's where none of its own
    /// lies between it and the other side.
    /// @cost 1 us
    BallCentre at_site(SiteId site);

private:
    void gather(SiteId site);

    const Surface& surface_;
    const VoronoiComplex& complex_;
    const SiteSurroundings& around_;
    SurfaceFit fit_;
    std::vector<PolygonId> candidates_;  ///< of the last site
};

}  // namespace lumenline
