// Labels by a template, on trees of known branches and on what has been done to them.
#include "engine/population/labels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "engine/core/index_tables.h"
#include "tests/branches/shapes.h"
#include "tests/condition/shapes.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

using test::PlainLine;
using Strings = std::vector<std::string>;
using Map = std::function<Vec3(Vec3)>;

BranchTree tree_of(const Branches& branches) { return branch_tree(index_tables(branches, {}).front()); }

BranchLabels labelled(const Branches& model, const Branches& pattern, bool axes = false) {
    const BranchTree tree = tree_of(model), of_pattern = tree_of(pattern);
    const LabelOptions options{LabelRule::kTemplate, "t", axes};
    const std::vector<LabelledModel> models{{"m", {}, &tree}, {"t", {}, &of_pattern}};
    return label_branches(options, models).of.front();
}

Vec3 turned(Vec3 p) {
    const double c = std::cos(1.1), s = std::sin(1.1);
    const Vec3 q{c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    return {q.x, c * q.y - s * q.z, s * q.y + c * q.z};
}
Vec3 turned_back(Vec3 p) {
    const double c = std::cos(1.1), s = std::sin(1.1);
    const Vec3 q{p.x, c * p.y + s * p.z, -s * p.y + c * p.z};
    return {c * q.x + s * q.y, -s * q.x + c * q.y, q.z};
}
Vec3 mirrored(Vec3 p) { return {-p.x, p.y, p.z}; }

/// A tree phantom of four leaves through the pipeline, mapped and with some of its outlets.
Branches branches_of_tree(
    const TreePhantom& tree, const Map& map = [](Vec3 p) { return p; }, std::uint32_t seed = 0,
    std::size_t left_out = TreeBranch::kNoParent) {
    PipelineOptions options;
    for (std::size_t b = 0; b < tree.truth.branches().size(); ++b) {
        const TreeBranch& branch = tree.truth.branches()[b];
        if (branch.open_start) options.endpoints.inlets.push_back(map(branch.start));
        if (branch.open_end && b != left_out) options.endpoints.outlets.push_back(map(branch.end));
    }
    const TriangleSoup soup = testing::mapped(to_soup(tree), map);
    const ModelRecord record = test::run_pipeline(seed == 0 ? soup : testing::shuffled(soup, seed), options);
    EXPECT_TRUE(record.branches);
    return record.branches ? *record.branches : Branches();
}

/// The tree's branch that each found one is, by the middle between its nodes.
std::vector<std::size_t> identities(const TreeTruth& truth, const Branches& found, const Map& back) {
    std::vector<std::size_t> of;
    for (const auto& [first, last] : found.graph.edges)
        of.push_back(
            truth.nearest_axis(back(lerp(found.graph.position[at(first)], found.graph.position[at(last)], 0.5)))
                .branch);
    return of;
}

class PhantomLabels : public ::testing::Test {
protected:
    static TreeOptions options() {
        TreeOptions o;
        o.leaves = 4;
        o.points_around = 14;
        return o;
    }
    PhantomLabels() : tree_(make_tree(options())), pattern_(branches_of_tree(tree_)) {
        const std::vector<std::size_t> of = identities(tree_.truth, pattern_, [](Vec3 p) { return p; });
        const BranchLabels own = position_labels(tree_of(pattern_));
        label_of_.resize(tree_.truth.branches().size());
        for (std::size_t b = 0; b < of.size(); ++b) label_of_[of[b]] = own.label[b];
    }

    void expect_labels(const Branches& model, const Map& back, double least_confidence) const {
        const BranchLabels labels = labelled(model, pattern_);
        const std::vector<std::size_t> of = identities(tree_.truth, model, back);
        ASSERT_EQ(labels.label.size(), label_of_.size());
        for (std::size_t b = 0; b < of.size(); ++b) {
            EXPECT_EQ(labels.label[b], label_of_[of[b]]) << "branch " << b;
            EXPECT_GT(labels.confidence[b], least_confidence) << "branch " << b;
        }
    }

    TreePhantom tree_;
    Branches pattern_;
    Strings label_of_;  ///< of the tree's branches
};

// The siblings of the phantom differ by a tenth in length and a few percent in radius: confidences are as low as that.
TEST_F(PhantomLabels, TurnedAndShuffledInMetres) {
    const Branches other = branches_of_tree(
        tree_, [](Vec3 p) { return 1e-3 * turned(p); }, 7);
    expect_labels(
        other, [](Vec3 p) { return turned_back(1e3 * p); }, 0.02);
}

TEST_F(PhantomLabels, Mirrored) { expect_labels(branches_of_tree(tree_, mirrored), mirrored, 0.02); }

TEST_F(PhantomLabels, OfAnotherMesh) {
    TreeOptions finer = options();
    finer.points_around = 20;
    expect_labels(
        branches_of_tree(make_tree(finer)), [](Vec3 p) { return p; }, 0.02);
}

TEST_F(PhantomLabels, WithoutALeaf) {
    const auto& branches = tree_.truth.branches();
    std::size_t leaf = 0;
    while (!branches[leaf].open_end) ++leaf;
    const std::size_t parent = branches[leaf].parent;
    std::size_t sibling = 0;
    while (sibling == leaf || branches[sibling].parent != parent) ++sibling;
    const Branches less = branches_of_tree(tree_, turned, 0, leaf);
    ASSERT_EQ(less.graph.branch_count(), 5U);
    Strings expected, found = labelled(less, pattern_).label;
    for (std::size_t b = 0; b < branches.size(); ++b)
        if (b != leaf && b != sibling)
            expected.push_back(b == parent ? label_of_[parent] + "+" + label_of_[sibling] : label_of_[b]);
    std::sort(expected.begin(), expected.end());
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
    // And the other way round: the leaf has no counterpart.
    const BranchLabels more = labelled(pattern_, less);
    EXPECT_EQ(std::count(more.label.begin(), more.label.end(), ""), 1);
}

TEST(LineLabels, SixtyFourOutletsTurnedMirroredAndInAnotherOrder) {
    std::vector<PlainLine> lines = test::forked_lines(64);
    const Branches pattern = test::branches_of(lines);
    const Strings own = position_labels(tree_of(pattern)).label;
    ASSERT_EQ(own.size(), 127U);
    std::mt19937 random(5);
    std::shuffle(lines.begin(), lines.end(), random);
    for (PlainLine& line : lines)
        for (Vec3& p : line.points) p = mirrored(turned(p));
    const BranchLabels labels = labelled(test::branches_of(lines), pattern);
    EXPECT_EQ(labels.label, own);
    // The branches' lengths differ by a tenth from sibling to sibling, and so do their radii: far from alike.
    for (const double c : labels.confidence) EXPECT_GT(c, 0.05);
}

TEST(LineLabels, ANetworkIsMatchedAlongTheWaysThatReachItsNodesFirst) {
    constexpr double kPi = 3.14159265358979323846;
    const auto ring = [&] {
        PlainLine stem;
        stem.points = {{0, 0, 0}};
        stem.radius = {1};
        test::go_to(stem, {10, 0, 0}, 1, 0.1);
        stem.target = 1;
        std::vector<PlainLine> lines(3, stem);
        const auto along = [](PlainLine& line, double to) {
            const int steps = static_cast<int>(std::fabs(to) / 0.01);
            for (int k = 1; k <= steps; ++k) {
                const double a = to * k / steps;
                line.points.push_back({20 - 10 * std::cos(a), 10 * std::sin(a), 0});
                line.radius.push_back(1);
            }
        };
        along(lines[0], 2.0);
        test::go_to(lines[0], lines[0].points.back() + Vec3{4, 12, 0}, 0.8, 0.2);
        along(lines[1], kPi + 0.4);
        along(lines[2], -(kPi - 0.4));
        for (const std::size_t k : {1U, 2U}) {
            lines[k].target = Index<int>::kNoneValue;
            lines[k].loop = 0;
        }
        return lines;
    };
    std::vector<PlainLine> lines = ring();
    const Branches pattern = test::branches_of(lines);
    ASSERT_EQ(pattern.graph.branch_count(), 4U);
    for (PlainLine& line : lines)
        for (Vec3& p : line.points) p = turned(p);
    EXPECT_EQ(labelled(test::branches_of(lines), pattern).label, position_labels(tree_of(pattern)).label);
}

}  // namespace
}  // namespace lumenline
