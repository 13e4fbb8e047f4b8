#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/ids.h"
#include "engine/core/vec3.h"

namespace lumenline {

/// Exact point-in-surface test for a closed oriented triangle surface.
///
/// Winding number along a ray parallel to the coordinate axis in which the surface is thinnest,
/// with exact predicates and a symbolic perturbation of the point, so that rays through edges and
/// vertices need no special case. A point exactly on the surface may come out either way, always
/// the same way.
/// Keeps references: points and triangles must outlive it.
/// @cost build O(triangles); query O(1) on average: the triangles whose projection covers a cell
class InsideTest {
public:
    InsideTest(std::span<const Vec3> points, std::span<const std::array<SiteId, 3>> triangles);

    /// True where the winding number is positive (union of overlapping parts).
    [[nodiscard]] bool inside(Vec3 p) const;

private:
    struct Extent {
        float low[3];  // u, v, w, rounded outwards
        float high[3];
        std::uint32_t triangle;
    };
    [[nodiscard]] std::size_t cell(double value, int direction) const;

    std::span<const Vec3> points_;
    std::span<const std::array<SiteId, 3>> triangles_;
    int u_ = 0, v_ = 1, w_ = 2;  // axes; the ray runs along +w
    Vec3 low_, high_;
    std::array<std::size_t, 2> cells_{1, 1};
    std::array<double, 2> inverse_width_{0, 0};
    std::vector<std::uint32_t> offsets_;
    std::vector<Extent> entries_;
};

/// The same answer for a single point, without a grid.
/// @cost O(triangles), 3 ns each
bool inside_surface(std::span<const Vec3> points, std::span<const std::array<SiteId, 3>> triangles, Vec3 p);

}  // namespace lumenline
