#include "engine/condition/orient.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "engine/condition/cgal_repair.h"
#include "engine/condition/half_edges.h"
#include "engine/core/text.h"

// CGAL's orienter cuts what it cannot orient and says nothing. Therefore the pairs of half-edges
// are compared before and after: an edge of two triangles that no longer pair was cut because the
// surface has one side only.

namespace lumenline {
namespace {

bool is_flipped(const Corners& before, const Corners& after, const std::vector<std::uint32_t>& source) {
    return source[after[0]] != before[0];
}

// Number of a half-edge after its triangle (a, b, c) became (c, b, a).
std::uint32_t reversed_half_edge(std::uint32_t h) { return h % 3 == 0 ? h + 1 : h % 3 == 1 ? h - 1 : h; }

void refuse_one_sided(const WallMesh& wall, const HalfEdgePairs& before, const OrientedSoup& repaired) {
    const HalfEdgePairs after = pair_half_edges(repaired.triangles, repaired.source.size());
    const auto moved = [&](std::uint32_t h) {
        return is_flipped(wall.triangles[h / 3], repaired.triangles[h / 3], repaired.source) ? reversed_half_edge(h)
                                                                                             : h;
    };
    std::size_t cut = 0;
    std::uint32_t first = kNoHalfEdge;
    for (std::uint32_t h = 0; h < before.opposite.size(); ++h) {
        const std::uint32_t partner = before.opposite[h];
        if (partner == kNoHalfEdge || partner < h || after.opposite[moved(h)] == moved(partner)) continue;
        ++cut;
        if (first == kNoHalfEdge) first = h;
    }
    if (cut > 0)
        refuse(ErrorCode::kNonManifold,
               "the surface cannot be oriented: at " + counted(cut, "edge") + ", the first at " +
                   short_text(wall.points[start_of(wall.triangles, first)]) +
                   ", its outside passes into its inside as on a Moebius strip; repair the surface there");
    if (after.first_irregular != kNoHalfEdge)
        refuse(ErrorCode::kNonManifold,
               "the edge at " +
                   short_text(wall.points[repaired.source[start_of(repaired.triangles, after.first_irregular)]]) +
                   " cannot be made manifold; repair the surface there");
}

}  // namespace

std::size_t make_oriented_manifold(WallMesh& wall, const ConditionOptions& options, StageContext& context) {
    const std::size_t vertices = wall.points.size();
    const HalfEdgePairs pairs = pair_half_edges(wall.triangles, vertices);
    if (pairs.first_irregular == kNoHalfEdge && find_split_vertex(wall.triangles, pairs, vertices) == kDropped)
        return 0;

    const OrientedSoup repaired = orient_soup(wall.triangles, vertices);
    refuse_one_sided(wall, pairs, repaired);
    std::size_t flipped = 0;
    for (std::size_t t = 0; t < wall.triangles.size(); ++t)
        flipped += is_flipped(wall.triangles[t], repaired.triangles[t], repaired.source);
    flipped = std::min(flipped, wall.triangles.size() - flipped);

    std::vector<std::uint32_t> split(repaired.source.begin() + static_cast<std::ptrdiff_t>(vertices),
                                     repaired.source.end());
    std::sort(split.begin(), split.end());
    split.erase(std::unique(split.begin(), split.end()), split.end());
    if (!options.split_non_manifold && !split.empty())
        refuse(ErrorCode::kRepairOff,
               counted(pairs.non_manifold_edges, "edge") + " of more than two triangles and sheets that meet in " +
                   std::to_string(split.size()) + (split.size() == 1 ? " vertex" : " vertices") + ", the first at " +
                   short_text(wall.points[split.front()]) +
                   ", and condition.split_non_manifold is off; repair the surface or switch it on");
    if (!options.orient_faces && flipped > 0)
        refuse(ErrorCode::kRepairOff, counted(flipped, "triangle") +
                                          " facing another way than the neighbours, and condition.orient_faces is off; "
                                          "repair the surface or switch it on");
    const std::string edges = counted(pairs.non_manifold_edges, "edge") + " of more than two triangles and ";
    const std::string turned = " and " + counted(flipped, "triangle") + " turned over";
    if (!split.empty())
        context.warn("non_manifold_split",
                     "sheets parted where they met, at " + (pairs.non_manifold_edges > 0 ? edges : "") +
                         std::to_string(split.size()) + (split.size() == 1 ? " vertex" : " vertices") +
                         ", the first at " + short_text(wall.points[split.front()]) +
                         (flipped > 0 ? "," + turned : "") + ": mend the segmentation if two vessels touch there",
                     static_cast<double>(split.size()), 0);
    else
        context.warn(
            "triangles_reoriented",
            counted(flipped, "triangle") + " faced the other way and turned over: look at the surface if that is many",
            static_cast<double>(flipped), 0);

    wall.triangles = repaired.triangles;
    for (std::size_t v = vertices; v < repaired.source.size(); ++v) {
        wall.points.push_back(wall.points[repaired.source[v]]);
        wall.input_vertex.push_back(wall.input_vertex[repaired.source[v]]);
    }
    return repaired.source.size() - vertices;
}

}  // namespace lumenline
