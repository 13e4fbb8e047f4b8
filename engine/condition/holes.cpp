#include "engine/condition/holes.h"

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>

#include "engine/condition/cgal_repair.h"
#include "engine/core/text.h"

// A hole in the wall and the open end of a small vessel may have equally few edges. Around the end of
// a tube the wall runs along the loop's normal, around a hole it lies in the loop's plane: the mean
// cosine between the normals of wall and loop is 0.7 to 1 at holes and -0.1 to 0.4 at vessel ends.
//
// CGAL triangulates the loop alone and does not know the wall: a diagonal may be an edge already,
// as where one corner of a missing quadrilateral belongs to two triangles only. Then a vertex in
// the middle of the hole joins its sides instead, which always gives a manifold.

namespace lumenline {
namespace {

constexpr std::size_t kFewestOpeningEdges = 6;
constexpr double kTinyExtent = 3;          // in median edges
constexpr double kHoleCosine = 0.5;        // between the normals of wall and loop
constexpr double kSurelyHoleCosine = 0.7;  // the same, for loops of any size
constexpr double kLeastRoundness = 0.1;    // area of a vessel's end per area of the circle of the same perimeter

struct LoopShape {
    Vec3 normal;
    double roundness = 0;    // area per area of the circle of the same perimeter
    double wall_cosine = 0;  // mean over the triangles that touch the loop
};

std::vector<LoopShape> measure_loops(const WallMesh& wall, const std::vector<Loop>& loops) {
    std::vector<LoopShape> shapes(loops.size());
    std::vector<std::uint32_t> loop_of(wall.points.size(), kDropped);
    for (std::uint32_t i = 0; i < loops.size(); ++i) {
        const Vec3 start = wall.points[loops[i].front()];
        Vec3 doubled;
        double perimeter = 0;
        for (std::size_t k = 0; k < loops[i].size(); ++k) {
            const Vec3 a = wall.points[loops[i][k]], b = wall.points[loops[i][(k + 1) % loops[i].size()]];
            doubled += cross(a - start, b - start);
            perimeter += distance(a, b);
            loop_of[loops[i][k]] = i;
        }
        shapes[i].normal = normalized(doubled);
        shapes[i].roundness = norm(doubled) / 2 * 4 * std::numbers::pi / (perimeter * perimeter);
    }
    std::vector<double> count(loops.size(), 0);
    for (const Corners& t : wall.triangles) {
        const std::uint32_t i = std::min({loop_of[t[0]], loop_of[t[1]], loop_of[t[2]]});
        if (i == kDropped) continue;
        const Vec3 doubled = cross(wall.points[t[1]] - wall.points[t[0]], wall.points[t[2]] - wall.points[t[0]]);
        shapes[i].wall_cosine += dot(normalized(doubled), shapes[i].normal);
        count[i] += 1;
    }
    for (std::size_t i = 0; i < loops.size(); ++i) shapes[i].wall_cosine /= std::max(count[i], 1.0);
    return shapes;
}

double extent(const WallMesh& wall, const Loop& loop) {
    double largest = 0;
    for (const std::uint32_t a : loop)
        for (const std::uint32_t b : loop) largest = std::max(largest, distance(wall.points[a], wall.points[b]));
    return largest;
}

bool is_side(std::uint32_t i, std::uint32_t j, std::size_t n) { return (i + 1) % n == j || (j + 1) % n == i; }

// Whether a diagonal of the patch is an edge of one of `neighbours`.
bool repeats_an_edge(const std::vector<Corners>& neighbours, const Loop& loop, const Patch& patch) {
    const auto is_edge = [&](std::uint32_t a, std::uint32_t b) {
        return std::any_of(neighbours.begin(), neighbours.end(), [=](const Corners& t) {
            return std::count(t.begin(), t.end(), a) > 0 && std::count(t.begin(), t.end(), b) > 0;
        });
    };
    for (const Corners& t : patch.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t i = t[k], j = t[(k + 1) % 3];
            if (!is_side(i, j, loop.size()) && is_edge(loop[i], loop[j])) return true;
        }
    return false;
}

Patch star(const std::vector<Vec3>& corners) {
    Patch patch;
    const auto n = static_cast<std::uint32_t>(corners.size());
    Vec3 sum;
    for (const Vec3& p : corners) sum += p - corners.front();
    patch.points.push_back(corners.front() + (1.0 / n) * sum);
    for (std::uint32_t i = 0; i < n; ++i) patch.triangles.push_back({i, (i + 1) % n, n});
    return patch;
}

bool is_tiny_hole(const WallMesh& wall, const Loop& loop, const LoopShape& shape, double median_edge) {
    if (loop.size() >= kFewestOpeningEdges || extent(wall, loop) >= kTinyExtent * median_edge) return false;
    return loop.size() == 3 || shape.roundness < kLeastRoundness || shape.wall_cosine > kHoleCosine;
}

Patch fill_hole(const WallMesh& wall, const std::vector<Corners>& neighbours, const Loop& loop) {
    if (loop.size() == 3) return {{}, 0, {{0, 1, 2}}};
    std::vector<Vec3> corners;
    for (const std::uint32_t v : loop) corners.push_back(wall.points[v]);
    const auto plain = triangulate_loop(corners, false);
    return plain && !repeats_an_edge(neighbours, loop, *plain) ? *plain : star(corners);
}

// Triangles with two corners on loops of the size of tiny holes: all that could have a diagonal as edge.
std::vector<Corners> triangles_at_small_loops(const WallMesh& wall, const std::vector<Loop>& loops) {
    std::vector<char> marked(wall.points.size(), 0);
    for (const Loop& loop : loops)
        if (loop.size() < kFewestOpeningEdges)
            for (const std::uint32_t v : loop) marked[v] = 1;
    std::vector<Corners> found;
    for (const Corners& t : wall.triangles)
        if (marked[t[0]] + marked[t[1]] + marked[t[2]] >= 2) found.push_back(t);
    return found;
}

}  // namespace

std::vector<FilledHole> fill_tiny_holes(const WallMesh& wall, double median_edge, std::vector<Loop>& loops,
                                        StageContext& context) {
    if (loops.empty()) return {};
    const std::vector<LoopShape> shapes = measure_loops(wall, loops);
    const std::vector<Corners> neighbours = triangles_at_small_loops(wall, loops);
    std::vector<FilledHole> filled;
    std::vector<Loop> openings;
    for (std::size_t i = 0; i < loops.size(); ++i) {
        Loop& loop = loops[i];
        const std::string where = counted(loop.size(), "edge") + " at " + short_text(wall.points[loop.front()]);
        if (is_tiny_hole(wall, loop, shapes[i], median_edge)) {
            context.warn("hole_filled", "a hole of " + where + " is too small for an opening and was filled",
                         static_cast<double>(loop.size()), static_cast<double>(kFewestOpeningEdges));
            Patch patch = fill_hole(wall, neighbours, loop);
            filled.push_back({std::move(loop), std::move(patch)});
            continue;
        }
        if (shapes[i].wall_cosine > kSurelyHoleCosine)
            context.warn("opening_in_wall",
                         "the opening of " + where +
                             " lies in the surface around it: rather a hole in the wall than the end of a vessel",
                         shapes[i].wall_cosine, kSurelyHoleCosine);
        openings.push_back(std::move(loop));
    }
    loops = std::move(openings);
    return filled;
}

}  // namespace lumenline
