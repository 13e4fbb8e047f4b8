// Networks of several inlets, of lumens that loops were not found in, and the checks of networks themselves on networks
// that were made wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "engine/core/stage_context.h"
#include "engine/trace/loops.h"
#include "tests/stages/implicit_shape.h"
#include "tests/stages/network_check.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

constexpr double kTube = 1, kRing = 4;  // radii of the tubes and of the ring's axis
constexpr double kStep = 0.37;          // of the grid: the wall is off by up to a tenth of the tube's radius

double three_stubs(Vec3 x) {
    return std::min({test::straight_tube(x, {-kRing, 0, 0}, {-20, 0, 0}, kTube),
                     test::straight_tube(x, {kRing, 0, 0}, {20, 0, 0}, kTube),
                     test::straight_tube(x, {0, kRing, 0}, {0, 20, 0}, kTube)});
}
double ring(Vec3 x) { return std::min(test::tube_around_ring(x, {}, kRing, kTube), three_stubs(x)); }
double fork(Vec3 x) {
    return std::min({three_stubs(x), test::straight_tube(x, {-kRing, 0, 0}, {kRing, 0, 0}, kTube),
                     test::straight_tube(x, {0, 0, 0}, {0, kRing, 0}, kTube)});
}

TriangleSoup soup_of(double (*shape)(Vec3)) { return test::polygonized(shape, {-9, -6, -1.7}, {9, 9, 1.7}, kStep); }

/// Inlets at the stubs along -x and +x, and the outlet at the one along +y.
PipelineOptions two_inlets(Topology topology) {
    PipelineOptions options;
    options.condition.refine_undersampled = false;  // the mesh as it is
    options.endpoints.inlets = {{-9, 0, 0}, {9, 0, 0}};
    options.trace.topology = topology;
    return options;
}

double finding_value(const ModelRecord& record, const std::string& code) {
    for (const Diagnostic& d : record.diagnostics)
        if (d.code == code) return d.value;
    return -1;
}

// No tube is wider than this around its line: junctions of two tubes are, by a half; the wall is off by a tenth.
constexpr double kCovered = 1.7;

TEST(Network, TwoInletsOfARingAreJoinedOnBothSides) {
    const ModelRecord record = test::run_pipeline(soup_of(ring), two_inlets(Topology::kNetwork));
    ASSERT_TRUE(record.centerlines) << record.failure->sentence;
    const Centerlines& lines = *record.centerlines;
    ASSERT_EQ(record.surface->genus, 1);
    ASSERT_EQ(lines.loops.size(), 2U);
    EXPECT_EQ(lines.line_count(), 5U);
    EXPECT_EQ(test::network_fault(lines), "");
    // Both meetings are halfway between the inlets, each on its side of the ring.
    std::vector<double> heights;
    for (const LumenLoop& loop : lines.loops) {
        EXPECT_NEAR(loop.point.x, 0, kTube);
        heights.push_back(loop.point.y);
    }
    std::sort(heights.begin(), heights.end());
    EXPECT_NEAR(heights[0], -kRing, 0.2 * kTube);
    EXPECT_NEAR(heights[1], kRing, kTube);
    for (std::size_t l = 0; l < lines.line_count(); l++) {
        if (lines.loop[l].is_none()) continue;
        const bool from_first = lines.source[l] == EndpointId(0);
        EXPECT_EQ(test::part(lines.points, lines.offsets, l).front().x < 0, from_first);
    }
    EXPECT_EQ(finding_value(record, "loops_covered"), 2);
    EXPECT_FALSE(test::has_finding(record.diagnostics, "loops_unlike_genus"));
    EXPECT_LT(test::largest_distance_to_lines(record), kCovered);
}

TEST(Network, TwoInletsOfAForkAreJoined) {
    const ModelRecord record = test::run_pipeline(soup_of(fork), two_inlets(Topology::kNetwork));
    ASSERT_TRUE(record.centerlines) << record.failure->sentence;
    ASSERT_EQ(record.surface->genus, 0);
    ASSERT_EQ(record.centerlines->loops.size(), 1U);
    EXPECT_EQ(test::network_fault(*record.centerlines), "");
    EXPECT_NEAR(record.centerlines->loops[0].point.x, 0, kTube);
    EXPECT_EQ(finding_value(record, "loops_covered"), 1);
    EXPECT_FALSE(test::has_finding(record.diagnostics, "loops_unlike_genus"));
    EXPECT_LT(test::largest_distance_to_lines(record), kCovered);
}

// The tree of the nearest inlets is the same, and counts handles alone.
TEST(Network, TreeOfTwoInletsReportsTheHandleAlone) {
    const ModelRecord tree = test::run_pipeline(soup_of(ring), two_inlets(Topology::kTree));
    ASSERT_TRUE(tree.centerlines) << tree.failure->sentence;
    EXPECT_EQ(tree.centerlines->line_count(), 1U);
    EXPECT_EQ(tree.centerlines->loops.size(), 1U);
    EXPECT_EQ(finding_value(tree, "loop_not_covered"), 1);
    EXPECT_FALSE(test::has_finding(tree.diagnostics, "loops_unlike_genus"));
    EXPECT_GT(test::largest_distance_to_lines(tree), 3) << "the far side of the ring has no line";
    EXPECT_FALSE(test::has_finding(test::run_pipeline(soup_of(fork), two_inlets(Topology::kTree)).diagnostics,
                                   "loop_not_covered"));
}

