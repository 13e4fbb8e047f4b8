// Splitting of lines that come from no surface, so that their truth is known and any graph can be had.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/branches/partings.h"
#include "engine/branches/split.h"
#include "tests/branches/shapes.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

using test::branches_of;
using test::PlainLine;

PlainLine straight(Vec3 from, Vec3 to, double radius) {
    PlainLine line;
    line.points = {from};
    line.radius = {radius};
    test::go_to(line, to, radius, 0.2 * radius);
    return line;
}

/// A side branch at right angles from a straight vessel.
std::vector<PlainLine> side_branch() {
    PlainLine trunk = straight({0, 0, 0}, {24, 0, 0}, 1), side = straight({0, 0, 0}, {10, 0, 0}, 1);
    test::go_to(side, {10, 10, 0}, 0.5, 0.1);
    trunk.target = 1;
    side.target = 2;
    return {trunk, side};
}

TEST(Partings, SideBranchLeavesTheTubeAtItsWall) {
    const Centerlines lines = test::centerlines_of(side_branch());
    const std::vector<LineView> views = views_of(lines);
    const Parting side = part(views[1], views[0]), trunk = part(views[0], views[1]);
    ASSERT_TRUE(side.leaves && trunk.leaves);
    EXPECT_NEAR(side.exit, 11, 0.01);  // one radius of the trunk, found between points
    // From the exit (10, 1, 0) back to where a ball of radius .95 or so reaches it.
    const Vec3 touch = views[1].position(side.touch);
    EXPECT_NEAR(distance(touch, {10, 1, 0}), views[1].radius_at(side.touch), 1e-2);
    EXPECT_NEAR(trunk.exit, 11, 0.05);  // the tube of the side branch ends in the trunk's last common ball
    EXPECT_NEAR(trunk.exit - trunk.touch, 1, 0.01);
}

TEST(Split, SideBranchHasItsOriginOnTheTrunk) {
    const Branches found = branches_of(side_branch());
    ASSERT_EQ(found.graph.branch_count(), 3U);
    ASSERT_EQ(found.bifurcations.rows(), 1U);
    // The axes meet in (10, 0, 0); the hold to the mean of touching points and exits moves it by a twentieth of that.
    EXPECT_LT(distance(found.bifurcations.origin[0], {10, 0, 0}), 0.1);
    EXPECT_NEAR(found.bifurcations.angle_1[0], 0, 0.1);
    EXPECT_NEAR(found.bifurcations.angle_2[0], 90, 0.1);
    EXPECT_NEAR(found.table.length[0], 10, 0.1);
    EXPECT_NEAR(found.table.length[1], 14, 0.1);
    EXPECT_NEAR(found.table.length[2], 10, 0.1);
}

/// A narrow branch of `length` at right angles: the balls of its line follow the wall, on its way to which the line
/// cuts the corner.
std::vector<PlainLine> narrow_side_branch(double length) {
    PlainLine trunk = straight({0, 0, 0}, {24, 0, 0}, 1), side = straight({0, 0, 0}, {9, 0, 0}, 1);
    test::go_to(side, {10, 0.7, 0}, 0.3, 0.05);
    test::go_to(side, {10, length, 0}, 0.3, 0.05);
    trunk.target = 1;
    side.target = 2;
    return {trunk, side};
}

TEST(Split, LengthOfASideBranchChangesNothingOfItsParent) {
    for (const double length : {6.0, 30.0}) {
        const Branches found = branches_of(narrow_side_branch(length));
        ASSERT_EQ(found.bifurcations.rows(), 1U);
        const BifurcationTable& j = found.bifurcations;
        const bool side_is_first = length > 15;  // the extent of the trunk's rest
        EXPECT_NEAR(side_is_first ? j.angle_2[0] : j.angle_1[0], 0, 1e-9);
        EXPECT_NEAR(side_is_first ? j.angle_1[0] : j.angle_2[0], 90, 1e-9);
        EXPECT_NEAR(j.parent_diameter[0], 2, 1e-9);
        EXPECT_NEAR(found.table.radius[0].min, 1, 1e-9) << "its axis is the trunk's";
        EXPECT_NEAR(found.stenoses.ecst_diameter[0], 0, 1e-9);
        EXPECT_LT(found.table.tortuosity[0], 1e-3) << "the origin is held to the corner's points";
    }
}

