// Loops of the lumen. Truth: a ring and a figure of eight of round tubes of known axes, with open stubs, polygonised
// from their distance functions. How often a line winds around a hole tells on which side of it the line runs: over a
// loop's two sides, which begin and end together, the windings differ by whole turns, and these tell the loops apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "engine/core/stage_context.h"
#include "engine/schedule/run_models.h"
#include "engine/trace/cycle_classes.h"
#include "tests/stages/implicit_shape.h"
#include "tests/stages/network_check.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

using std::numbers::pi;
constexpr double kTube = 1, kRing = 4;  // radii of the tubes and of the rings' axes

/// A ring with a stub along -x and one along +y, where the box ends.
double ring(Vec3 x) {
    return std::min({test::tube_around_ring(x, {}, kRing, kTube),
                     test::straight_tube(x, {-kRing, 0, 0}, {-20, 0, 0}, kTube),
                     test::straight_tube(x, {0, kRing, 0}, {0, 20, 0}, kTube)});
}

/// Two rings that share a stretch of their tubes, with a stub along -x and one along +y.
constexpr Vec3 kSecond{2 * kRing, 0.4, 0};
double eight(Vec3 x) {
    return std::min({test::tube_around_ring(x, {}, kRing, kTube), test::tube_around_ring(x, kSecond, kRing, kTube),
                     test::straight_tube(x, {-kRing, 0, 0}, {-20, 0, 0}, kTube),
                     test::straight_tube(x, kSecond + Vec3{0, kRing, 0}, kSecond + Vec3{0, 20, 0}, kTube)});
}

TriangleSoup ring_soup() { return test::polygonized(ring, {-9, -6, -1.7}, {6, 9, 1.7}, 0.37); }
TriangleSoup eight_soup() { return test::polygonized(eight, {-9, -6, -1.7}, {14.5, 9, 1.7}, 0.37); }

PipelineOptions options_of(Topology topology) {
    PipelineOptions options;
    options.condition.refine_undersampled = false;  // the mesh as it is
    options.trace.topology = topology;
    return options;
}

std::span<const Vec3> line_points(const Centerlines& lines, std::size_t line) {
    return test::part(lines.points, lines.offsets, line);
}

/// Turns around the axis through `hole` along z.
double winding(std::span<const Vec3> line, Vec3 hole) {
    double turns = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        const Vec3 a = line[i - 1] - hole, b = line[i] - hole;
        turns += std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y) / (2 * pi);
    }
    return turns;
}

/// Turns of the way down a loop's first side and back up its second.
double turns_of_loop(const Centerlines& lines, std::size_t loop, Vec3 hole) {
    std::vector<double> turns;
    for (std::size_t l = 0; l < lines.line_count(); ++l)
        if (lines.loop[l] == LoopId(loop)) turns.push_back(winding(line_points(lines, l), hole));
    return turns.size() == 2 ? turns[0] - turns[1] : std::nan("");
}

void expect_closed(const ModelRecord& record) {
    EXPECT_EQ(test::network_fault(*record.centerlines), "");
    EXPECT_GT(*std::min_element(record.centerlines->clearance.begin(), record.centerlines->clearance.end()),
              0.7 * kTube);
    EXPECT_FALSE(test::has_finding(record.diagnostics, "line_leaves_lumen"));
}

