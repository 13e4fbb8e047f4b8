#include "engine/condition/finish.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/condition/half_edges.h"
#include "engine/condition/vertex_normals.h"
#include "engine/core/text.h"

// The half-edges are paired once more on the finished surface: this check shares no code with what
// built it, and finds a cap edge that repeats an edge of the wall.

namespace lumenline {
namespace {

std::vector<Corners> corners_of(const Surface& surface) {
    std::vector<Corners> triangles;
    triangles.reserve(surface.triangles.size());
    for (const auto& t : surface.triangles) triangles.push_back({t[0].value, t[1].value, t[2].value});
    return triangles;
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
    const std::vector<Corners> triangles = corners_of(surface);
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
    VertexNormals found = vertex_normals(surface.points, corners_of(surface), surface.coordinate_rounding);
    surface.normals = std::move(found.normals);
    const bool lacking = std::find(surface.normals.begin(), surface.normals.end(), Vec3{}) != surface.normals.end();
    if (lacking) spread_normals(surface);
    if (found.thin_triangles > 0)
        context.note("zero_area_triangles",
                     counted(found.thin_triangles, "triangle") +
                         " without measurable area kept for the sake of the surface's topology",
                     static_cast<double>(found.thin_triangles));
}

}  // namespace lumenline
