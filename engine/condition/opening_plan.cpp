#include "engine/condition/opening_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "engine/condition/cap.h"
#include "engine/condition/wall_direction.h"
#include "engine/core/text.h"

// The normal is that of the loop's area vector, which is independent of the choice of origin and
// points out of the lumen because the loop runs against its wall triangles. All vectors are taken
// from a vertex of the loop, so that nothing is lost far from the origin.
//
// An extension along the normal of an oblique opening would bend the vessel there, and with it the
// line and its radius for a radius behind the opening. The direction of the wall is that of the vessel a third of
// a radius behind the opening: where it differs from the normal by no more than vessels bend on that way, the normal
// is the better of the two.

namespace lumenline {
namespace {

constexpr double kLeastRoundness = 1e-3;  // area per area of the circle of the same perimeter
constexpr double kSameArea = 1e-9;        // radii closer than this share count as equal
constexpr double kAcross = 0.985;         // cosine between normal and direction of what counts as cut across
constexpr double kMostUneven = 3;         // ratio of the edge used and the loop's mean side, either way

void turn_to(OpeningPlan& plan, Vec3 normal) {
    plan.frame.normal = normal;
    plan.frame.u = any_perpendicular(normal);
    plan.frame.v = cross(normal, plan.frame.u);
}

void measure_plane(OpeningPlan& plan) {
    const std::vector<Vec3>& p = plan.corners;
    const Vec3 start = p.front();
    Vec3 doubled;
    double perimeter = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec3 next = p[(i + 1) % p.size()];
        doubled += cross(p[i] - start, next - start);
        perimeter += distance(p[i], next);
    }
    const double area = norm(doubled) / 2;
    const double circle = perimeter * perimeter / (4 * std::numbers::pi);
    if (!(area > kLeastRoundness * circle))
        refuse(ErrorCode::kOpenBoundary, "the opening of " + counted(p.size(), "edge") + " at " + short_text(start) +
                                             " encloses " + short_text(area / circle) +
                                             " of the circle of its length (limit " + short_text(kLeastRoundness) +
                                             "): a slit or a loop that crosses itself; repair the surface there");
    plan.radius = std::sqrt(area / std::numbers::pi);
    turn_to(plan, normalized(doubled));

    // Centroid of the triangles from `start`, weighted by their signed share of the area.
    Vec3 weighted;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec3 a = p[i] - start, b = p[(i + 1) % p.size()] - start;
        weighted += dot(cross(a, b), plan.frame.normal) / 3 * (a + b);
    }
    plan.frame.origin = start + (1 / (2 * area)) * weighted;
}

void centre_plane(OpeningPlan& plan) {
    // The plane's height is the mean along the loop's length: the area centroid of a crooked loop
    // depends on the vertex the triangles start from.
    const std::size_t n = plan.corners.size();
    double weighted = 0, perimeter = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 a = plan.corners[i], b = plan.corners[(i + 1) % n];
        weighted += distance(a, b) * (plan.frame.height(a) + plan.frame.height(b)) / 2;
        perimeter += distance(a, b);
    }
    plan.frame.origin += weighted / perimeter * plan.frame.normal;
}

void project_loop(OpeningPlan& plan) {
    plan.outline.clear();
    plan.heights.clear();
    for (const Vec3& p : plan.corners) {
        plan.outline.push_back(plan.frame.project(p));
        plan.heights.push_back(plan.frame.height(p));
    }
    plan.highest = *std::max_element(plan.heights.begin(), plan.heights.end());
}

void choose_axis(OpeningPlan& plan, Vec3 direction) {
    plan.axis = plan.frame.normal;
    const double cosine = dot(direction, plan.frame.normal);
    if (cosine < kLeastAlong || cosine > kAcross) return;
    plan.axis = direction;
    if (!is_simple_polygon(along_axis(plan).outline)) plan.axis = plan.frame.normal;
}

double mean_side(const std::vector<Vec3>& loop) {
    double perimeter = 0;
    for (std::size_t k = 0; k < loop.size(); ++k) perimeter += distance(loop[k], loop[(k + 1) % loop.size()]);
    return perimeter / static_cast<double>(loop.size());
}

// Mean edge of the triangles next to those that touch the loop, for all loops at once. The triangles at
// the loop itself are no measure: where a surface was clipped they are slivers of what they were.
void measure_edges(const WallMesh& wall, std::vector<OpeningPlan>& plans) {
    std::vector<std::uint32_t> at_loop(wall.points.size(), kDropped), near_loop(wall.points.size(), kDropped);
    for (std::uint32_t i = 0; i < plans.size(); ++i)
        for (const std::uint32_t v : plans[i].loop) at_loop[v] = i;
    const auto opening_of = [](const std::vector<std::uint32_t>& opening, const Corners& t) {
        return std::min({opening[t[0]], opening[t[1]], opening[t[2]]});
    };
    for (const Corners& t : wall.triangles) {
        const std::uint32_t i = opening_of(at_loop, t);
        if (i == kDropped) continue;
        for (const std::uint32_t v : t) near_loop[v] = i;
    }
    std::vector<double> sum(plans.size(), 0), count(plans.size(), 0);
    for (const Corners& t : wall.triangles) {
        const std::uint32_t i = opening_of(near_loop, t);
        if (i == kDropped || opening_of(at_loop, t) != kDropped) continue;
        for (std::size_t k = 0; k < 3; ++k) sum[i] += distance(wall.points[t[k]], wall.points[t[(k + 1) % 3]]);
        count[i] += 3;
    }
    for (std::size_t i = 0; i < plans.size(); ++i) {
        const double side = mean_side(plans[i].corners);
        plans[i].edge = count[i] > 0 ? std::clamp(sum[i] / count[i], side / kMostUneven, side * kMostUneven) : side;
    }
}

void sort_openings(std::vector<OpeningPlan>& plans) {
    std::stable_sort(plans.begin(), plans.end(), [](const auto& a, const auto& b) { return a.radius > b.radius; });
    const auto before = [](const OpeningPlan& a, const OpeningPlan& b) {
        const Vec3 skew{1, 0.61803398874989485, 0.75487766624669276};
        return dot(a.frame.origin - b.frame.origin, skew) < 0;
    };
    for (auto first = plans.begin(); first != plans.end();) {
        auto last = first + 1;
        while (last != plans.end() && last->radius > (1 - kSameArea) * (last - 1)->radius) ++last;
        std::stable_sort(first, last, before);
        first = last;
    }
    for (std::uint32_t i = 0; i < plans.size(); ++i) plans[i].seed = i;
}

}  // namespace

std::vector<OpeningPlan> plan_openings(const WallMesh& wall, const std::vector<Loop>& loops) {
    std::vector<OpeningPlan> plans(loops.size());
    const std::vector<Vec3> directions = wall_directions(wall, loops);
    for (std::size_t i = 0; i < loops.size(); ++i) {
        OpeningPlan& plan = plans[i];
        plan.loop = loops[i];
        for (const std::uint32_t v : plan.loop) plan.corners.push_back(wall.points[v]);
        measure_plane(plan);
        centre_plane(plan);
        project_loop(plan);
        choose_axis(plan, directions[i]);
    }
    measure_edges(wall, plans);
    sort_openings(plans);
    return plans;
}

OpeningPlan along_axis(const OpeningPlan& plan) {
    OpeningPlan seen = plan;
    if (plan.axis == plan.frame.normal) return seen;
    turn_to(seen, plan.axis);
    project_loop(seen);
    return seen;
}

}  // namespace lumenline
