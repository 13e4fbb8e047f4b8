#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/core/surface.h"
#include "engine/geometry/quadric_fit.h"
#include "engine/geometry/surface_distance.h"

namespace lumenline {

/// Point of a curved surface with its first and second derivatives.
struct SurfaceFoot {
    Vec3 point;
    Vec3 normal;                        ///< unit, out of the lumen
    std::array<Vec3, 2> directions;     ///< unit principal directions, perpendicular to `normal`
    std::array<double, 2> curvature{};  ///< along them; positive where the lumen is convex [1/length]
    std::array<double, 3> weight{};     ///< barycentric, of the triangle's corners
    TriangleId triangle;                ///< whose patch it is on
};

/// Smooth surface through the sites of a surface, as curved patches over its triangles.
///
/// Through every site passes a quadric fitted to its two rings of neighbours; the patch of a triangle
/// blends the quadrics of its corners with the barycentric weights. Cylinders, cones, spheres and
/// ellipsoids are met exactly, other smooth surfaces to fourth order of the edge in most cases, third at worst.
/// Each quadric is held against its neighbours by leaving each of them out in turn: where it predicts
/// them no better than a plane does, as across sharp edges and in noise, the facets stay flat. Wall,
/// extensions and caps are fitted apart; caps are flat. Patches meet without gaps, nearly without kinks.
///
/// Quadrics are fitted when they are first asked for: a surface serves one thread.
class CurvedSurface {
public:
    /// Keeps references: surface and distance must outlive it. @cost O(triangles)
    CurvedSurface(const Surface& surface, const SurfaceDistance& flat);

    /// The point nearest to x among the patches downhill from a start on the flat surface.
    /// Every foot is a point of the surface, so its distance bounds the distance to the surface from above.
    /// @cost 1 us, and 2 us for each quadric not fitted before
    [[nodiscard]] SurfaceFoot foot(Vec3 x, Vec3 start, TriangleId triangle);

    /// The same from the nearest point of the flat surface.
    /// @param hint a point on the flat `hint_triangle`, as SurfaceDistance::nearest
    [[nodiscard]] SurfaceFoot nearest(Vec3 x, Vec3 hint, TriangleId hint_triangle);

    /// How far the surface is expected to be off at a foot: root mean square of its sites' heights above
    /// where their neighbours would put them [length].
    [[nodiscard]] double uncertainty(const SurfaceFoot& foot);

    /// The same heights of the corners of a foot's facet, signed; zero on caps [length].
    [[nodiscard]] std::array<double, 3> corner_offsets(const SurfaceFoot& foot);

    [[nodiscard]] const Surface& surface() const { return surface_; }
    [[nodiscard]] const SurfaceDistance& flat() const { return flat_; }
    [[nodiscard]] std::size_t fitted_count() const { return quadrics_.size(); }

private:
    enum class Part : std::uint8_t { kWall, kExtension, kCap };

    /// Barycentric place on a facet.
    struct Place {
        std::uint32_t triangle = 0;
        std::array<double, 3> weight{};
    };

    [[nodiscard]] std::uint32_t quadric(std::uint32_t triangle, int corner);
    [[nodiscard]] Quadric fit(SiteId site, Part part);
    [[nodiscard]] SurfaceFoot evaluate(const Place& place);
    [[nodiscard]] Place locate(Vec3 p, std::uint32_t triangle) const;
    [[nodiscard]] std::uint32_t neighbour(std::uint32_t triangle, int opposite_corner) const;
    [[nodiscard]] Vec3 corner(std::uint32_t triangle, int k) const {
        return surface_.points[at(surface_.triangles[triangle][static_cast<std::size_t>(k)])];
    }

    const Surface& surface_;
    const SurfaceDistance& flat_;
    std::vector<Part> part_;                           // per triangle
    std::vector<std::uint32_t> offsets_;               // per site, into around_
    std::vector<std::uint32_t> around_;                // triangles around each site
    std::vector<std::array<std::uint32_t, 2>> known_;  // per site: its quadric on the wall, on an extension
    std::vector<Quadric> quadrics_;
    std::vector<SiteId> ring_;       // scratch: neighbours of the site at hand
    std::vector<Vec3> ring_offset_;  // scratch: where they are, from the site
};

}  // namespace lumenline