TEST(Split, TreesOfManyOutletsHaveTheirBranches) {
    for (const std::size_t leaves : {1, 2, 16, 128}) {
        const Branches found = branches_of(test::forked_lines(leaves));
        EXPECT_EQ(found.graph.branch_count(), 2 * leaves - 1);
        EXPECT_EQ(found.bifurcations.rows(), leaves - 1);
        EXPECT_EQ(found.graph.node_count(), 2 * leaves);
        for (const std::uint32_t n : found.bifurcations.children) EXPECT_EQ(n, 2U);
    }
}

TEST(Split, OrderOfTheLinesDoesNotMatter) {
    const std::vector<PlainLine> lines = test::forked_lines(32);
    const Branches plain = branches_of(lines);
    std::mt19937 random(3);
    for (int trial = 0; trial < 4; ++trial) {
        std::vector<PlainLine> other = lines;
        std::shuffle(other.begin(), other.end(), random);
        const Branches found = branches_of(other);
        EXPECT_EQ(found.graph.edges, plain.graph.edges);
        EXPECT_EQ(found.graph.endpoint, plain.graph.endpoint);
        ASSERT_EQ(found.graph.node_count(), plain.graph.node_count());
        // Sums over the lines of a junction run in another order: the last bits differ.
        for (std::size_t n = 0; n < found.graph.node_count(); ++n)
            EXPECT_LT(distance(found.graph.position[n], plain.graph.position[n]), 1e-12);
    }
}

TEST(Split, CloseSideBranchesAreOneJunction) {
    std::vector<PlainLine> lines = side_branch();
    PlainLine other = straight({0, 0, 0}, {10.3, 0, 0}, 1);
    test::go_to(other, {10.3, -10, 0}, 0.5, 0.1);
    other.target = 3;
    lines.push_back(other);
    const Branches found = branches_of(lines);
    EXPECT_EQ(found.graph.branch_count(), 4U);
    ASSERT_EQ(found.bifurcations.rows(), 1U);
    EXPECT_EQ(found.bifurcations.children[0], 3U);
    // Each child has a row of its own.
    const ChildTable& c = found.children;
    EXPECT_EQ(c.child, (std::vector<BranchId>{BranchId(1), BranchId(2), BranchId(3)}));
    EXPECT_EQ(c.parent, std::vector<BranchId>(3, BranchId(0)));
    EXPECT_NEAR(c.angle[0], 0, 1) << "the trunk goes straight on";
    for (const std::size_t k : {1U, 2U}) {
        EXPECT_NEAR(c.angle[k], 90, 1);
        EXPECT_NEAR(c.diameter[k], 2, 0.01) << "the radius goes from one at the node to a half at the end";
        EXPECT_NEAR(c.share[k], 1.0 / 3, 0.01);
    }
    EXPECT_NEAR(c.in_plane[1] + c.in_plane[2], 0, 2) << "on both sides";
}

TEST(Split, LineWithinAnotherHasNoBranch) {
    std::vector<PlainLine> lines = side_branch();
    PlainLine within = straight({0, 0, 0}, {14, 0.1, 0}, 1);
    within.target = 3;
    lines.push_back(within);
    StageContext context(Stage::kBranches);
    const Branches found = find_branches(Surface(), test::centerlines_of(lines), nullptr, {}, context);
    EXPECT_EQ(found.graph.branch_count(), 3U);
    EXPECT_TRUE(test::has_finding(context.diagnostics(), "line_within_another"));
    EXPECT_TRUE(test::has_finding(context.diagnostics(), "section_not_found")) << "there is no surface";
    EXPECT_TRUE(std::isnan(found.sections.area.front()));
    EXPECT_EQ(found.sections.closed.front(), 0);
    const std::size_t last = found.points.branch.size() - 1;  // of the line that is left out
    EXPECT_EQ(found.points.branch[last], BranchId(1));
    EXPECT_NEAR(found.points.branch_abscissa[last], 4, 0.2);
}

