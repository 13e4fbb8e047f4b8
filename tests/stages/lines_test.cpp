// Lines of whole closed models: which source serves which target, what happens to targets that
// nobody reaches, and what the record of a line promises.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/trace/trace.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

Phantom tube(Vec3 offset = {}) {
    PhantomOptions options;
    options.length = 80;
    options.points_around = 20;
    options.jitter = 0.2;
    options.caps = true;
    options.offset = offset;
    return make_phantom(options);
}

Vec3 on_axis(const Phantom& phantom, double share) {
    return phantom.truth.position(share * phantom.truth.total_length());
}

TEST(Centerlines, TargetInAnotherComponentIsReportedAndTheOthersSurvive) {
    const Phantom here = tube(), there = tube({100, 0, 0});
    const Surface both = test::disjoint_union(test::closed_surface(here), test::closed_surface(there));
    const test::Traced traced =
        test::trace_closed(both, {on_axis(here, 0.1)}, {on_axis(here, 0.9), on_axis(there, 0.9), on_axis(here, 0.5)});
    ASSERT_EQ(traced.lines.line_count(), 2U);
    EXPECT_EQ(traced.lines.target[0], EndpointId(1));
    EXPECT_EQ(traced.lines.target[1], EndpointId(3));
    ASSERT_TRUE(test::has_finding(traced.findings, "target_unreached"));
    std::size_t count = 0;
    for (const Diagnostic& d : traced.findings)
        if (d.code == "target_unreached") {
            ++count;
            EXPECT_EQ(d.severity, Severity::kError);
            EXPECT_NE(d.message.find("outlet 2"), std::string::npos) << d.message;
        }
    EXPECT_EQ(count, 1U);
}

TEST(Centerlines, InletThatNoOutletIsNearestToIsReported) {
    const Phantom phantom = tube();
    const Surface surface = test::closed_surface(phantom);
    const Vec3 outlet = on_axis(phantom, 0.9);
    const test::Traced two = test::trace_closed(surface, {on_axis(phantom, 0.1), on_axis(phantom, 0.3)}, {outlet});
    EXPECT_EQ(two.lines.line_count(), 1U);
    EXPECT_TRUE(test::has_finding(two.findings, "inlet_without_line"));
    const test::Traced one = test::trace_closed(surface, {on_axis(phantom, 0.1)}, {outlet});
    EXPECT_FALSE(test::has_finding(one.findings, "inlet_without_line"));
}

TEST(Centerlines, BlindVesselWithoutALineIsReported) {
    // Of the tube of 16 radii, what lies beyond the line's end is 12 or 7 radii long.
    const Phantom phantom = tube();
    const Surface surface = test::closed_surface(phantom);
    const auto is_reported = [&](double end) {
        const test::Traced traced = test::trace_closed(surface, {on_axis(phantom, 0.1)}, {on_axis(phantom, end)});
        return test::has_finding(traced.findings, "wall_without_line");
    };
    EXPECT_TRUE(is_reported(0.25));
    EXPECT_FALSE(is_reported(0.56));
}

TEST(Centerlines, WithoutAnyLineTheModelFails) {
    const Phantom here = tube(), there = tube({100, 0, 0});
    const Surface both = test::disjoint_union(test::closed_surface(here), test::closed_surface(there));
    try {
        test::trace_closed(both, {on_axis(here, 0.1)}, {on_axis(there, 0.9)});
        FAIL() << "there is no way between two components";
    } catch (const StageError& error) {
        EXPECT_EQ(error.code(), ErrorCode::kNoLineTraced);
        EXPECT_EQ(error.stage(), Stage::kTrace);
    }
}

