#include "engine/condition/holes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "engine/condition/cgal_repair.h"
#include "engine/condition/wall_direction.h"
#include "engine/condition/wall_radius.h"
#include "engine/core/text.h"

// A hole in the wall and the open end of a small vessel may have equally few edges. Around the end of
// a tube the wall runs along the loop's normal, around a hole it lies in the loop's plane: the mean
// cosine between the normals of wall and loop is 0.7 to 1 at holes and -0.1 to 0.4 at vessel ends.
// That fails for a hole as wide as the vessel, whose edge the wall meets from all sides; but its normal is across the
// vessel's direction.
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
constexpr double kHoleShare = 0.4;         // radius of a hole in the wall, at most, per radius of the vessel
constexpr std::size_t kCutEdges = 12;      // an opening cut flush with the wall has at least so many edges,
constexpr double kCutFlatness = 0.02;      // lies in a plane within this share of its radius,
constexpr double kCutRoundness = 0.9;      // and has this share of the area of the circle of its perimeter
constexpr double kLeastRoundness = 0.1;    // area of a vessel's end per area of the circle of the same perimeter

struct LoopShape {
    Vec3 normal;
    double radius = 0;         // of the circle of the loop's area
    double flatness = 0;       // largest distance from the plane through the loop's mean, per radius
    double roundness = 0;      // area per area of the circle of the same perimeter
    double wall_cosine = 0;    // mean over the triangles that touch the loop
    double along = 1;          // cosine between the normal and the vessel's direction; 1 = no definite direction
    double vessel_radius = 0;  // of the lumen behind it, median; 0 = not measured
};

double distance_from_plane(const WallMesh& wall, const Loop& loop, Vec3 normal) {
    const Vec3 start = wall.points[loop.front()];
    double sum = 0, farthest = 0;
    for (const std::uint32_t v : loop) sum += dot(wall.points[v] - start, normal);
    for (const std::uint32_t v : loop)
        farthest =
            std::max(farthest, std::fabs(dot(wall.points[v] - start, normal) - sum / static_cast<double>(loop.size())));
    return farthest;
}

