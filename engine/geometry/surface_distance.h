#pragma once

#include <array>
#include <memory>
#include <span>

#include "engine/core/ids.h"
#include "engine/core/vec3.h"

namespace lumenline {

/// Distance to a triangle surface, by a tree of bounding boxes.
/// @cost build O(n log n); query O(log n) with a close hint
class SurfaceDistance {
public:
    struct Nearest {
        double distance = 0;  ///< [length]
        Vec3 point;           ///< on the surface
        TriangleId triangle;
    };

    SurfaceDistance(std::span<const Vec3> points, std::span<const std::array<SiteId, 3>> triangles);
    ~SurfaceDistance();
    SurfaceDistance(const SurfaceDistance&) = delete;
    SurfaceDistance& operator=(const SurfaceDistance&) = delete;

    /// @param hint a point on `hint_triangle`; the closer to the answer, the faster
    [[nodiscard]] Nearest nearest(Vec3 p, Vec3 hint, TriangleId hint_triangle) const;

    /// Distance to the nearest vertex of a triangle: the radius of the largest ball around p that holds no site.
    /// @param within  no less than it, as the distance to any vertex [length]
    [[nodiscard]] double nearest_vertex(Vec3 p, double within) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

/// Bounds how far an empty ball can reach beyond a triangle [length]: the largest distance, within
/// the triangle, from a point to its nearest corner, and, on an edge, to the nearer of its two ends.
/// With c the distance from x to the triangle's nearest point and no corner within R of x,
/// R^2 <= c^2 + covering_radius^2.
double covering_radius(Vec3 a, Vec3 b, Vec3 c);

}  // namespace lumenline
