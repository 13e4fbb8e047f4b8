#include "engine/condition/weld.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/limits.h"
#include "engine/core/text.h"

// Welding sorts the vertices along one direction and compares each with the representatives in a
// window as wide as the tolerance. The direction is skew to every axis and lattice plane, because
// structured meshes have thousands of vertices in one plane. Comparing with representatives only,
// the first in sorted order winning, keeps exact duplicates together, does not chain vertices into
// long clusters, and stays fast where a whole model shrinks below the tolerance.

namespace lumenline {
namespace {

// Coordinates 1, 1/g and 1/p (golden ratio, plastic number): no small integer relation.
const Vec3 kSkewDirection = normalized({1, 0.61803398874989485, 0.75487766624669276});

constexpr std::size_t kMostElements = std::size_t{1} << 31;

void check_soup(const TriangleSoup& soup) {
    const std::size_t vertices = soup.points.size();
    if (soup.triangles.empty())
        refuse(ErrorCode::kNoSurface, "the surface has no triangles; give a triangulated surface");
    if (vertices >= kMostElements || 3 * soup.triangles.size() >= kMostElements)
        refuse(ErrorCode::kTooLarge, "the surface has " + std::to_string(vertices) + " vertices and " +
                                         std::to_string(soup.triangles.size()) +
                                         " triangles, more than 32-bit indices hold; coarsen it");
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        for (const std::uint32_t v : soup.triangles[t]) {
            if (v >= vertices)
                refuse(ErrorCode::kFileFormat, "triangle " + std::to_string(t) + " refers to vertex " +
                                                   std::to_string(v) + ", but there are only " +
                                                   std::to_string(vertices) + "; the file is damaged");
            const Vec3& p = soup.points[v];
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                refuse(ErrorCode::kBadCoordinate, "vertex " + std::to_string(v) + " of triangle " + std::to_string(t) +
                                                      " has the position " + short_text(p) +
                                                      ", which is not finite; repair the file");
            if (std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) > kLargestCoordinate)
                refuse(ErrorCode::kBadCoordinate, "vertex " + std::to_string(v) + " of triangle " + std::to_string(t) +
                                                      " has the position " + short_text(p) + ", beyond the limit of " +
                                                      short_text(kLargestCoordinate) + "; repair the file");
        }
    }
}

struct Representative {
    double key;
    Vec3 point;
    std::uint32_t group;
};

// Number, per vertex, of the lowest vertex that it is welded to.
std::vector<std::uint32_t> lowest_equal(const std::vector<Vec3>& points, const std::vector<char>& used,
                                        double tolerance, double diagonal) {
    std::vector<std::pair<double, std::uint32_t>> order;
    order.reserve(points.size());
    const auto first_used = static_cast<std::size_t>(std::find(used.begin(), used.end(), 1) - used.begin());
    const Vec3 origin = points[first_used];
    for (std::size_t v = 0; v < points.size(); ++v)
        if (used[v]) order.emplace_back(dot(kSkewDirection, points[v] - origin), static_cast<std::uint32_t>(v));
    std::sort(order.begin(), order.end());

    // A key carries a few roundings of the model's size; without them a pair exactly as far apart
    // as the tolerance could be missed.
    const double window = tolerance + 1e-15 * diagonal;
    std::vector<Representative> representatives;
    representatives.reserve(order.size());
    std::vector<std::uint32_t> lowest;
    lowest.reserve(order.size());
    std::vector<std::uint32_t> group(points.size(), kDropped);
    std::size_t first = 0;
    for (const auto& [key, v] : order) {
        while (first < representatives.size() && key - representatives[first].key > window) ++first;
        std::size_t r = first;
        while (r < representatives.size() && squared_norm(points[v] - representatives[r].point) > tolerance * tolerance)
            ++r;
        if (r == representatives.size()) {
            representatives.push_back({key, points[v], static_cast<std::uint32_t>(lowest.size())});
            lowest.push_back(v);
        }
        group[v] = representatives[r].group;
        lowest[group[v]] = std::min(lowest[group[v]], v);
    }
    for (std::size_t v = 0; v < points.size(); ++v) group[v] = used[v] ? lowest[group[v]] : kDropped;
    return group;
}

struct Repetition {
    std::uint32_t middle, high, triangle;
    auto operator<=>(const Repetition&) const = default;
};

