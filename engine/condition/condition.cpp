#include "engine/condition/condition.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include "engine/condition/closing.h"
#include "engine/condition/components.h"
#include "engine/condition/crossing_repair.h"
#include "engine/condition/crossings.h"
#include "engine/condition/decimate.h"
#include "engine/condition/finish.h"
#include "engine/condition/flat_caps.h"
#include "engine/condition/holes.h"
#include "engine/condition/orient.h"
#include "engine/condition/refine.h"
#include "engine/condition/wall_topology.h"
#include "engine/condition/weld.h"
#include "engine/core/text.h"

// The steps in order. Each has its own file; what they hand on is the wall with its loops and
// components, then the plans of the openings, then the closed surface. An extension that passes the
// test for collisions may still cross the wall beside a crooked loop: the test for
// self-intersections finds that, and the opening gets a plain cap. The same test finds sites that refinement
// moved through a wall nearby, which go back onto their triangle, and the wall's own crossings: these are
// repaired in the wall as it was before it was refined, and the rest done again. The findings of an attempt
// that is thrown away are thrown away with it.

namespace lumenline {
namespace {

using CrossingPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

constexpr int kMostAttempts = 4;             // to flatten refined sites that cross something
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
                     " of triangles cross each other, the first at " + short_text(surface.points[at(t[0])]) +
                     ": vessels that touch may be joined there",
                 static_cast<double>(pairs.size()), 0);
}

// Largest coordinate of the vertices that triangles use, per largest of all: the rounding of a file is stated for the
// latter.
double used_extent(const TriangleSoup& soup) {
    const auto largest = [](double so_far, Vec3 p) {
        return std::max({so_far, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    };
    double all = 0, used = 0;
    for (const Vec3& p : soup.points) all = largest(all, p);
    for (const Corners& t : soup.triangles)
        for (const std::uint32_t v : t) used = largest(used, soup.points[v]);
    return all > 0 && std::isfinite(all) ? used / all : 1;
}

WallMesh prepare_wall(const TriangleSoup& soup, const ConditionOptions& options, WallTopology& topology,
                      StageContext& context) {
    WallMesh wall = weld_soup(soup, options.weld_tolerance, options.drop_faces, context);
    context.check_cancelled();
    const std::size_t copies = make_oriented_manifold(wall, options, context);
    context.check_cancelled();
    topology = analyse_wall(wall);
    if (copies > 0) pinch_loops(wall, topology);
    remove_fragments(wall, topology, context);
    remove_specks(wall, topology, options.speck_share, context);
    refuse_loose_triangles(wall, topology);
    select_components(wall, topology, options.components, context);
    turn_outward(wall, topology, options.orient_faces, context);
    if (options.decimate > 0) {
        decimate_wall(wall, options.decimate * bounding_diagonal(wall.points), context);
        topology = analyse_wall(wall);
    }
    return wall;
}

// What a prepared wall becomes: filled, refined, closed.
struct Closing {
    WallMesh wall;
    WallTopology topology;
    Refined refined;
    double edge = 0;
    ClosedSurface closed;
    CrossingPairs crossings;
};

// Closes the openings, again with plain caps where extensions turn out to cross something.
void close_openings(Closing& c, const ConditionOptions& options, StageContext& context) {
    const std::vector<OpeningPlan> plans = plan_openings(c.wall, c.topology.loops);
    std::vector<char> blocked(plans.size(), 0);
    const std::size_t findings = context.diagnostics().size();
    do {
        context.retract(findings, context.diagnostics().size());
        c.closed = close_wall(c.wall, c.topology.component, plans, options.extension_radii, blocked, context);
        c.closed.surface.component_count = static_cast<int>(c.topology.component_count);
        verify_closed(c.closed.surface);
        context.check_cancelled();
        c.crossings = options.check_self_intersections ? find_crossings(c.closed.surface) : CrossingPairs();
    } while (block_crossing_extensions(c.closed.surface, c.crossings, blocked));
}

// Flattens the added sites whose triangles cross others, and `rings` rings around them. @returns whether there are any
bool flatten_crossing_sites(Closing& c, int rings) {
    std::vector<char> marked(c.closed.surface.points.size(), 0);
    for (const auto& pair : c.crossings)
        for (const std::uint32_t t : {pair.first, pair.second})
            for (const SiteId site : c.closed.surface.triangles[t]) marked[at(site)] = 1;
    for (int ring = 0; ring < rings; ++ring) {
        const std::vector<char> inner = marked;
        for (const auto& t : c.closed.surface.triangles)
            if (inner[at(t[0])] || inner[at(t[1])] || inner[at(t[2])])
                for (const SiteId site : t) marked[at(site)] = 1;
    }
    return flatten_points(c.wall, c.refined, std::move(marked));
}

Closing close_prepared(const WallMesh& wall, const WallTopology& topology, const ConditionOptions& options,
                       StageContext& context) {
    Closing c{wall, topology, {}, median_edge(wall), {}, {}};
    if (options.fill_holes) fill_holes(c.wall, c.topology, c.edge, context);
    context.check_cancelled();
    if (options.refine_undersampled) c.refined = refine_undersampled(c.wall, c.topology, context);
    const std::size_t findings = context.diagnostics().size();
    int rings = 0;
    for (int attempt = 0;; ++attempt) {
        context.retract(findings, context.diagnostics().size());
        close_openings(c, options, context);
        if (c.crossings.empty() || attempt == kMostAttempts || !flatten_crossing_sites(c, rings)) return c;
        rings = 2 * rings + 2;  // wider every time; crossings of the wall itself stay, however often
    }
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
    const std::size_t before = context.diagnostics().size();
    Closing c = close_prepared(wall, topology, options, context);
    if (options.repair_self_intersections && !c.crossings.empty()) {
        const std::size_t after = context.diagnostics().size();
        const CrossingPairs pairs = crossing_triangles(wall.points, wall.triangles, kMostPairs);
        if (repair_crossings(wall, topology, pairs, context)) {
            context.retract(before, after);
            c = close_prepared(wall, topology, options, context);
        }
    }

    Surface& surface = c.closed.surface;
    warn_of_crossings(surface, c.crossings, context);
    check_components(surface, c.closed.component, c.topology.component_count, context);
    surface.coordinate_rounding = soup.coordinate_rounding * used_extent(soup);
    surface.diagonal = bounding_diagonal(c.wall.points);
    surface.median_edge = median_edge(c.wall);
    compute_normals(surface, context);
    mark_flat_caps(surface, cap_rims);
    return std::move(surface);
}

}  // namespace lumenline
