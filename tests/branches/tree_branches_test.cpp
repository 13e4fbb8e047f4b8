// Branches of a tree of known axes, also after what must not change them.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/branches/shapes.h"
#include "tests/condition/shapes.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

using test::tree_model;

TEST(TreeBranches, MeasuresAreThoseOfTheAxes) {
    const test::TreeModel model = tree_model({});
    test::expect_branches_of_tree(model.tree.truth, model.branches);
    // The own parts of straight cones: frusta, but for the half edge by which sites are assigned at either end, and
    // polygons of 20 corners, whose area is 1.6 % less.
    for (std::size_t b = 0; b < model.branches.graph.branch_count(); ++b) {
        const BranchTable& t = model.branches.table;
        const double r = t.radius[b].mean, length = t.own_length[b];
        EXPECT_NEAR(t.wall_area[b] / (2 * std::numbers::pi * r * length), 1, 0.04);
        EXPECT_NEAR(t.volume[b] / (std::numbers::pi * r * r * length), 1, 0.05);
        EXPECT_NEAR(t.area[b].mean / (std::numbers::pi * r * r), 1, 0.03);
        EXPECT_NEAR(t.geodesic_distance[b] / r, 1, 0.02);
    }
    for (const std::uint8_t closed : model.branches.sections.closed) EXPECT_EQ(closed, 1);
}

/// The tree turned and moved, its points and triangles in another order.
TriangleSoup moved(const TreePhantom& tree, double angle, Vec3 shift, double scale, bool shuffle) {
    TriangleSoup soup = to_soup(tree);
    for (Vec3& p : soup.points) {
        const Vec3 q{std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y, p.z};
        p = scale *
            (Vec3{q.x, std::cos(angle) * q.y - std::sin(angle) * q.z, std::sin(angle) * q.y + std::cos(angle) * q.z} +
             shift);
    }
    return shuffle ? testing::shuffled(soup, 5) : soup;
}

/// The pipeline, with the largest opening as the inlet.
Branches branches_from(const TriangleSoup& soup) {
    const ModelRecord record = test::run_pipeline(soup);
    EXPECT_TRUE(record.branches);
    return record.branches ? *record.branches : Branches();
}

TEST(TreeBranches, PlaceSizeAndOrderOfTheMeshChangeNothing) {
    TreeOptions options;
    options.leaves = 4;
    options.points_around = 16;
    const TreePhantom tree = make_tree(options);
    const Branches plain = branches_from(to_soup(tree));
    const double scale = 1e-3;
    const Branches other = branches_from(moved(tree, 0.7, {30, -80, 11}, scale, true));
    ASSERT_EQ(plain.graph.branch_count(), 7U);
    ASSERT_EQ(other.graph.branch_count(), 7U);
    EXPECT_EQ(plain.graph.edges, other.graph.edges);
    for (std::size_t b = 0; b < 7; ++b) {
        // Sites in another order give the openings other extensions and junctions other curved patches: seen up to
        // 3e-4 of the radius, 2e-4 of the length.
        EXPECT_NEAR(other.table.length[b] / (scale * plain.table.length[b]), 1, 1e-3);
        EXPECT_NEAR(other.table.radius[b].mean / (scale * plain.table.radius[b].mean), 1, 1e-3);
        EXPECT_NEAR(other.table.wall_area[b] / (scale * scale * plain.table.wall_area[b]), 1, 1e-3);
        EXPECT_NEAR(other.table.taper[b], plain.table.taper[b], 1e-4);
    }
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(other.bifurcations.angle_1[k], plain.bifurcations.angle_1[k], 0.05);
        EXPECT_NEAR(other.bifurcations.angle_2[k], plain.bifurcations.angle_2[k], 0.05);
    }
}

TEST(TreeBranches, AnotherMeshGivesTheSameBranches) {
    TreeOptions options;
    options.leaves = 4;
    for (const int points : {14, 22}) {
        options.points_around = points;
        const test::TreeModel model = tree_model(options);
        test::expect_branches_of_tree(model.tree.truth, model.branches);
    }
}

}  // namespace
}  // namespace lumenline
