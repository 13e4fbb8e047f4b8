#include "engine/condition/components.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/condition/cgal_repair.h"
#include "engine/core/text.h"

// Volumes are sums of tetrahedra over a vertex of the component, not over the origin: a model far
// from the origin would otherwise lose all digits of its volume. A component that was never welded
// (a cube of loose squares, the lid of a tube) can be capped into a closed manifold of two-sided
// sheets; its boundary, long for its number of edges, and its hole, as large as itself, give it away.

namespace lumenline {
namespace {

constexpr double kMostBoundary = 0.1;   // share of a component's edges
constexpr double kMostScraps = 0.05;    // of the whole area, all scraps together; more is a surface never joined
constexpr double kSheetArea = 0.9;      // area of the hole per area of the component
constexpr double kLeastVolume = 1e-12;  // per cube of the component's diagonal; a tube 1e6 times as long as wide

struct ComponentFacts {
    Vec3 anchor;
    std::size_t triangles = 0, boundary_edges = 0, loops = 0;
    double area = 0, volume = 0;
    double hole_area = 0;
    [[nodiscard]] double boundary_share() const {
        const auto edges = static_cast<double>(3 * triangles + boundary_edges) / 2;
        return static_cast<double>(boundary_edges) / edges;
    }
};

std::vector<ComponentFacts> triangle_facts(const std::vector<Vec3>& points, const std::vector<Corners>& triangles,
                                           const std::vector<std::uint32_t>& component, std::uint32_t count) {
    std::vector<ComponentFacts> facts(count);
    for (const Corners& t : triangles) {
        ComponentFacts& c = facts[component[t[0]]];
        if (c.triangles++ == 0) c.anchor = points[t[0]];
        const Vec3 doubled = cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
        c.area += norm(doubled) / 2;
        c.volume += dot(points[t[0]] - c.anchor, doubled) / 6;
    }
    return facts;
}

std::vector<ComponentFacts> wall_facts(const WallMesh& wall, const WallTopology& topology) {
    std::vector<ComponentFacts> facts =
        triangle_facts(wall.points, wall.triangles, topology.component, topology.component_count);
    for (const Loop& loop : topology.loops) {
        ComponentFacts& c = facts[topology.component[loop.front()]];
        c.boundary_edges += loop.size();
        ++c.loops;
        const Vec3 origin = wall.points[loop.front()];
        Vec3 doubled;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec3 a = wall.points[loop[i]], b = wall.points[loop[(i + 1) % loop.size()]];
            const Vec3 part = cross(a - origin, b - origin);
            doubled += part;
            c.volume += dot(origin - c.anchor, part) / 6;
        }
        c.hole_area += norm(doubled) / 2;
    }
    return facts;
}

double total_area(const std::vector<ComponentFacts>& facts) {
    double area = 0;
    for (const ComponentFacts& c : facts) area += c.area;
    return area;
}

struct Removed {
    std::size_t components = 0, triangles = 0;
    Vec3 position;  ///< a point of the first
};

Removed keep_components(WallMesh& wall, WallTopology& topology, const std::vector<ComponentFacts>& facts,
                        const std::vector<char>& keep) {
    std::vector<std::uint32_t> renumbered(facts.size(), kDropped);
    std::uint32_t kept = 0;
    Removed removed;
    for (std::size_t i = 0; i < facts.size(); ++i) {
        if (keep[i]) {
            renumbered[i] = kept++;
            continue;
        }
        if (removed.components++ == 0) removed.position = facts[i].anchor;
        removed.triangles += facts[i].triangles;
    }
    if (removed.components == 0) return removed;
    const auto is_gone = [&](std::uint32_t v) { return renumbered[topology.component[v]] == kDropped; };
    std::erase_if(wall.triangles, [&](const Corners& t) { return is_gone(t[0]); });
    std::erase_if(topology.loops, [&](const Loop& loop) { return is_gone(loop[0]); });
    std::vector<std::uint32_t> component;
    for (const std::uint32_t c : topology.component)
        if (renumbered[c] != kDropped) component.push_back(renumbered[c]);
    const std::vector<std::uint32_t> site = drop_unused_vertices(wall);
    for (Loop& loop : topology.loops)
        for (std::uint32_t& v : loop) v = site[v];
    topology.component = std::move(component);
    topology.component_count = kept;
    return removed;
}

std::string percent(double share) { return short_text(100 * share) + " %"; }

std::vector<Corners> triangles_of(const Surface& surface, const std::vector<std::uint32_t>& component,
                                  std::uint32_t wanted) {
    std::vector<Corners> triangles;
    for (const auto& t : surface.triangles)
        if (component[at(t[0])] == wanted) triangles.push_back({t[0].value, t[1].value, t[2].value});
    return triangles;
}

struct Box {
    Vec3 low, high;
    bool empty = true;
    void include(Vec3 p) {
        if (empty) low = high = p;
        empty = false;
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    }
    [[nodiscard]] bool contains(const Box& b) const {
        return low.x <= b.low.x && low.y <= b.low.y && low.z <= b.low.z && high.x >= b.high.x && high.y >= b.high.y &&
               high.z >= b.high.z;
    }
};

void refuse_nested(const Surface& surface, const std::vector<std::uint32_t>& component,
                   const std::vector<ComponentFacts>& facts, const std::vector<Box>& boxes) {
    for (std::uint32_t outer = 0; outer < facts.size(); ++outer) {
        std::vector<Vec3> queries;
        for (std::size_t inner = 0; inner < facts.size(); ++inner)
            if (inner != outer && boxes[outer].contains(boxes[inner])) queries.push_back(facts[inner].anchor);
        if (queries.empty()) continue;
        WallMesh part{surface.points, triangles_of(surface, component, outer), surface.input_vertex};
        drop_unused_vertices(part);
        const std::vector<char> inside = inside_closed_mesh(part.points, part.triangles, queries);
        for (std::size_t q = 0; q < queries.size(); ++q)
            if (inside[q])
                refuse(ErrorCode::kNestedComponents,
                       "the component at " + short_text(queries[q]) + " lies inside the component at " +
                           short_text(facts[outer].anchor) + "; give the lumen's surface alone");
    }
}

}  // namespace

