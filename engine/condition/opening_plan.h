#pragma once

#include <optional>
#include <vector>

#include "engine/condition/planar.h"
#include "engine/condition/wall_mesh.h"
#include "engine/core/surface.h"

namespace lumenline {

/// One opening, measured, before it is closed.
struct OpeningPlan {
    Loop loop;
    std::vector<Vec3> corners;  ///< of the loop
    Frame frame;                ///< origin = area centroid in the best-fit plane, normal out of the lumen
    Vec3 axis;                  ///< unit: the vessel's direction, or the normal where they differ little
    double radius = 0;          ///< of the circle of the loop's area [length]
    double edge = 0;  ///< mean edge of the wall near the loop, within a factor three of the loop's own [length]
    std::vector<Vec2> outline;    ///< the loop projected, counter-clockwise
    std::vector<double> heights;  ///< of the loop above the plane
    double highest = 0;           ///< greatest of `heights`
    std::uint32_t seed = 0;       ///< for displacements: its place in the order of openings
};

/// Measures all openings. Descending order of area; equal areas by position, so that the order does not
/// depend on the order of triangles.
/// @throws StageError kOpenBoundary for a loop that encloses no area
std::vector<OpeningPlan> plan_openings(const WallMesh& wall, const std::vector<Loop>& loops);

/// The opening as seen along its axis: an extension of this plan continues the vessel where it was cut obliquely.
OpeningPlan along_axis(const OpeningPlan& plan);

/// Rings along the normal to `length` above the highest loop vertex, the last planar, and a refined cap.
/// @returns nothing when no ring along the loop is a simple polygon
std::optional<Patch> extend_opening(const OpeningPlan& plan, double length);

/// Refined cap at the loop itself. @returns nothing when the projected loop is not a simple polygon
std::optional<Patch> cap_opening(const OpeningPlan& plan);

}  // namespace lumenline