TEST(Split, LinesThatPartAtTheInletLeaveARootWithoutMeasures) {
    std::vector<PlainLine> lines{straight({0, 0, 0}, {12, 0, 0}, 1), straight({0, 0, 0}, {0, 10, 0}, 1)};
    lines[0].target = 1;
    lines[1].target = 2;
    StageContext context(Stage::kBranches);
    const Branches found = find_branches(Surface(), test::centerlines_of(lines), nullptr, {}, context);
    ASSERT_EQ(found.graph.branch_count(), 3U);
    EXPECT_TRUE(test::has_finding(context.diagnostics(), "branch_without_own_part"));
    EXPECT_TRUE(test::has_finding(context.diagnostics(), "measures_not_known"));
    EXPECT_EQ(found.table.own_length[0], 0);
    for (const double missing :
         {found.table.taper[0], found.table.radius[0].mean, found.table.curvature[0].mean, found.stenoses.diameter[0],
          found.dilations.ratio[0], found.bifurcations.area_ratio[0], found.bifurcations.murray_exponent[0]})
        EXPECT_TRUE(std::isnan(missing));
    EXPECT_NEAR(found.bifurcations.angle_between[0], 90, 0.1);
    EXPECT_FALSE(std::isnan(found.lines.frame[found.lines.offsets[1]].x));
}

/// A ring with a stem and a way out; its far side is closed by two lines that meet off the middle.
std::vector<PlainLine> ring_with_stem() {
    const auto along = [](PlainLine& line, double from, double to) {
        const int steps = 200;
        for (int k = 1; k <= steps; ++k) {
            const double a = std::lerp(from, to, static_cast<double>(k) / steps);
            line.points.push_back({20 - 10 * std::cos(a), 10 * std::sin(a), 0});
            line.radius.push_back(1);
        }
    };
    constexpr double kPi = 3.14159265358979323846;
    std::vector<PlainLine> lines(3, straight({0, 0, 0}, {10, 0, 0}, 1));
    along(lines[0], 0, 2.0);  // leaves the ring at the angle 2
    test::go_to(lines[0], lines[0].points.back() + Vec3{4, 12, 0}, 0.8, 0.2);
    lines[0].target = 1;
    along(lines[1], 0, kPi + 0.4);
    along(lines[2], 0, -(kPi - 0.4));
    lines[1].loop = lines[2].loop = 0;
    return lines;
}

TEST(Calibre, AVesselNarrowestAtItsEndHasNoDistalReference) {
    PlainLine line = straight({0, 0, 0}, {20, 0, 0}, 1);
    line.target = 1;
    for (std::size_t k = 0; k < line.points.size(); ++k)  // a cone with a waist in its last radius
        line.radius[k] = 1 - 0.01 * line.points[k].x - 0.2 * std::max(0.0, line.points[k].x - 19);
    const Branches found = branches_of({line});
    ASSERT_EQ(found.stenoses.abscissa.size(), 1U);
    EXPECT_NEAR(found.stenoses.abscissa[0], 20, 0.01);
    EXPECT_NEAR(found.stenoses.ecst_diameter[0], 0.2 / 0.8, 0.02);
    EXPECT_TRUE(std::isnan(found.stenoses.nascet_diameter[0])) << "not the degree 0 against itself";
    EXPECT_TRUE(std::isnan(found.stenoses.nascet_area[0]));
}

