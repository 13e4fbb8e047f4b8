#include "engine/condition/condition.h"

#include <cassert>
#include <functional>
#include <string>
#include <utility>

#include "engine/condition/closing.h"
#include "engine/condition/components.h"
#include "engine/condition/crossings.h"
#include "engine/condition/finish.h"
#include "engine/condition/flat_caps.h"
#include "engine/condition/holes.h"
#include "engine/condition/orient.h"
#include "engine/condition/wall_topology.h"
#include "engine/condition/weld.h"
#include "engine/core/text.h"

// The steps in order. Each has its own file; what they hand on is the wall with its loops and
// components, then the plans of the openings, then the closed surface. An extension that passes the
// test for collisions may still cross the wall beside a crooked loop: the test for
// self-intersections finds that, and the opening gets a plain cap.

namespace lumenline {
namespace {

using CrossingPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

constexpr std::size_t kMostPairs = 1000000;  // of crossing triangles, to bound memory on hopeless input

CrossingPairs find_crossings(const Surface& surface) {
    std::vector<Corners> triangles;
    triangles.reserve(surface.triangles.size());
    for (const auto& t : surface.triangles) triangles.push_back({t[0].value, t[1].value, t[2].value});
    return crossing_triangles(surface.points, triangles, kMostPairs);
}

// Marks the openings whose extension crosses something. @returns whether there is a new one
bool block_crossing_extensions(const Surface& surface, const CrossingPairs& pairs, std::vector<char>& blocked) {
    bool changed = false;
    for (const auto& [a, b] : pairs) {
        for (const std::uint32_t t : {a, b}) {
            const OpeningId opening = surface.cap[t];
            if (opening.is_none() || surface.openings[at(opening)].extension_length == 0) continue;
            changed |= !blocked[at(opening)];
            blocked[at(opening)] = 1;
        }
    }
    return changed;
}

void warn_of_crossings(const Surface& surface, const CrossingPairs& pairs, StageContext& context) {
    if (pairs.empty()) return;
    const auto& t = surface.triangles[pairs.front().first];
    context.warn("self_intersections",
                 counted(pairs.size(), "pair") + (pairs.size() < kMostPairs ? "" : " or more") +
                     " of triangles cross each other, the first at " + short_text(surface.points[at(t[0])]),
                 static_cast<double>(pairs.size()), 0);
}

// Closes the openings, again with plain caps where extensions turn out to cross something. The
// warnings of a closing that is thrown away are thrown away with it.
ClosedSurface close_without_crossings(
    const std::function<ClosedSurface(const std::vector<char>& blocked, StageContext& draft)>& close,
    std::size_t openings, bool check, StageContext& context) {
    std::vector<char> blocked(openings, 0);
    while (true) {
        StageContext draft(context.stage());
        ClosedSurface closed = close(blocked, draft);
        context.check_cancelled();
        const CrossingPairs pairs = check ? find_crossings(closed.surface) : CrossingPairs();
        if (block_crossing_extensions(closed.surface, pairs, blocked)) continue;
        for (const Diagnostic& d : draft.diagnostics()) context.warn(d.code, d.message, d.value, d.limit);
        warn_of_crossings(closed.surface, pairs, context);
        return closed;
    }
}

WallMesh prepare_wall(const TriangleSoup& soup, const ConditionOptions& options, WallTopology& topology,
                      StageContext& context) {
    WallMesh wall = weld_soup(soup, options.weld_tolerance, context);
    context.check_cancelled();
    const std::size_t copies = make_oriented_manifold(wall, context);
    context.check_cancelled();
    topology = analyse_wall(wall);
    if (copies > 0) pinch_loops(wall, topology);
    remove_fragments(wall, topology, context);
    refuse_loose_triangles(wall, topology);
    turn_outward(wall, topology, context);
    return wall;
}

}  // namespace

Surface condition_surface(const TriangleSoup& soup, const ConditionOptions& options, StageContext& context) {
    assert(options.weld_tolerance >= 0 && options.extension_radii >= 0);
    WallTopology topology;
    WallMesh wall = prepare_wall(soup, options, topology, context);
    std::vector<Vec3> cap_rims;
    if (options.flat_caps == FlatCaps::kOpen ||
        (options.flat_caps == FlatCaps::kOpenIfClosed && has_no_opening(topology)))
        cap_rims = open_flat_caps(wall, topology, soup, context);
    context.check_cancelled();
    const double edge = median_edge(wall);
    const std::vector<FilledHole> holes = fill_tiny_holes(wall, edge, topology.loops, context);
    const std::vector<OpeningPlan> plans = plan_openings(wall, topology.loops);

    ClosedSurface closed = close_without_crossings(
        [&](const std::vector<char>& blocked, StageContext& draft) {
            ClosedSurface trial =
                close_wall(wall, topology.component, holes, plans, options.extension_radii, blocked, draft);
            trial.surface.component_count = static_cast<int>(topology.component_count);
            verify_closed(trial.surface);
            return trial;
        },
        plans.size(), options.check_self_intersections, context);

    Surface& surface = closed.surface;
    check_components(surface, closed.component, topology.component_count, context);
    surface.coordinate_rounding = soup.coordinate_rounding;
    surface.diagonal = bounding_diagonal(wall.points);
    surface.median_edge = edge;
    compute_normals(surface, context);
    mark_flat_caps(surface, cap_rims);
    return std::move(surface);
}

}  // namespace lumenline
