#include "engine/condition/finish.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "engine/condition/half_edges.h"
#include "engine/core/text.h"

// The half-edges are paired once more on the finished surface: this check shares no code with what
// built it, and finds a cap edge that repeats an edge of the wall.

namespace lumenline {
namespace {

// Height of a triangle, per longest side, below which double precision gives its normal at random.
constexpr double kThinnest = 1e-12;

// Twice the area vector of a triangle; zero if it is too thin to have a direction.
Vec3 area_vector(const std::array<Vec3, 3>& p, double rounding) {
    const Vec3 doubled = cross(p[1] - p[0], p[2] - p[0]);
    const double longest = std::max({distance(p[0], p[1]), distance(p[1], p[2]), distance(p[2], p[0])});
    const double thinnest = std::max(kThinnest * longest, 4 * rounding);
    return norm(doubled) > thinnest * longest ? doubled : Vec3{};
}

// Sites without a direction take the mean of their neighbours', ring by ring.
void spread_normals(Surface& surface) {
    const auto lacks = [&](SiteId s) { return surface.normals[at(s)] == Vec3{}; };
    bool changed = true;
    while (changed) {
        changed = false;
        std::vector<Vec3> sum(surface.points.size());
        for (const auto& t : surface.triangles)
            for (std::size_t k = 0; k < 3; ++k)
                if (lacks(t[k]))
                    sum[at(t[k])] += surface.normals[at(t[(k + 1) % 3])] + surface.normals[at(t[(k + 2) % 3])];
        for (std::size_t s = 0; s < sum.size(); ++s) {
            if (surface.normals[s] != Vec3{} || sum[s] == Vec3{}) continue;
            surface.normals[s] = normalized(sum[s]);
            changed = true;
        }
    }
}

}  // namespace

double median_edge(const WallMesh& wall) {
    std::vector<double> squared;
    squared.reserve(3 * wall.triangles.size());
    for (const Corners& t : wall.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            squared.push_back(squared_norm(wall.points[t[k]] - wall.points[t[k == 2 ? 0 : k + 1]]));
    const auto middle = squared.begin() + static_cast<std::ptrdiff_t>(squared.size() / 2);
    std::nth_element(squared.begin(), middle, squared.end());
    return std::sqrt(*middle);
}

void verify_closed(Surface& surface) {
    std::vector<Corners> triangles;
    triangles.reserve(surface.triangles.size());
    for (const auto& t : surface.triangles) triangles.push_back({t[0].value, t[1].value, t[2].value});
    const HalfEdgePairs pairs = pair_half_edges(triangles, surface.points.size());
    const auto where = [&](std::uint32_t v) { return short_text(surface.points[v]); };
    if (pairs.first_irregular != kNoHalfEdge)
        refuse(ErrorCode::kNonManifold, "the edge at " + where(start_of(triangles, pairs.first_irregular)) +
                                            " does not join two triangles once the openings are capped; repair the "
                                            "surface there");
    if (pairs.boundary_edges > 0) {
        const auto open = std::find(pairs.opposite.begin(), pairs.opposite.end(), kNoHalfEdge);
        const auto h = static_cast<std::uint32_t>(open - pairs.opposite.begin());
        refuse(ErrorCode::kNotClosed,
               "the surface is not closed after capping: " + counted(pairs.boundary_edges, "edge") +
                   " left open, the first at " + where(start_of(triangles, h)) + "; repair the surface there");
    }
    const std::uint32_t split = find_split_vertex(triangles, pairs, surface.points.size());
    if (split != kDropped)
        refuse(ErrorCode::kNonManifold,
               "two sheets meet in the vertex at " + where(split) + "; repair the surface there");
    for (const Vec3& p : surface.points)
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            refuse(ErrorCode::kBadCoordinate, "an extension reaches a position that is not finite; scale the model");
    const auto euler =
        static_cast<std::int64_t>(surface.points.size()) - static_cast<std::int64_t>(surface.triangles.size() / 2);
    surface.genus = surface.component_count - static_cast<int>(euler / 2);
}

void compute_normals(Surface& surface, StageContext& context) {
    surface.normals.assign(surface.points.size(), Vec3{});
    std::size_t thin = 0;
    for (const auto& t : surface.triangles) {
        const std::array<Vec3, 3> p{surface.points[at(t[0])], surface.points[at(t[1])], surface.points[at(t[2])]};
        const Vec3 doubled = area_vector(p, surface.coordinate_rounding);
        const double area = norm(doubled);
        if (area == 0) {
            ++thin;
            continue;
        }
        const Vec3 normal = (1 / area) * doubled;
        for (std::size_t k = 0; k < 3; ++k) {
            const double angle = std::atan2(area, dot(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]));
            surface.normals[at(t[k])] += angle * normal;
        }
    }
    bool lacking = false;
    for (Vec3& n : surface.normals) {
        n = normalized(n);
        lacking |= n == Vec3{};
    }
    if (lacking) spread_normals(surface);
    if (thin > 0)
        context.note("zero_area_triangles",
                     counted(thin, "triangle") + " without measurable area kept for the sake of the surface's topology",
                     static_cast<double>(thin));
}

}  // namespace lumenline
