#pragma once

#include <cstdint>
#include <vector>

#include "engine/condition/wall_mesh.h"
#include "engine/core/ids.h"
#include "engine/geometry/surface_distance.h"

namespace lumenline {

/// Local radius of the vessel before there is a Voronoi diagram: of the ball inside that touches the wall
/// at the middle of a triangle and, on the other side, the opposite wall. Needs outward orientation.
class WallRadius {
public:
    /// @cost builds a tree of boxes, O(n log n)
    explicit WallRadius(const WallMesh& wall);

    /// Radius at triangle `t` [length]: below `largest` where the opposite wall is that near, else `largest`.
    /// A wall that the ball meets at less than about a right angle, as beside the rim of a flat end, does
    /// not count as opposite. @cost some queries of the tree, one where the vessel is wide
    [[nodiscard]] double at(std::uint32_t t, double largest) const;

private:
    [[nodiscard]] Vec3 unit_normal(std::size_t t) const;

    const WallMesh& wall_;
    std::vector<std::array<SiteId, 3>> triangles_;
    SurfaceDistance distance_;
};

}  // namespace lumenline