// Removes repeated triangles. Buckets by lowest vertex keep this linear on any ordinary mesh.
std::size_t drop_duplicates(std::vector<Corners>& triangles, std::size_t vertex_count) {
    const auto sorted = [](Corners t) {
        std::sort(t.begin(), t.end());
        return t;
    };
    std::vector<std::uint32_t> offset(vertex_count + 1, 0);
    for (const Corners& t : triangles) ++offset[std::min({t[0], t[1], t[2]}) + 1];
    for (std::size_t v = 0; v < vertex_count; ++v) offset[v + 1] += offset[v];
    std::vector<Repetition> entries(triangles.size());
    std::vector<std::uint32_t> next(offset.begin(), offset.end() - 1);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Corners t = sorted(triangles[i]);
        entries[next[t[0]]++] = {t[1], t[2], static_cast<std::uint32_t>(i)};
    }
    std::vector<std::uint32_t> repeated;
    for (std::size_t v = 0; v < vertex_count; ++v) {
        if (offset[v + 1] - offset[v] < 2) continue;
        std::sort(entries.begin() + offset[v], entries.begin() + offset[v + 1]);
        for (std::size_t e = offset[v] + 1; e < offset[v + 1]; ++e)
            if (entries[e].middle == entries[e - 1].middle && entries[e].high == entries[e - 1].high)
                repeated.push_back(entries[e].triangle);
    }
    if (repeated.empty()) return 0;
    std::sort(repeated.begin(), repeated.end());
    std::size_t kept = 0, r = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (r < repeated.size() && repeated[r] == i)
            ++r;
        else
            triangles[kept++] = triangles[i];
    }
    triangles.resize(kept);
    return repeated.size();
}

void note_count(StageContext& context, const char* code, std::size_t count, const std::string& what) {
    if (count > 0) context.note(code, what + std::to_string(count), static_cast<double>(count));
}

}  // namespace

WallMesh weld_soup(const TriangleSoup& soup, double tolerance, bool drop_faces, StageContext& context) {
    check_soup(soup);
    const std::size_t vertices = soup.points.size();
    std::vector<char> used(vertices, 0);
    for (const Corners& t : soup.triangles)
        for (const std::uint32_t v : t) used[v] = 1;
    std::vector<Vec3> used_points;
    used_points.reserve(vertices);
    for (std::size_t v = 0; v < vertices; ++v)
        if (used[v]) used_points.push_back(soup.points[v]);
    const double diagonal = bounding_diagonal(used_points);
    if (diagonal > 0 && diagonal < 1 / kLargestCoordinate)
        refuse(ErrorCode::kBadCoordinate, "the surface is " + short_text(diagonal) + " across, below the limit of " +
                                              short_text(1 / kLargestCoordinate) +
                                              "; give it in another unit or with another scale");

    const std::vector<std::uint32_t> kept = lowest_equal(soup.points, used, tolerance * diagonal, diagonal);
    WallMesh wall;
    wall.triangles.reserve(soup.triangles.size());
    for (const Corners& t : soup.triangles) {
        const Corners welded{kept[t[0]], kept[t[1]], kept[t[2]]};
        if (welded[0] != welded[1] && welded[1] != welded[2] && welded[2] != welded[0])
            wall.triangles.push_back(welded);
    }
    const std::size_t degenerate = soup.triangles.size() - wall.triangles.size();
    if (wall.triangles.empty())
        refuse(ErrorCode::kNoSurface, "each of the " + std::to_string(degenerate) +
                                          " triangles has two corners closer than the weld tolerance of " +
                                          short_text(tolerance * diagonal) + ", so none is left; check the file");
    const std::size_t duplicate = drop_duplicates(wall.triangles, vertices);
    if (!drop_faces && degenerate + duplicate > 0)
        refuse(ErrorCode::kRepairOff, "the surface has " + counted(degenerate, "degenerate triangle") + " and " +
                                          counted(duplicate, "repeated triangle") +
                                          ", and condition.drop_faces is off; repair the surface or switch it on");

    std::size_t welded = 0;
    for (std::size_t v = 0; v < vertices; ++v) welded += used[v] && kept[v] != v;
    wall.points = soup.points;
    wall.input_vertex.resize(vertices);
    for (std::size_t v = 0; v < vertices; ++v) wall.input_vertex[v] = static_cast<std::uint32_t>(v);
    drop_unused_vertices(wall);

    note_count(context, "welded_vertices", welded, "vertices joined with another one at the same place: ");
    note_count(context, "degenerate_triangles", degenerate, "triangles dropped for a repeated vertex: ");
    note_count(context, "duplicate_triangles", duplicate, "triangles dropped for repeating another one: ");
    note_count(context, "unreferenced_vertices", vertices - used_points.size(),
               "vertices dropped that no triangle uses: ");
    return wall;
}

}  // namespace lumenline
