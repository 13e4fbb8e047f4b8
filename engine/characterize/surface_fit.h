#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/surface.h"
#include "engine/geometry/site_neighbours.h"

namespace lumenline {

/// The surface around a site to second order.
struct LocalShape {
    Vec3 inward;               ///< unit normal into the lumen
    double curvature_max = 0;  ///< largest normal curvature, positive where the lumen is convex [1/length]
};

/// Fits z = a u + b v + (c u^2 + 2 d u v + e v^2) / 2 through each site to its two rings of neighbours, by
/// least squares. Vertex normals taken from triangles are wrong to first order of the edge on irregular meshes, those
/// of the quadric to second order; spheres are met exactly.
class SurfaceFit {
public:
    /// Keeps references; one per thread. @cost O(sites)
    SurfaceFit(const Surface& surface, const SiteNeighbours& ring);

    /// @returns the vertex normal without curvature where the neighbours do not determine a quadric
    /// @cost 0.5 us
    LocalShape at_site(SiteId site);

    /// Sites of the two rings of the last at_site, itself included.
    [[nodiscard]] bool is_near(SiteId site) const { return stamp_[at(site)] == turn_; }

    /// Sites joined to it by an edge, and those joined to these.
    [[nodiscard]] std::span<const SiteId> first_ring() const { return std::span(near_).first(first_ring_); }
    [[nodiscard]] std::span<const SiteId> second_ring() const { return std::span(near_).subspan(first_ring_); }

private:
    void gather(SiteId site);

    const Surface& surface_;
    const SiteNeighbours& ring_;
    std::vector<std::uint32_t> stamp_;
    std::uint32_t turn_ = 0;
    std::vector<SiteId> near_;  ///< of the last site, without itself: its first ring, then the second
    std::size_t first_ring_ = 0;
};

}  // namespace lumenline
