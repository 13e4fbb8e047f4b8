#include "engine/condition/closing.h"

#include <cstddef>
#include <string>
#include <utility>

#include "engine/condition/cap.h"
#include "engine/condition/cgal_repair.h"
#include "engine/condition/collision.h"
#include "engine/core/text.h"

// Openings are closed in their order, largest first, and each accepted extension is an obstacle to
// the following ones: of two that face each other the larger keeps its length.

namespace lumenline {
namespace {

constexpr std::size_t kMostSites = (std::size_t{1} << 31) / 3;  // half-edges are numbered too

struct Closing {
    Patch patch;
    double extension_length = 0;
    Vec3 axis;
};

std::string name_of(const OpeningPlan& plan) {
    return "the opening of " + counted(plan.corners.size(), "edge") + " at " + short_text(plan.frame.origin);
}

Closing close_plainly(const OpeningPlan& plan, StageContext& context) {
    if (auto patch = cap_opening(plan)) return {std::move(*patch), 0, plan.frame.normal};
    auto patch = triangulate_loop(plan.corners, true);
    if (!patch)
        refuse(ErrorCode::kOpenBoundary, name_of(plan) + " crosses itself and cannot be capped; repair its edge");
    context.warn("crooked_opening",
                 name_of(plan) +
                     " overlaps itself seen along its normal and was capped without an extension: cut the vessel's end "
                     "anew, across it",
                 static_cast<double>(plan.corners.size()));
    return {std::move(*patch), 0, plan.frame.normal};
}

Closing close_opening(const OpeningPlan& plan, double wanted, bool blocked, const Obstacles& obstacles,
                      StageContext& context) {
    if (wanted <= 0 || !is_simple_polygon(plan.outline)) return close_plainly(plan, context);
    const OpeningPlan seen = along_axis(plan);
    for (const double share : {1.0, 0.5}) {
        if (blocked || obstacles.in_the_way(seen, share * wanted)) continue;
        auto patch = extend_opening(seen, share * wanted);
        if (!patch) {
            context.warn("crooked_opening",
                         name_of(plan) +
                             " has an edge too uneven for an extension and was capped without one: cut the vessel's "
                             "end anew, across it",
                         static_cast<double>(plan.corners.size()));
            return close_plainly(plan, context);
        }
        if (share < 1)
            context.warn("extension_shortened",
                         "something lies before " + name_of(plan) + ", which was extended by half the usual length",
                         share * wanted, wanted);
        return {std::move(*patch), seen.highest + share * wanted, seen.axis};
    }
    context.warn("extension_blocked",
                 "something lies close before " + name_of(plan) +
                     ", which was capped without an extension: results within one radius of it are less accurate",
                 0, wanted);
    return close_plainly(plan, context);
}

ClosedSurface copy_wall(const WallMesh& wall, const std::vector<std::uint32_t>& component) {
    ClosedSurface closed;
    Surface& surface = closed.surface;
    surface.points = wall.points;
    surface.input_vertex = wall.input_vertex;
    surface.origin.assign(wall.points.size(), SiteOrigin::kWall);
    surface.triangles.reserve(wall.triangles.size());
    for (const Corners& t : wall.triangles) surface.triangles.push_back({SiteId(t[0]), SiteId(t[1]), SiteId(t[2])});
    surface.cap.assign(wall.triangles.size(), OpeningId());
    closed.component = component;
    return closed;
}

void append_patch(ClosedSurface& closed, const Loop& loop, const Patch& patch, OpeningId opening) {
    Surface& surface = closed.surface;
    const std::size_t first = surface.points.size();
    if (first + patch.points.size() > kMostSites)
        refuse(ErrorCode::kTooLarge, "the surface with its extensions has more than " + std::to_string(kMostSites) +
                                         " sites, more than 32-bit indices hold; coarsen it");
    surface.points.insert(surface.points.end(), patch.points.begin(), patch.points.end());
    surface.input_vertex.resize(surface.points.size(), SiteId::kNoneValue);
    surface.origin.resize(first + patch.extension_points, SiteOrigin::kExtension);
    surface.origin.resize(surface.points.size(), SiteOrigin::kCap);
    closed.component.resize(surface.points.size(), closed.component[loop.front()]);
    const auto site = [&](std::uint32_t v) { return SiteId(v < loop.size() ? loop[v] : first + v - loop.size()); };
    for (const Corners& t : patch.triangles) surface.triangles.push_back({site(t[0]), site(t[1]), site(t[2])});
    surface.cap.resize(surface.triangles.size(), opening);
}

}  // namespace

ClosedSurface close_wall(const WallMesh& wall, const std::vector<std::uint32_t>& component,
                         const std::vector<OpeningPlan>& plans, double extension_radii,
                         const std::vector<char>& blocked, StageContext& context) {
    ClosedSurface closed = copy_wall(wall, component);
    Obstacles obstacles(wall, plans);
    for (std::size_t i = 0; i < plans.size(); ++i) {
        const OpeningPlan& plan = plans[i];
        const Closing closing = close_opening(plan, extension_radii * plan.radius, blocked[i] != 0, obstacles, context);
        obstacles.add(plan, closing.patch);
        append_patch(closed, plan.loop, closing.patch, OpeningId(i));
        Opening opening{plan.frame.origin, plan.frame.normal, closing.axis, plan.radius, closing.extension_length, {}};
        for (const std::uint32_t v : plan.loop) opening.loop.emplace_back(v);
        closed.surface.openings.push_back(std::move(opening));
    }
    return closed;
}

}  // namespace lumenline
