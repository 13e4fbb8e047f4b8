#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/core/ids.h"
#include "engine/core/vec3.h"

namespace lumenline {

/// Where a site comes from.
enum class SiteOrigin : std::uint8_t { kWall = 0, kExtension = 1, kCap = 2 };

/// An opening of the lumen: a boundary loop of the input, extended along the vessel and capped.
struct Opening {
    Vec3 point;                   ///< area centroid of the loop in its best-fit plane [length]
    Vec3 normal;                  ///< unit, of that plane, out of the lumen
    Vec3 axis;                    ///< unit, of the extension, out of the lumen; the normal if it was cut across
    double radius = 0;            ///< of the circle of the loop's area [length]
    double extension_length = 0;  ///< how far the lumen was extended beyond the point; 0 = plain cap [length]
    std::vector<SiteId> loop;     ///< the boundary sites, in order around the opening
    bool flat_cap = false;        ///< the input had a flat cap here, which was taken off
};

/// Closed, oriented, manifold triangle surface of a lumen, with outward orientation.
/// Sites are its vertices; the wall's sites come first.
struct Surface {
    std::vector<Vec3> points;                      ///< (N) sites [length]
    std::vector<std::array<SiteId, 3>> triangles;  ///< (M) counter-clockwise seen from outside
    std::vector<Vec3> normals;                     ///< (N) unit outward, angle-weighted
    std::vector<std::uint32_t> input_vertex;       ///< (N) vertex of the input; Index::kNoneValue = added
    std::vector<SiteOrigin> origin;                ///< (N)
    std::vector<OpeningId> cap;                    ///< (M) opening whose extension or cap it is; none = wall
    std::vector<Opening> openings;
    double coordinate_rounding = 0;  ///< as TriangleSoup, in this surface's unit [length]
    double diagonal = 0;             ///< of the bounding box of the wall [length]
    double median_edge = 0;          ///< of the wall [length]
    int genus = 0;                   ///< handles, summed over components
    int component_count = 1;

    [[nodiscard]] std::size_t site_count() const { return points.size(); }
};

}  // namespace lumenline