void remove_fragments(WallMesh& wall, WallTopology& topology, StageContext& context) {
    const std::vector<ComponentFacts> facts = wall_facts(wall, topology);
    const double area = total_area(facts);
    double scraps = 0;
    const auto is_scrap = [&](const ComponentFacts& c) {
        return c.boundary_share() > kMostBoundary && c.area < kMostScraps * area;
    };
    for (const ComponentFacts& c : facts) scraps += is_scrap(c) ? c.area : 0;
    if (scraps > kMostScraps * area) return;
    std::vector<char> keep;
    for (const ComponentFacts& c : facts) keep.push_back(!is_scrap(c));
    const Removed removed = keep_components(wall, topology, facts, keep);
    if (removed.components > 0)
        context.warn("fragment_removed",
                     counted(removed.components, "scrap") + " of " + counted(removed.triangles, "triangle") +
                         " in all, loose or split off at non-manifold edges, the first at " +
                         short_text(removed.position) + ", removed: look there if that is many",
                     static_cast<double>(removed.triangles), 0);
}

void remove_specks(WallMesh& wall, WallTopology& topology, double share, StageContext& context) {
    if (topology.component_count < 2) return;
    const std::vector<ComponentFacts> facts = wall_facts(wall, topology);
    const double area = total_area(facts), limit = share * area;
    std::vector<char> keep;
    double specks = 0;
    for (const ComponentFacts& c : facts) {
        keep.push_back(c.area >= limit);
        specks += c.area < limit ? c.area : 0;
    }
    if (specks > kMostScraps * area) return;
    const Removed removed = keep_components(wall, topology, facts, keep);
    if (removed.components > 0)
        context.warn("speck_removed",
                     counted(removed.components, "component") + " of " + counted(removed.triangles, "triangle") +
                         " in all, each of less than " + percent(share) + " of the area, the first at " +
                         short_text(removed.position) + ", removed as specks: lower `speck_share` if one is a vessel",
                     static_cast<double>(removed.components), share);
}

