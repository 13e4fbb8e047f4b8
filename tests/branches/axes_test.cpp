// Curvature, torsion and frames of curves with known ones, at the default step and smoothing: within 1 %.
#include "engine/branches/axes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/branches/shapes.h"

namespace lumenline {
namespace {

using std::numbers::pi;

/// One line along a curve, points a quarter of the radius apart.
Branches axis_of(const std::function<Vec3(double)>& curve, double end, double radius, double step = 0.25) {
    test::PlainLine line;
    const int count = static_cast<int>(end / (step * radius));
    for (int k = 0; k <= count; ++k) {
        line.points.push_back(curve(end * k / count));
        line.radius.push_back(radius);
    }
    line.target = 1;
    return test::branches_of({line});
}

Vec3 on_helix(double s, double a, double rise) {
    const double speed = std::hypot(a, rise), t = s / speed;
    return {a * std::cos(t), a * std::sin(t), rise * t};
}

void expect_helix(double a, double rise) {
    const double k2 = a * a + rise * rise;
    const Branches found = axis_of([&](double s) { return on_helix(s, a, rise); }, 2 * pi * std::sqrt(k2), 5);
    const BranchLines& axis = found.lines;
    for (std::size_t k = 0; k < axis.points.size(); ++k) {
        // The last window at either end reaches past it: it is moved inside, and of lower degree.
        const bool inner = axis.abscissa[k] > 10 && axis.abscissa[k] < axis.length(0) - 10;
        EXPECT_NEAR(axis.curvature[k] * k2 / a, 1, inner ? 0.01 : 0.1);
        if (inner) {
            EXPECT_NEAR(axis.torsion[k] * k2, rise, rise != 0 ? 0.01 * std::fabs(rise) : 0.01 * a);
        }
        EXPECT_NEAR(dot(axis.normal[k], axis.tangent[k]), 0, 1e-9);
    }
    EXPECT_NEAR(found.table.curvature[0].median * k2 / a, 1, 0.01);
}

TEST(Axes, CircleHasItsCurvatureAndNoTorsion) { expect_helix(20, 0); }
TEST(Axes, HelixHasItsCurvatureAndTorsion) {
    expect_helix(20, 10);
    expect_helix(20, -10);
}

TEST(Axes, StraightLineHasNoTorsionAndNoNormal) {
    const Branches found = axis_of([](double s) { return Vec3{s, 2 * s, -s}; }, 40, 1);
    for (std::size_t k = 0; k < found.lines.points.size(); ++k) {
        EXPECT_LT(found.lines.curvature[k], 1e-9);
        EXPECT_TRUE(std::isnan(found.lines.torsion[k]));
        EXPECT_TRUE(std::isnan(found.lines.normal[k].x));
    }
    EXPECT_TRUE(std::isnan(found.table.torsion[0].mean));
    EXPECT_NEAR(found.table.length_over_chord[0], 1, 1e-12);
}

TEST(Axes, FewPointsGiveWhatTheyCan) {
    test::PlainLine line;
    line.points = {{0, 0, 0}, {1, 0, 0}};
    line.radius = {1, 1};
    line.target = 1;
    const Branches found = test::branches_of({line});
    ASSERT_EQ(found.graph.branch_count(), 1U);
    EXPECT_EQ(found.table.length[0], 1);
    EXPECT_TRUE(std::isnan(found.table.curvature[0].mean)) << "two points have no curvature, not none";
    EXPECT_NEAR(found.lines.tangent[0].x, 1, 1e-12);
}

TEST(Axes, FramesDoNotTurnAboutTheAxis) {
    // Against Frenet's frame one carried along turns by minus the integral of the torsion.
    const double a = 20, rise = 10, k2 = a * a + rise * rise, end = 2 * pi * std::sqrt(k2);
    const Branches found = axis_of([&](double s) { return on_helix(s, a, rise); }, end, 5);
    const BranchLines& axis = found.lines;
    const auto angle = [&](std::size_t k) {
        const double t = axis.abscissa[k] / std::sqrt(k2);
        const Vec3 normal{-std::cos(t), -std::sin(t), 0};
        return std::atan2(dot(cross(normal, axis.frame[k]), axis.tangent[k]), dot(normal, axis.frame[k]));
    };
    for (std::size_t k = 0; k < axis.points.size(); ++k) {
        EXPECT_NEAR(norm(axis.frame[k]), 1, 1e-12);
        EXPECT_NEAR(dot(axis.frame[k], axis.tangent[k]), 0, 1e-9);
        const double turned = std::remainder(angle(k) - angle(0) + rise / k2 * axis.abscissa[k], 2 * pi);
        EXPECT_NEAR(turned, 0, 0.02);  // of 2.8 in all; tangents at the ends are of lower degree
    }
}

TEST(Axes, AngleZeroPointsAtTheSibling) {
    test::PlainLine root;
    root.points = {{0, 0, 0}};
    root.radius = {1};
    test::go_to(root, {0, 0, 10}, 1, 0.2);
    std::vector<test::PlainLine> lines(2, root);
    test::go_to(lines[0], {12, 0, 22}, 0.8, 0.2);
    test::go_to(lines[1], {-8, 0, 18}, 0.8, 0.2);
    lines[0].target = 1;
    lines[1].target = 2;
    const Branches found = test::branches_of(lines);
    const BranchLines& axis = found.lines;
    const double half = std::sqrt(0.5);
    const auto expect_near = [](Vec3 a, Vec3 b) { EXPECT_LT(distance(a, b), 0.02) << a.x << " " << a.y << " " << a.z; };
    expect_near(axis.frame[axis.offsets[1] - 1], {1, 0, 0});  // the root's end: its first child
    expect_near(axis.frame[axis.offsets[1]], {-half, 0, half});
    expect_near(axis.frame[axis.offsets[2]], {half, 0, half});
    // Children in line give no direction across each other: then it is the parent's.
    const Branches fork = test::branches_of(test::forked_lines(2));
    expect_near(fork.lines.frame[fork.lines.offsets[1]], {0, 0, -1});
}

TEST(Axes, CheckSeesAWrongCurve) {
    const Branches found = axis_of([](double s) { return on_helix(s, 20, 10); }, 100, 5);
    const double k2 = 20 * 20 + 11 * 11;  // of another helix
    EXPECT_GT(std::fabs(found.table.curvature[0].median * k2 / 20 - 1), 0.01);
}

}  // namespace
}  // namespace lumenline