TEST(Calibre, AnOwnPartOfFewPointsHasNoFit) {
    PlainLine line = straight({0, 0, 0}, {0.5, 0, 0}, 1);
    line.target = 1;
    const Branches found = branches_of({line});
    for (const double value : {found.stenoses.ecst_diameter[0], found.stenoses.diameter[0], found.dilations.ratio[0]})
        EXPECT_TRUE(std::isnan(value));
}

TEST(Split, LoopIsAGraphWithACycle) {
    const Branches found = branches_of(ring_with_stem());
    // Stem, upper way to the exit, exit, and the rest of the ring, which two lines close.
    ASSERT_EQ(found.graph.branch_count(), 4U);
    EXPECT_EQ(found.graph.node_count(), 4U);
    EXPECT_EQ(found.bifurcations.rows(), 2U);
    double ring = 0;
    std::size_t closing = 4;
    for (std::size_t b = 0; b < 4; ++b) {
        const auto [first, last] = found.graph.edges[b];
        if (found.graph.junction[at(first)].is_none() || found.graph.junction[at(last)].is_none()) continue;
        ring += found.table.length[b];
        if (found.table.length[b] > 30) closing = b;
    }
    EXPECT_NEAR(ring / (2 * 3.14159265 * 10), 1, 0.03);  // straight in its junctions
    ASSERT_LT(closing, 4U);
    EXPECT_NEAR(found.table.curvature[closing].median, 0.1, 0.001);
    // Points of both lines, walked towards where they meet, come to one place of the branch.
    const std::size_t end_1 = found.pieces.offsets[2] - 1, end_2 = found.pieces.offsets[3] - 1;
    EXPECT_EQ(found.pieces.branch[end_1], BranchId(closing));
    EXPECT_EQ(found.pieces.branch[end_2], BranchId(closing));
    EXPECT_NEAR(found.pieces.branch_to[end_1], found.pieces.branch_to[end_2], 1e-9);
}

TEST(Split, TwoInletsWithAllPairsShareTheWayOut) {
    PlainLine a = straight({-10, 10, 0}, {0, 0, 0}, 1), b = straight({-10, -10, 0}, {0, 0, 0}, 1);
    std::vector<PlainLine> lines;
    for (std::size_t source = 0; source < 2; ++source)
        for (const std::size_t target : {2, 3}) {
            PlainLine line = source == 0 ? a : b;
            test::go_to(line, {15, 0, 0}, 1, 0.2);
            test::go_to(line, {25, target == 2 ? 10.0 : -9.0, 0}, 0.8, 0.2);
            line.source = source;
            line.target = target;
            lines.push_back(line);
        }
    const Branches found = branches_of(lines);
    EXPECT_EQ(found.graph.branch_count(), 5U);
    EXPECT_EQ(found.bifurcations.rows(), 2U);
    EXPECT_EQ(found.table.line_count, (std::vector<std::uint32_t>{2, 4, 2, 2, 2}));
}

TEST(Split, PiecesCoverEachLine) {
    for (const std::vector<PlainLine>& lines : {side_branch(), ring_with_stem(), test::forked_lines(16)}) {
        const Centerlines all = test::centerlines_of(lines);
        const Branches found = branches_of(lines);
        const LinePieces& p = found.pieces;
        for (std::size_t i = 0; i < lines.size(); ++i) {
            double reached = 0;
            for (std::size_t k = p.offsets[i]; k < p.offsets[i + 1]; ++k) {
                EXPECT_NEAR(p.from[k], reached, 1e-9);
                EXPECT_GT(p.to[k], p.from[k]);
                const double length = found.lines.length(at(p.branch[k]));
                for (const double s : {p.branch_from[k], p.branch_to[k]}) {
                    EXPECT_GE(s, -1e-9);
                    EXPECT_LE(s, length + 1e-9);
                }
                reached = p.to[k];
            }
            EXPECT_EQ(reached, views_of(all)[i].length());
        }
    }
}

}  // namespace
}  // namespace lumenline