TEST(Loops, RingClosesBehindItsHole) {
    const ModelRecord record = test::run_pipeline(ring_soup(), options_of(Topology::kNetwork));
    ASSERT_TRUE(record.centerlines) << record.failure->sentence;
    const Centerlines& lines = *record.centerlines;
    ASSERT_EQ(record.surface->genus, 1);
    ASSERT_EQ(lines.loops.size(), 1U);
    EXPECT_EQ(lines.line_count(), 3U);
    expect_closed(record);
    // Both sides begin in one cut at the inlet, though not in exactly one point.
    EXPECT_NEAR(std::fabs(turns_of_loop(lines, 0, {})), 1, 1e-3);
    EXPECT_TRUE(test::has_finding(record.diagnostics, "loops_covered"));
    EXPECT_FALSE(test::has_finding(record.diagnostics, "loop_not_covered"));
    EXPECT_FALSE(test::has_finding(record.diagnostics, "loops_unlike_genus"));

    // Away from the stubs the lines are on the ring's axis. The wall is off by up to a tenth of a radius, since its
    // vertices lie on the edges of a grid of 0.37 and keep off their ends.
    std::size_t compared = 0;
    for (const Vec3& x : lines.points) {
        if (x.x < -0.5 * kRing || x.y > 0.5 * kRing) continue;
        EXPECT_LT(std::hypot(std::hypot(x.x, x.y) - kRing, x.z), 0.1 * kTube);
        ++compared;
    }
    EXPECT_GT(compared, 20U);

    // The wall behind the hole, which no line to the outlet passes, belongs to the loop's lines.
    ASSERT_TRUE(record.character);
    std::size_t behind = 0, far = 0;
    for (std::size_t i = 0; i < record.surface->site_count(); ++i) {
        const Vec3 p = record.surface->points[i];
        if (p.x < 0 || p.y > 0) continue;
        ++behind;
        const LineId line = record.character->centerline_id[i];
        if (line.is_none() || lines.loop[at(line)].is_none() || record.character->euclidean_distance[i] > 1.3 * kTube)
            ++far;
    }
    EXPECT_GT(behind, 100U);
    EXPECT_EQ(far, 0U);
}

TEST(Loops, TreeSaysWhatItLeavesOut) {
    const ModelRecord tree = test::run_pipeline(ring_soup(), options_of(Topology::kTree));
    const ModelRecord network = test::run_pipeline(ring_soup(), options_of(Topology::kNetwork));
    ASSERT_TRUE(tree.centerlines && network.centerlines);
    EXPECT_EQ(tree.status, ModelStatus::kWarning);
    EXPECT_TRUE(test::has_finding(tree.diagnostics, "loop_not_covered"));
    EXPECT_EQ(tree.centerlines->loops.size(), 1U);
    ASSERT_EQ(tree.centerlines->line_count(), 1U);
    const auto alone = line_points(*tree.centerlines, 0), beside = line_points(*network.centerlines, 0);
    EXPECT_TRUE(std::equal(alone.begin(), alone.end(), beside.begin(), beside.end()));
}

TEST(Loops, EightHasTwoIndependentOnes) {
    const ModelRecord record = test::run_pipeline(eight_soup(), options_of(Topology::kNetwork));
    ASSERT_TRUE(record.centerlines) << record.failure->sentence;
    const Centerlines& lines = *record.centerlines;
    ASSERT_EQ(record.surface->genus, 2);
    ASSERT_EQ(lines.loops.size(), 2U);
    expect_closed(record);
    double turns[2][2];
    for (std::size_t loop = 0; loop < 2; ++loop)
        for (std::size_t hole = 0; hole < 2; ++hole) {
            turns[loop][hole] = turns_of_loop(lines, loop, hole == 0 ? Vec3{} : kSecond);
            EXPECT_NEAR(turns[loop][hole], std::round(turns[loop][hole]), 1e-3);
        }
    EXPECT_NEAR(std::fabs(turns[0][0] * turns[1][1] - turns[0][1] * turns[1][0]), 1, 1e-2);
}

TEST(Loops, DependOnNeitherUnitNorThreads) {
    std::vector<ModelTask> tasks(2);
    for (std::size_t i = 0; i < 2; ++i) {
        tasks[i].identity.id = "ring" + std::to_string(i);
        tasks[i].scale = i == 0 ? 1 : 0x1p-10;
        tasks[i].options = options_of(Topology::kNetwork);
    }
    const TriangleSoup soup = ring_soup();
    const auto loader = [&soup](const ModelTask& task) {
        TriangleSoup scaled = soup;
        for (Vec3& p : scaled.points) p = task.scale * p;
        return scaled;
    };
    std::map<std::string, std::vector<Vec3>> points[2];
    for (int run = 0; run < 2; ++run) {
        ScheduleOptions options;
        options.threads = run == 0 ? 1 : 3;
        run_models(tasks, options, loader, [&](ModelRecord&& record) {
            ASSERT_TRUE(record.centerlines);
            points[run][record.identity.id] = record.centerlines->points;
        });
    }
    EXPECT_EQ(points[0], points[1]);
    // A power of two changes no digit.
    std::vector<Vec3> scaled = points[0]["ring1"];
    for (Vec3& p : scaled) p = 0x1p10 * p;
    EXPECT_EQ(scaled, points[0]["ring0"]);
}