std::vector<LoopShape> measure_loops(const WallMesh& wall, const std::vector<Loop>& loops) {
    std::vector<LoopShape> shapes(loops.size());
    std::vector<std::uint32_t> loop_of(wall.points.size(), kDropped);
    const std::vector<Vec3> directions = wall_directions(wall, loops);
    for (std::uint32_t i = 0; i < loops.size(); ++i) {
        const Vec3 doubled = doubled_area(wall, loops[i]);
        double perimeter = 0;
        for (std::size_t k = 0; k < loops[i].size(); ++k) {
            perimeter += distance(wall.points[loops[i][k]], wall.points[loops[i][(k + 1) % loops[i].size()]]);
            loop_of[loops[i][k]] = i;
        }
        shapes[i].normal = normalized(doubled);
        if (directions[i] != Vec3{}) shapes[i].along = dot(directions[i], shapes[i].normal);
        shapes[i].radius = std::sqrt(norm(doubled) / 2 / std::numbers::pi);
        shapes[i].flatness = distance_from_plane(wall, loops[i], shapes[i].normal) / shapes[i].radius;
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

// Radius of the lumen behind each loop that lies in the wall, where it decides.
void measure_vessels(const WallMesh& wall, const std::vector<Loop>& loops, std::vector<LoopShape>& shapes) {
    const auto in_wall = [](const LoopShape& s) { return s.wall_cosine > kHoleCosine; };
    if (std::none_of(shapes.begin(), shapes.end(), in_wall)) return;
    const WallRadius radius(wall);
    const double largest = bounding_diagonal(wall.points);
    std::vector<std::uint32_t> loop_of(wall.points.size(), kDropped);
    for (std::uint32_t i = 0; i < loops.size(); ++i)
        for (const std::uint32_t v : loops[i])
            if (in_wall(shapes[i])) loop_of[v] = i;
    std::vector<std::vector<double>> radii(loops.size());
    for (std::uint32_t t = 0; t < wall.triangles.size(); ++t) {
        const Corners& c = wall.triangles[t];
        const std::uint32_t i = std::min({loop_of[c[0]], loop_of[c[1]], loop_of[c[2]]});
        if (i == kDropped) continue;
        if (const double r = radius.at(t, largest); r < largest) radii[i].push_back(r);
    }
    for (std::size_t i = 0; i < loops.size(); ++i) {
        if (radii[i].empty()) continue;
        const auto middle = radii[i].begin() + static_cast<std::ptrdiff_t>(radii[i].size() / 2);
        std::nth_element(radii[i].begin(), middle, radii[i].end());
        shapes[i].vessel_radius = *middle;
    }
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
            if (i >= loop.size() || j >= loop.size()) continue;
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

// A loop in the wall, small for the vessel; an even circle of many edges was cut there on purpose.
bool is_hole_in_wall(const Loop& loop, const LoopShape& shape) {
    const bool cut = loop.size() >= kCutEdges && shape.flatness < kCutFlatness && shape.roundness > kCutRoundness;
    return !cut && shape.wall_cosine > kSurelyHoleCosine && shape.radius < kHoleShare * shape.vessel_radius;
}

Patch fill_hole(const WallMesh& wall, const std::vector<Corners>& neighbours, const Loop& loop) {
    if (loop.size() == 3) return {{}, 0, {{0, 1, 2}}};
    std::vector<Vec3> corners;
    for (const std::uint32_t v : loop) corners.push_back(wall.points[v]);
    for (const bool refined : {true, false}) {
        if (refined && loop.size() < kFewestOpeningEdges) continue;
        const auto patch = triangulate_loop(corners, refined);
        if (patch && !repeats_an_edge(neighbours, loop, *patch)) return *patch;
    }
    return star(corners);
}

// Triangles with two corners on a loop that is filled: all that could have a diagonal as edge.
std::vector<Corners> triangles_at(const WallMesh& wall, const std::vector<Loop>& loops, const std::vector<char>& fill) {
    std::vector<char> marked(wall.points.size(), 0);
    for (std::size_t i = 0; i < loops.size(); ++i)
        if (fill[i])
            for (const std::uint32_t v : loops[i]) marked[v] = 1;
    std::vector<Corners> found;
    for (const Corners& t : wall.triangles)
        if (marked[t[0]] + marked[t[1]] + marked[t[2]] >= 2) found.push_back(t);
    return found;
}

std::string describe(const WallMesh& wall, const Loop& loop, const LoopShape& shape) {
    std::string text = counted(loop.size(), "edge") + " at " + short_text(wall.points[loop.front()]) + " (radius " +
                       short_text(shape.radius, 3);
    if (shape.vessel_radius > 0) text += ", vessel around it " + short_text(shape.vessel_radius, 3);
    return text + ")";
}

void append_patch(WallMesh& wall, WallTopology& topology, const Loop& loop, const Patch& patch) {
    const auto first = static_cast<std::uint32_t>(wall.points.size());
    const auto n = static_cast<std::uint32_t>(loop.size());
    wall.points.insert(wall.points.end(), patch.points.begin(), patch.points.end());
    wall.input_vertex.resize(wall.points.size(), kDropped);
    topology.component.resize(wall.points.size(), topology.component[loop.front()]);
    const auto vertex = [&](std::uint32_t v) { return v < n ? loop[v] : first + v - n; };
    for (const Corners& t : patch.triangles) wall.triangles.push_back({vertex(t[0]), vertex(t[1]), vertex(t[2])});
}

}  // namespace

void fill_holes(WallMesh& wall, WallTopology& topology, double median_edge, StageContext& context) {
    const std::vector<Loop> loops = topology.loops;
    if (loops.empty()) return;
    std::vector<LoopShape> shapes = measure_loops(wall, loops);
    measure_vessels(wall, loops, shapes);
    std::vector<char> fill;
    for (std::size_t i = 0; i < loops.size(); ++i)
        fill.push_back(is_tiny_hole(wall, loops[i], shapes[i], median_edge) || is_hole_in_wall(loops[i], shapes[i]));
    const std::vector<Corners> neighbours = triangles_at(wall, loops, fill);
    std::size_t filled = 0, suspicious = 0;
    topology.loops.clear();
    for (std::size_t i = 0; i < loops.size(); ++i) {
        const std::string where = describe(wall, loops[i], shapes[i]);
        if (fill[i]) {
            context.warn("hole_filled",
                         "a hole of " + where +
                             " is too small for an opening and was filled; if a vessel ends there: "
                             "`fill_holes: false`",
                         static_cast<double>(loops[i].size()));
            append_patch(wall, topology, loops[i], fill_hole(wall, neighbours, loops[i]));
            ++filled;
            continue;
        }
        const bool faces_out = shapes[i].wall_cosine > kSurelyHoleCosine;
        if (faces_out || shapes[i].along < kLeastAlong) {
            ++suspicious;
            context.warn("opening_in_wall",
                         "the opening of " + where +
                             " lies in the surface around it: rather a hole in the wall than the end of a vessel; mend "
                             "the surface if it is one",
                         faces_out ? shapes[i].wall_cosine : shapes[i].along,
                         faces_out ? kSurelyHoleCosine : kLeastAlong);
        }
        topology.loops.push_back(loops[i]);
    }
    if (filled + suspicious > 0)
        context.note("boundary_loops",
                     counted(loops.size(), "boundary loop") + ": " + counted(filled, "hole") + " filled, " +
                         counted(loops.size() - filled, "opening") + " kept, " + std::to_string(suspicious) +
                         " of them in the wall",
                     static_cast<double>(loops.size()));
}

}  // namespace lumenline
