#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/core/surface.h"

namespace lumenline {

/// Point in the plane of a section [length].
struct PlanePoint {
    double x = 0, y = 0;
};

/// A plane: origin, two unit vectors in it, and its normal, their cross product.
struct SectionPlane {
    Vec3 origin, e1, e2, normal;
};

/// Boundary of the part of the lumen that a plane cuts around its origin.
struct SectionLoop {
    std::vector<PlanePoint> points;  ///< counter-clockwise about the normal; empty = not found
    std::vector<SiteId> nearest;     ///< to each point, of the two sites whose edge it lies on
    SiteId site;                     ///< of the surface, next to it
    bool wall = false;               ///< all of it is wall: no triangle belongs to an extension or cap
};

/// Cuts a closed surface by planes, walking from triangle to triangle. Const use from several threads at once.
class SectionCutter {
public:
    /// @cost O(triangles)
    explicit SectionCutter(const Surface& surface);

    /// The loop around the plane's origin that is reached from `seed` by walking towards the plane; empty where that
    /// gets stuck or comes to a loop that does not go around the origin.
    /// @cost O(triangles on the way and around)
    [[nodiscard]] SectionLoop cut(const SectionPlane& plane, SiteId seed) const;

    /// The same by looking at all triangles: of the loops around the origin the smallest. @cost O(triangles)
    [[nodiscard]] SectionLoop search(const SectionPlane& plane) const;

private:
    using HalfEdge = std::uint32_t;  // 3 t + k: from corner k of triangle t to the next one

    [[nodiscard]] std::size_t from(HalfEdge h) const { return at(surface_.triangles[h / 3][h % 3]); }
    [[nodiscard]] std::size_t to(HalfEdge h) const { return at(surface_.triangles[h / 3][(h % 3 + 1) % 3]); }
    [[nodiscard]] double height(const SectionPlane& plane, std::size_t site) const;
    /// A half-edge that goes down through the plane, near the seed.
    [[nodiscard]] bool find_crossing(const SectionPlane& plane, std::size_t seed, HalfEdge& found) const;
    [[nodiscard]] SectionLoop follow(const SectionPlane& plane, HalfEdge start) const;

    const Surface& surface_;
    std::vector<std::uint32_t> first_;  // (N+1) into leaving_
    std::vector<HalfEdge> leaving_;     // half-edges by the site they start from
    std::vector<HalfEdge> twin_;        // (3M)
};

/// What a loop encloses.
struct SectionMeasures {
    double area = 0, perimeter = 0;             ///< [length^2], [length]
    PlanePoint centroid;                        ///< [length]
    double min_diameter = 0, max_diameter = 0;  ///< chords through the centroid, in steps of five degrees [length]
    double least_width = 0;  ///< least distance of two parallel lines that hold it between them [length]
};
SectionMeasures measure_loop(const std::vector<PlanePoint>& loop);

/// Does the loop go once around the origin, counter-clockwise?
bool surrounds_origin(const std::vector<PlanePoint>& loop);

}  // namespace lumenline