TEST(Centerlines, FourInletsServeEachTargetFromTheNearest) {
    const Phantom phantom = tube();
    const std::vector<Vec3> inlets{on_axis(phantom, 0.1), on_axis(phantom, 0.35), on_axis(phantom, 0.6),
                                   on_axis(phantom, 0.9)};
    const std::vector<Vec3> outlets{on_axis(phantom, 0.17), on_axis(phantom, 0.28), on_axis(phantom, 0.44),
                                    on_axis(phantom, 0.52), on_axis(phantom, 0.7),  on_axis(phantom, 0.82)};
    const Surface surface = test::closed_surface(phantom);
    const test::Traced nearest = test::trace_closed(surface, inlets, outlets);
    ASSERT_EQ(nearest.lines.line_count(), outlets.size());
    const std::vector<std::size_t> expected{0, 1, 1, 2, 2, 3};
    for (std::size_t i = 0; i < outlets.size(); ++i) {
        EXPECT_EQ(nearest.lines.source[i], EndpointId(expected[i])) << "outlet " << i;
        EXPECT_EQ(nearest.lines.target[i], EndpointId(4 + i));
    }

    TraceOptions all_pairs;
    all_pairs.pairs = Pairs::kAll;
    const test::Traced all = test::trace_closed(surface, inlets, outlets, all_pairs);
    ASSERT_EQ(all.lines.line_count(), 24U);
    for (std::size_t i = 0; i < 24; ++i) {
        EXPECT_EQ(all.lines.target[i], EndpointId(4 + i / 4));
        EXPECT_EQ(all.lines.source[i], EndpointId(i % 4));
    }
}

TEST(Centerlines, ArraysOfALineBelongTogether) {
    const Phantom phantom = tube();
    const Surface surface = test::closed_surface(phantom);
    const test::Traced traced =
        test::trace_closed(surface, {on_axis(phantom, 0.1)}, {on_axis(phantom, 0.9), on_axis(phantom, 0.5)});
    const Centerlines& lines = traced.lines;
    ASSERT_EQ(lines.offsets.size(), 3U);
    ASSERT_EQ(lines.path.offsets.size(), 3U);
    for (const std::size_t size :
         {lines.ball_radius.size(), lines.clearance.size(), lines.radius.size(), lines.abscissa.size()})
        EXPECT_EQ(size, lines.points.size());
    EXPECT_EQ(lines.offsets.back(), lines.points.size());
    EXPECT_EQ(lines.path.offsets.back(), lines.path.points.size());
    for (std::size_t l = 0; l < 2; ++l) {
        const auto points = test::part(lines.points, lines.offsets, l);
        const auto abscissa = test::part(lines.abscissa, lines.offsets, l);
        EXPECT_EQ(abscissa.front(), 0);
        for (std::size_t i = 0; i + 1 < points.size(); ++i)
            EXPECT_NEAR(abscissa[i + 1] - abscissa[i], distance(points[i], points[i + 1]), 1e-12);
        EXPECT_EQ(points.front(), traced.endpoints[at(lines.source[l])].anchor);
        EXPECT_EQ(points.back(), traced.endpoints[at(lines.target[l])].anchor);
        const auto map = test::part(lines.path.line_abscissa, lines.path.offsets, l);
        for (std::size_t i = 0; i + 1 < map.size(); ++i) EXPECT_LE(map[i], map[i + 1]);
        EXPECT_EQ(map.front(), 0);
        EXPECT_EQ(map.back(), abscissa.back());
    }
}

TEST(Centerlines, UnrefinedLineIsTheTracedPathAndTheRefinedOneIsNoCostlier) {
    const Phantom phantom = tube();
    const Surface surface = test::closed_surface(phantom);
    TraceOptions plain;
    plain.refine = Refinement::kNone;
    const auto inlet = {on_axis(phantom, 0.1)}, outlet = {on_axis(phantom, 0.9)};
    const test::Traced traced = test::trace_closed(surface, inlet, outlet, plain);
    const test::Traced relaxed = test::trace_closed(surface, inlet, outlet);
    EXPECT_NE(traced.lines.points, relaxed.lines.points);
    // In a straight tube the radius hardly varies: the cheaper path is the shorter one, but for its
    // variation of 1e-3.
    EXPECT_LT(relaxed.lines.abscissa.back(), traced.lines.abscissa.back() * (1 + 1e-4));
}

}  // namespace
}  // namespace lumenline
