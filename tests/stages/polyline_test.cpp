#include "engine/trace/polyline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/stages/support.h"

namespace lumenline {
namespace {

/// Along x from 0 to 10 in steps of 1, with radius 2.
Polyline straight_line() {
    Polyline line;
    for (int i = 0; i <= 10; ++i) line.append({static_cast<double>(i), 0, 0}, 2);
    return line;
}

void expect_consistent(const Polyline& line) {
    ASSERT_EQ(line.points.size(), line.radius.size());
    ASSERT_EQ(line.points.size(), line.abscissa.size());
    for (std::size_t i = 0; i < line.size(); ++i)
        EXPECT_NEAR(line.abscissa[i], i == 0 ? 0 : line.abscissa[i - 1] + distance(line.points[i - 1], line.points[i]),
                    1e-14);
}

TEST(CutAtPlane, FrontIsCutWhereTheLineFirstPassesInside) {
    Polyline line = straight_line();
    // Outward at the front is -x: what is before x = 2.5 goes.
    EXPECT_DOUBLE_EQ(cut_at_plane(line, {2.5, 7, -3}, {-1, 0, 0}, true), 2.5);
    expect_consistent(line);
    EXPECT_EQ(line.points.front(), (Vec3{2.5, 0, 0}));
    EXPECT_EQ(line.points[1], (Vec3{3, 0, 0}));
    EXPECT_EQ(line.points.back(), (Vec3{10, 0, 0}));
    EXPECT_EQ(line.size(), 9U);
    EXPECT_DOUBLE_EQ(line.abscissa.back(), 7.5);
    // Between two balls of radius 2 at a distance of 1: R^2 = 4 - 1/4.
    EXPECT_DOUBLE_EQ(line.radius.front(), std::sqrt(3.75));
}

TEST(CutAtPlane, BackIsCutWhereTheLineLastIsInside) {
    Polyline line = straight_line();
    EXPECT_DOUBLE_EQ(cut_at_plane(line, {8.25, 0, 0}, {1, 0, 0}, false), 1.75);
    expect_consistent(line);
    EXPECT_EQ(line.points.front(), (Vec3{0, 0, 0}));
    EXPECT_EQ(line.points.back(), (Vec3{8.25, 0, 0}));
    EXPECT_DOUBLE_EQ(line.abscissa.back(), 8.25);
}

TEST(CutAtPlane, CutOffAndRemainingLengthsSumToTheWhole) {
    test::Random random(22);
    for (int i = 0; i < 500; ++i) {
        Polyline line;
        Vec3 x;
        for (int k = 0; k < 20; ++k) line.append(x += random.in_box({-0.2, -0.5, -0.5}, {1, 0.5, 0.5}), 1);
        const double whole = line.abscissa.back();
        const Vec3 origin = random.in_box({-1, -1, -1}, {9, 1, 1}), normal = random.direction();
        const bool front = random.below(2) == 0;
        const double cut = cut_at_plane(line, origin, normal, front);
        EXPECT_GE(cut, 0);
        EXPECT_NEAR(cut + (line.size() > 0 ? line.abscissa.back() : 0), whole, 1e-13);
        expect_consistent(line);
        if (line.size() == 0) continue;
        const Vec3 end = front ? line.points.front() : line.points.back();
        EXPECT_LE(dot(end - origin, normal), 1e-13);  // the crossing is rounded once
    }
}

TEST(CutAtPlane, EndThatIsInsideAlreadyIsKept) {
    Polyline line = straight_line();
    EXPECT_EQ(cut_at_plane(line, {-1, 0, 0}, {-1, 0, 0}, true), 0);
    EXPECT_EQ(cut_at_plane(line, {0, 0, 0}, {-1, 0, 0}, true), 0) << "in the plane";
    EXPECT_EQ(cut_at_plane(line, {12, 0, 0}, {1, 0, 0}, false), 0);
    EXPECT_EQ(line.points, straight_line().points);
}

TEST(CutAtPlane, LineThatNeverGetsInsideVanishes) {
    for (const bool front : {true, false}) {
        Polyline line = straight_line();
        EXPECT_DOUBLE_EQ(cut_at_plane(line, {0, 0, -1}, {0, 0, 1}, front), 10);
        EXPECT_EQ(line.size(), 0U);
    }
    Polyline nothing;
    EXPECT_EQ(cut_at_plane(nothing, {0, 0, 0}, {1, 0, 0}, true), 0);
}

TEST(CutAtPlane, OnlyTheStretchFromTheEndToTheFirstPassageIsCut) {
    // Out, in, out again and in: the later excursion stays.
    Polyline line;
    for (const double z : {1.0, -1.0, 1.0, -1.0, -2.0}) line.append({static_cast<double>(line.size()), 0, z}, 1);
    cut_at_plane(line, {0, 0, 0}, {0, 0, 1}, true);
    expect_consistent(line);
    ASSERT_EQ(line.size(), 5U);
    EXPECT_EQ(line.points.front(), (Vec3{0.5, 0, 0}));
    EXPECT_EQ(line.points[2], (Vec3{2, 0, 1}));
}

TEST(CutAtPlane, CutAtAPointOfTheLineKeepsThatPoint) {
    Polyline line = straight_line();
    EXPECT_DOUBLE_EQ(cut_at_plane(line, {4, 0, 0}, {-1, 0, 0}, true), 4);
    expect_consistent(line);
    EXPECT_EQ(line.points.front(), (Vec3{4, 0, 0}));
    EXPECT_DOUBLE_EQ(line.abscissa.back(), 6);
}

TEST(SharpestTurn, IsFoundWithItsPlace) {
    Polyline line;
    for (const Vec3 x :
         {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{2, 0, 0}, Vec3{2.5, 0.5, 0}, Vec3{2, 0.5, 0}, Vec3{1, 0.5, 0}})
        line.append(x, 1);
    const Turn turn = sharpest_turn(line);
    EXPECT_NEAR(turn.cosine, -std::sqrt(0.5), 1e-15);
    EXPECT_EQ(turn.at, (Vec3{2.5, 0.5, 0}));
}

TEST(SharpestTurn, StraightAndShortLinesHaveNone) {
    Polyline line;
    EXPECT_EQ(sharpest_turn(line).cosine, 1);
    for (int i = 0; i < 4; ++i) line.append({0.3 * i, 0.4 * i, 0}, 1);
    EXPECT_NEAR(sharpest_turn(line).cosine, 1, 1e-15);
}

}  // namespace
}  // namespace lumenline