void select_components(WallMesh& wall, WallTopology& topology, ComponentPolicy policy, StageContext& context) {
    if (topology.component_count < 2 || policy == ComponentPolicy::kEach) return;
    const std::vector<ComponentFacts> facts = wall_facts(wall, topology);
    const auto largest =
        std::max_element(facts.begin(), facts.end(), [](const auto& a, const auto& b) { return a.area < b.area; });
    const double share = 1 - largest->area / total_area(facts);
    if (policy == ComponentPolicy::kFail)
        refuse(ErrorCode::kSeveralComponents,
               "the surface has " + std::to_string(facts.size()) + " components, " + percent(share) +
                   " of the area outside of the largest, and condition.components is fail; give the lumen alone, or "
                   "choose largest or each");
    std::vector<char> keep(facts.size(), 0);
    keep[static_cast<std::size_t>(largest - facts.begin())] = 1;
    const Removed removed = keep_components(wall, topology, facts, keep);
    context.warn("component_dropped",
                 counted(removed.components, "component") + " of " + counted(removed.triangles, "triangle") + ", " +
                     percent(share) + " of the area, the first at " + short_text(removed.position) +
                     ", left out, since only the largest was asked for: `components: each` keeps them",
                 static_cast<double>(removed.components), 0);
}

void refuse_loose_triangles(const WallMesh& wall, const WallTopology& topology) {
    for (const ComponentFacts& c : wall_facts(wall, topology)) {
        if (c.boundary_share() > kMostBoundary)
            refuse(ErrorCode::kOpenBoundary,
                   percent(c.boundary_share()) + " of the edges of the component of " +
                       counted(c.triangles, "triangle") + " at " + short_text(c.anchor) +
                       " belong to one triangle only (limit " + percent(kMostBoundary) +
                       "): the triangles are not joined; weld the surface or raise the weld tolerance");
        if (c.loops == 1 && c.hole_area > kSheetArea * c.area)
            refuse(ErrorCode::kOpenBoundary,
                   "the component of " + counted(c.triangles, "triangle") + " at " + short_text(c.anchor) +
                       " is a flat sheet with an edge of " + std::to_string(c.boundary_edges) +
                       " sides and encloses nothing; weld it to the wall (raise the weld tolerance) or remove it");
    }
}

void turn_outward(WallMesh& wall, WallTopology& topology, bool allowed, StageContext& context) {
    const std::vector<ComponentFacts> facts = wall_facts(wall, topology);
    const auto turned = std::count_if(facts.begin(), facts.end(), [](const auto& c) { return c.volume < 0; });
    if (turned == 0) return;
    if (!allowed)
        refuse(ErrorCode::kRepairOff, counted(static_cast<std::size_t>(turned), "component") +
                                          " facing inward, and condition.orient_faces is off; turn the surface or "
                                          "switch it on");
    for (Corners& t : wall.triangles)
        if (facts[topology.component[t[0]]].volume < 0) std::swap(t[1], t[2]);
    for (Loop& loop : topology.loops)
        if (facts[topology.component[loop[0]]].volume < 0) std::reverse(loop.begin() + 1, loop.end());
    context.note("orientation_flipped",
                 counted(static_cast<std::size_t>(turned), "component") + " faced inward and turned outward",
                 static_cast<double>(turned));
}

void check_components(const Surface& surface, const std::vector<std::uint32_t>& component, std::uint32_t count,
                      StageContext& context) {
    std::vector<Corners> triangles;
    triangles.reserve(surface.triangles.size());
    for (const auto& t : surface.triangles) triangles.push_back({t[0].value, t[1].value, t[2].value});
    const std::vector<ComponentFacts> facts = triangle_facts(surface.points, triangles, component, count);
    std::vector<Box> boxes(count);
    for (std::size_t s = 0; s < surface.points.size(); ++s) boxes[component[s]].include(surface.points[s]);
    double area = 0, largest = 0;
    for (std::size_t c = 0; c < count; ++c) {
        const double size = distance(boxes[c].low, boxes[c].high);
        const double volume = facts[c].volume / size / size / size;
        if (!(volume > kLeastVolume) || !std::isfinite(volume))
            refuse(ErrorCode::kNoVolume, "the component of " + counted(facts[c].triangles, "triangle") + " at " +
                                             short_text(facts[c].anchor) + " encloses " + short_text(volume) +
                                             " of the cube of its diagonal (limit " + short_text(kLeastVolume) +
                                             "); it is flat or turned inside out: repair or remove it");
        area += facts[c].area;
        largest = std::max(largest, facts[c].area);
    }
    if (count < 2) return;
    context.warn("multiple_components",
                 "the surface has " + std::to_string(count) + " components; " + percent((area - largest) / area) +
                     " of the area lies outside of the largest: see that each is meant, or keep that one by "
                     "`components: largest`",
                 count, 1);
    refuse_nested(surface, component, facts, boxes);
}

}  // namespace lumenline