TEST(Network, HandleThatNoFrontReachesIsSaid) {
    TriangleSoup soup = soup_of(fork);
    const Vec3 centre{0, 0, 8};
    const TriangleSoup torus =
        test::polygonized([&](Vec3 x) { return test::tube_around_ring(x, centre, kRing, kTube); },
                          centre - Vec3{6, 6, 1.7}, centre + Vec3{6, 6, 1.7}, kStep);
    const auto shift = static_cast<std::uint32_t>(soup.points.size());
    soup.points.insert(soup.points.end(), torus.points.begin(), torus.points.end());
    for (const auto& t : torus.triangles) soup.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    for (const Topology topology : {Topology::kTree, Topology::kNetwork}) {
        PipelineOptions options = two_inlets(topology);
        options.endpoints.inlets.pop_back();
        const ModelRecord record = test::run_pipeline(soup, options);
        ASSERT_TRUE(record.centerlines) << record.failure->sentence;
        EXPECT_EQ(record.surface->genus, 1);
        EXPECT_EQ(record.status, ModelStatus::kWarning);
        EXPECT_EQ(finding_value(record, "loops_unlike_genus"), 0);
        EXPECT_TRUE(test::has_finding(record.diagnostics, "wall_unreached"));
        EXPECT_TRUE(record.centerlines->loops.empty());
    }
}

TEST(Network, ReportComparesLoopsWithGenusAndSources) {
    Surface surface;
    const auto findings = [&](int genus, std::size_t loops, std::size_t between, bool covered) {
        surface.genus = genus;
        StageContext context(Stage::kTrace);
        report_loops(surface, std::vector<LumenLoop>(loops), between, covered, context);
        std::string codes;
        for (const Diagnostic& d : context.diagnostics()) codes += d.code + " ";
        return codes;
    };
    EXPECT_EQ(findings(0, 0, 0, true), "");
    EXPECT_EQ(findings(2, 2, 0, true), "loops_covered ");
    EXPECT_EQ(findings(2, 3, 1, true), "loops_covered ");
    EXPECT_EQ(findings(2, 2, 0, false), "loop_not_covered ");
    EXPECT_EQ(findings(2, 1, 0, true), "loops_covered loops_unlike_genus ");
    EXPECT_EQ(findings(2, 2, 1, true), "loops_covered loops_unlike_genus ");
    EXPECT_EQ(findings(1, 0, 0, false), "loops_unlike_genus ");
    EXPECT_EQ(findings(0, 1, 0, false), "loop_not_covered loops_unlike_genus ");
}

TEST(NetworkCheck, SeesFaults) {
    const ModelRecord record = test::run_pipeline(soup_of(ring), two_inlets(Topology::kNetwork));
    ASSERT_TRUE(record.centerlines) << record.failure->sentence;
    const auto faulty = [&](const std::function<void(Centerlines&)>& corrupt) {
        Centerlines lines = *record.centerlines;
        corrupt(lines);
        return !test::network_fault(lines).empty();
    };
    std::vector<std::size_t> sides;  // of the first loop
    for (std::size_t l = 0; l < record.centerlines->line_count(); ++l)
        if (record.centerlines->loop[l] == LoopId(0)) sides.push_back(l);
    ASSERT_EQ(sides.size(), 2U);
    EXPECT_FALSE(faulty([](Centerlines&) {}));
    EXPECT_TRUE(faulty([&](Centerlines& c) { c.loop[sides[0]] = {}; })) << "a line without an end";
    EXPECT_TRUE(faulty([&](Centerlines& c) { c.target[sides[0]] = EndpointId(2); })) << "a line with two ends";
    EXPECT_TRUE(faulty([&](Centerlines& c) { c.loop[sides[0]] = LoopId(1); })) << "a side of another loop";
    EXPECT_TRUE(faulty([&](Centerlines& c) { c.loop[sides[0]] = LoopId(7); })) << "a side of no loop";
    EXPECT_TRUE(faulty([&](Centerlines& c) { c.loops.push_back(c.loops[0]); })) << "a loop without lines";
    EXPECT_TRUE(faulty([&](Centerlines& c) { c.loops[0].point.x += 1e-9; })) << "a gap";
    EXPECT_TRUE(faulty([&](Centerlines& c) { c.loops[0].source = EndpointId(2); })) << "a source of no side";
    EXPECT_TRUE(faulty([&](Centerlines& c) { c.clearance[c.offsets[sides[1]]] = 0; })) << "a line outside";
    EXPECT_TRUE(faulty([&](Centerlines& c) {
        const std::size_t count = c.offsets[sides[0] + 1] - c.offsets[sides[0]];
        const std::vector<Vec3> first(c.points.begin() + c.offsets[sides[0]],
                                      c.points.begin() + c.offsets[sides[0] + 1]);
        c.points.erase(c.points.begin() + c.offsets[sides[1]], c.points.begin() + c.offsets[sides[1] + 1]);
        c.points.insert(c.points.begin() + c.offsets[sides[1]], first.begin(), first.end());
        const std::size_t before = c.offsets[sides[1] + 1] - c.offsets[sides[1]];
        for (std::size_t l = sides[1] + 1; l < c.offsets.size(); ++l)
            c.offsets[l] = static_cast<std::uint32_t>(c.offsets[l] + count - before);
        c.clearance.resize(c.points.size(), kTube);
    })) << "the same side twice";
    ModelRecord without = record;
    Centerlines lines = *record.centerlines;
    for (std::size_t l = 0; l < lines.line_count(); ++l)  // the part of the ring along -y is bare
        for (std::size_t k = lines.offsets[l]; k < lines.offsets[l + 1]; ++k)
            if (lines.points[k].y < -1) lines.points[k] = {0, kRing, 0};
    without.centerlines = std::make_shared<Centerlines>(lines);
    EXPECT_GT(test::largest_distance_to_lines(without), kCovered) << "a part of the lumen without a line";
}

}  // namespace
}  // namespace lumenline