TEST(Loops, TreeOfTubesHasNone) {
    const Phantom hairpin = make_phantom(test::capped_options(PhantomKind::kHairpin, 0.2, 16, 15));
    const Surface surface = test::closed_surface(hairpin);
    const std::vector<Vec3> inlet{hairpin.truth.position(0)},
        outlet{hairpin.truth.position(hairpin.truth.total_length())};
    const test::Traced tree = test::trace_closed(surface, inlet, outlet);
    const test::Traced network =
        test::trace_closed(surface, inlet, outlet, {Refinement::kMedial, Pairs::kNearest, Join::kAxis, Topology::kNetwork});
    EXPECT_TRUE(network.lines.loops.empty());
    EXPECT_EQ(network.lines.points, tree.lines.points);
    EXPECT_EQ(network.findings.size(), tree.findings.size());
}

/// Only the polygons count.
VoronoiComplex complex_of_polygons(std::size_t vertices, const std::vector<std::vector<std::size_t>>& polygons) {
    VoronoiComplex complex;
    complex.vertices.resize(vertices);
    complex.polygon_offsets.push_back(0);
    for (const auto& polygon : polygons) {
        for (const std::size_t v : polygon) complex.polygon_vertices.emplace_back(v);
        complex.polygon_offsets.push_back(static_cast<std::uint32_t>(complex.polygon_vertices.size()));
        complex.polygon_sites.emplace_back();
    }
    return complex;
}

std::size_t cycles(std::size_t vertices, const std::vector<std::vector<std::size_t>>& polygons) {
    return CycleClasses(complex_of_polygons(vertices, polygons)).count();
}

TEST(CycleClasses, CountsWhatPolygonsDoNotFill) {
    EXPECT_EQ(cycles(3, {{0, 1}, {1, 2}}), 0U);
    EXPECT_EQ(cycles(3, {{0, 1}, {1, 2}, {2, 0}}), 1U);
    EXPECT_EQ(cycles(3, {{0, 1, 2}}), 0U);
    EXPECT_EQ(cycles(3, {{0, 1, 2}, {0, 1}, {0, 1}}), 0U);
    // Three squares around a triangular hole, with one of its openings filled, and with both: a hollow prism.
    const std::vector<std::vector<std::size_t>> band{{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
    auto prism = band;
    EXPECT_EQ(cycles(6, prism), 1U);
    prism.push_back({0, 1, 2});
    EXPECT_EQ(cycles(6, prism), 0U);
    prism.push_back({3, 4, 5});
    EXPECT_EQ(cycles(6, prism), 0U);
    // A torus of nine squares has two cycles and no edge to begin with.
    std::vector<std::vector<std::size_t>> torus;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t a = (i + 1) % 3, b = (k + 1) % 3;
            torus.push_back({3 * i + k, 3 * a + k, 3 * a + b, 3 * i + b});
        }
    EXPECT_EQ(cycles(9, torus), 2U);
    torus.pop_back();
    EXPECT_EQ(cycles(9, torus), 2U);
    torus.erase(torus.begin() + 4);  // shares no edge with the last
    EXPECT_EQ(cycles(9, torus), 3U);
}

TEST(CycleClasses, WaysAroundAHoleDiffer) {
    const VoronoiComplex band = complex_of_polygons(6, {{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}});
    const CycleClasses classes(band);
    const auto way = [&](const std::vector<std::array<std::size_t, 3>>& steps) {  // polygon, from, to
        CycleClass sum = classes.zero();
        for (const auto& [p, a, b] : steps) classes.add_way(PolygonId(p), VoronoiVertexId(a), VoronoiVertexId(b), sum);
        return sum;
    };
    EXPECT_EQ(way({{0, 0, 1}, {1, 1, 5}}), way({{0, 0, 4}, {1, 4, 5}}));
    EXPECT_NE(way({{0, 0, 1}, {1, 1, 5}}), way({{2, 0, 5}}));
    EXPECT_FALSE(is_zero(way({{0, 0, 1}, {1, 1, 2}, {2, 2, 0}})));
    EXPECT_TRUE(is_zero(way({{0, 0, 1}, {0, 1, 4}, {0, 4, 3}, {0, 3, 0}})));
}

}  // namespace
}  // namespace lumenline
