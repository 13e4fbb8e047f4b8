// Correspondence on trees of numbers alone: assignment against all permutations, trees against changed copies of
// themselves.
#include "engine/population/labels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "engine/population/assignment.h"
#include "engine/population/tree_matching.h"

namespace lumenline {
namespace {

using Strings = std::vector<std::string>;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Least cost by trying everything.
double tried(const std::vector<double>& pair, const std::vector<double>& a, const std::vector<double>& b, std::size_t i,
             std::vector<bool>& taken) {
    if (i == a.size()) {
        double rest = 0;
        for (std::size_t j = 0; j < b.size(); ++j) rest += taken[j] ? 0 : b[j];
        return rest;
    }
    double least = a[i] + tried(pair, a, b, i + 1, taken);
    for (std::size_t j = 0; j < b.size(); ++j) {
        if (taken[j]) continue;
        taken[j] = true;
        least = std::min(least, pair[i * b.size() + j] + tried(pair, a, b, i + 1, taken));
        taken[j] = false;
    }
    return least;
}

TEST(Assignment, IsTheLeastOfAll) {
    std::mt19937_64 random(3);
    const auto uniform = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<double> a(random() % 5), b(random() % 5), pair(a.size() * b.size());
        for (std::vector<double>* values : {&a, &b, &pair})
            for (double& v : *values) v = uniform();
        std::vector<bool> taken(b.size(), false);
        const Assignment found = assign(pair, a, b);
        EXPECT_NEAR(found.cost, tried(pair, a, b, 0, taken), 1e-12);
        ASSERT_EQ(found.partner.size(), a.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
            if (found.partner[i] == Assignment::kNone) continue;
            const Assignment other = assign_otherwise(pair, a, b, i, found.partner[i]);
            EXPECT_NE(other.partner[i], found.partner[i]);
            EXPECT_GE(other.cost, found.cost - 1e-12);
        }
    }
}

/// A branch of a tree that is built by hand.
struct Twig {
    int parent;
    double length, radius;
    Vec3 direction;
};

BranchTree tree_of(const std::vector<Twig>& twigs) {
    BranchTree tree;
    for (const Twig& t : twigs) {
        tree.parent.push_back(t.parent < 0 ? BranchId() : BranchId(static_cast<std::size_t>(t.parent)));
        tree.length.push_back(t.length);
        tree.radius.push_back(t.radius);
        tree.order_margin.push_back(kNaN);
        tree.chord.push_back(t.length * normalized(t.direction));
    }
    return tree;
}

/// Three generations: no two siblings are alike.
std::vector<Twig> twigs() {
    return {{-1, 60, 6, {0, 0, -1}},      {0, 50, 4.5, {1, 0, -1}},     {0, 32, 3.6, {-0.7, 0.3, -1}},
            {1, 30, 3.2, {1, 0, -0.2}},   {1, 18, 2.8, {0.5, 0.6, -1}}, {2, 25, 2.6, {-1, 0.2, -0.4}},
            {2, 14, 2.1, {-0.2, 0.9, -1}}};
}

Vec3 turned(Vec3 v) {
    const double c = std::cos(0.9), s = std::sin(0.9);
    const Vec3 u{c * v.x - s * v.y, s * v.x + c * v.y, v.z};
    return {u.x, c * u.y - s * u.z, s * u.y + c * u.z};
}

BranchLabels matched(const BranchTree& tree, const BranchTree& pattern, bool axes = false) {
    LabelOptions options;
    options.rule = LabelRule::kTemplate;
    options.template_model = "t";
    options.axes = axes;
    const std::vector<LabelledModel> models{{"t", {}, &pattern}, {"m", {}, &tree}};
    const CohortLabels labels = label_branches(options, models);
    EXPECT_TRUE(labels.complaints.empty());
    return labels.of.at(1);
}

const Strings kOwn{"1", "1.1", "1.2", "1.1.1", "1.1.2", "1.2.1", "1.2.2"};

TEST(TreeMatching, TurnedMirroredScaledAndNoisyCopiesAreRecognized) {
    const BranchTree pattern = tree_of(twigs());
    std::mt19937_64 random(11);
    const auto noise = [&random](double share) {
        return 1 + share * (2 * static_cast<double>(random() >> 11U) * 0x1p-53 - 1);
    };
    for (int trial = 0; trial < 50; ++trial) {
        std::vector<Twig> copy = twigs();
        for (Twig& t : copy) {
            t.direction = turned(t.direction);
            if (trial % 2 == 1) t.direction.x = -t.direction.x;
            t.length *= 1e-3 * noise(0.15);
            t.radius *= 1e-3 * noise(0.1);
            t.direction = normalized(t.direction) + 0.1 * Vec3{noise(1) - 1, noise(1) - 1, noise(1) - 1};
        }
        const BranchLabels labels = matched(tree_of(copy), pattern);
        EXPECT_EQ(labels.label, kOwn) << trial;
        for (const double c : labels.confidence) EXPECT_GT(c, 0.5) << trial;
    }
}

TEST(TreeMatching, AnotherOrderOfSiblingsChangesNothing) {
    // The second child has grown longer than the first: numbers are exchanged, vessels are not.
    std::vector<Twig> copy = twigs();
    std::swap(copy[1], copy[2]);
    std::swap(copy[3], copy[5]);
    std::swap(copy[4], copy[6]);
    for (const int k : {3, 4}) copy[static_cast<std::size_t>(k)].parent = 1;
    for (const int k : {5, 6}) copy[static_cast<std::size_t>(k)].parent = 2;
    EXPECT_EQ(matched(tree_of(copy), tree_of(twigs())).label,
              (Strings{"1", "1.2", "1.1", "1.2.1", "1.2.2", "1.1.1", "1.1.2"}));
}

TEST(TreeMatching, AMissingLeafUnitesItsParentWithItsSibling) {
    const std::vector<Twig> full = twigs();
    // Without branch 4, branches 1 and 3 are one.
    std::vector<Twig> less{full[0],
                           {0, 80, 4.0, 50 * normalized(full[1].direction) + 30 * normalized(full[3].direction)},
                           full[2],
                           {2, 25, 2.6, full[5].direction},
                           {2, 14, 2.1, full[6].direction}};
    const BranchLabels labels = matched(tree_of(less), tree_of(full));
    EXPECT_EQ(labels.label, (Strings{"1", "1.1+1.1.1", "1.2", "1.2.1", "1.2.2"}));
    // And the other way: what the template has as one is in parts.
    const BranchLabels parts = matched(tree_of(full), tree_of(less));
    EXPECT_EQ(parts.label, (Strings{"1", "1.1:1", "1.2", "1.1:2", "", "1.2.1", "1.2.2"}));
    EXPECT_TRUE(std::isnan(parts.confidence[4])) << "no counterpart, no confidence";
}

TEST(TreeMatching, AJunctionOfThreeMayBeTwoOfTwo) {
    const Vec3 ahead{0, 0, -1}, left{1, 0, -1}, right{-1, 0.2, -0.7};
    const std::vector<Twig> three{{-1, 60, 6, ahead}, {0, 50, 4, left}, {0, 40, 3, ahead}, {0, 22, 2, right}};
    const std::vector<Twig> two{
        {-1, 60, 6, ahead}, {0, 6, 4.5, ahead}, {0, 22, 2, right}, {1, 48, 4, left}, {1, 38, 3, ahead}};
    EXPECT_EQ(matched(tree_of(two), tree_of(three)).label, (Strings{"1", "", "1.3of3", "1.1of3", "1.2of3"}));
    EXPECT_EQ(matched(tree_of(three), tree_of(two)).label, (Strings{"1", "1.1.1", "1.1.2", "1.2"}));
}

TEST(TreeMatching, ChildrenThatAreAlikeHaveNoConfidence) {
    std::vector<Twig> alike = twigs();
    alike[5] = {2, 20, 2.4, {-1, 0.2, -0.4}};
    alike[6] = {2, 20, 2.4, {-0.4, 0.2, -1}};
    // Mirror images about the parent: as far from it, and from its own parent.
    alike[2].direction = {0, 0, -1};
    alike[5].direction = {1, 0, -1};
    alike[6].direction = {-1, 0, -1};
    const BranchLabels labels = matched(tree_of(alike), tree_of(alike));
    for (const std::size_t b : {5U, 6U}) EXPECT_LT(labels.confidence[b], 1e-6);
    for (const std::size_t b : {0U, 1U, 3U, 4U}) EXPECT_GT(labels.confidence[b], 0.5);
    // The coordinates tell them apart.
    const BranchLabels axes = matched(tree_of(alike), tree_of(alike), true);
    EXPECT_EQ(axes.label, kOwn);
    for (const std::size_t b : {5U, 6U}) EXPECT_GT(axes.confidence[b], 0.9);
    std::vector<Twig> exchanged = alike;
    std::swap(exchanged[5], exchanged[6]);
    EXPECT_EQ(matched(tree_of(exchanged), tree_of(alike), true).label[5], "1.2.2");
}

TEST(TreeMatching, ForeignTreesAndOddOnesMatchWhereTheyCan) {
    const BranchTree pattern = tree_of(twigs()), empty;
    EXPECT_TRUE(matched(empty, pattern).label.empty());
    EXPECT_EQ(matched(tree_of({{-1, 60, 6, {0, 0, 1}}}), pattern).label.size(), 1U);
    // Two inlets; a branch without own part and without direction.
    BranchTree odd = tree_of({{-1, 60, 6, {0, 0, 1}}, {-1, 10, 2, {0, 0, 1}}, {0, 5, kNaN, {kNaN, kNaN, kNaN}}});
    EXPECT_EQ(matched(odd, pattern).label.size(), 3U);
    const BranchLabels self = matched(odd, odd);
    EXPECT_EQ(self.label, (Strings{"1of2", "2of2", "1of2.1of1"}));
    odd.length[2] = 0;
    EXPECT_EQ(matched(odd, odd).label, self.label);
}

TEST(TreeMatching, ALongChainOfTwigsDoesNotTakeForever) {
    std::vector<Twig> chain{{-1, 10, 5, {0, 0, 1}}};
    for (int k = 0; k < 60; ++k) {
        chain.push_back({std::max(0, 2 * k - 1), 10, 5 - 0.05 * k, {0, 0, 1}});
        chain.push_back({std::max(0, 2 * k - 1), 6, 1.5, {1, k % 2 == 0 ? 1.0 : -1.0, 0.3}});
    }
    const BranchTree tree = tree_of(chain);
    EXPECT_EQ(matched(tree, tree).label, position_labels(tree).label);
}

TEST(Labels, PositionIsTheWayFromTheInlet) {
    BranchTree tree = tree_of({{-1, 9, 2, {0, 0, 1}},
                               {0, 8, 2, {1, 0, 1}},
                               {0, 7, 2, {0, 0, 1}},
                               {0, 6, 2, {0, 1, 1}},
                               {2, 5, 2, {0, 0, 1}},
                               {2, 4, 2, {0, 0, 1}}});
    tree.order_margin = {kNaN, 0.2, 0.1, 0.1, 0.4, 0.4};
    const BranchLabels labels = position_labels(tree);
    EXPECT_EQ(labels.label, (Strings{"1", "1.1of3", "1.2of3", "1.3of3", "1.2of3.1", "1.2of3.2"}));
    EXPECT_EQ(labels.confidence, (std::vector<double>{1, 0.2, 0.1, 0.1, 0.1, 0.1}));
}

TEST(Labels, WhatIsGivenByHandStands) {
    const BranchTree tree = tree_of(twigs());
    LabelOptions options;
    options.rule = LabelRule::kGiven;
    const std::vector<LabelledModel> given{{"a", {{1, "left"}, {9, "none"}}, &tree}};
    const CohortLabels by_hand = label_branches(options, given);
    EXPECT_EQ(by_hand.of[0].label, (Strings{"", "left", "", "", "", "", ""}));
    EXPECT_EQ(by_hand.of[0].confidence[1], 1);
    EXPECT_EQ(by_hand.complaints, (Strings{"the model 'a' has the branches 0 to 6, but a label for 9, 'none'"}));
    // The template's names go over to the others; a name given elsewhere by hand is withdrawn where it was found.
    options.rule = LabelRule::kTemplate;
    options.template_model = "t";
    const std::vector<LabelledModel> models{
        {"m", {{2, "left"}}, &tree}, {"t", {{0, "trunk"}, {1, "left"}}, &tree}, {"n", {}, &tree}};
    const CohortLabels all = label_branches(options, models);
    EXPECT_EQ(all.of[1].label, (Strings{"trunk", "left", "1.2", "1.1.1", "1.1.2", "1.2.1", "1.2.2"}));
    EXPECT_EQ(all.of[2].label, all.of[1].label);
    EXPECT_EQ(all.of[0].label, (Strings{"trunk", "", "left", "1.1.1", "1.1.2", "1.2.1", "1.2.2"}));
    options.template_model = "gone";
    EXPECT_EQ(label_branches(options, models).complaints.size(), 1U);
    options.rule = LabelRule::kNone;
    EXPECT_EQ(label_branches(options, models).of[0].label, Strings(7));
}

TEST(Labels, OrderOfTheModelsPlaysNoPart) {
    std::vector<BranchTree> trees;
    for (int k = 0; k < 4; ++k) {
        std::vector<Twig> copy = twigs();
        for (Twig& t : copy) t.length *= 1 + 0.02 * k * (t.parent + 1);
        trees.push_back(tree_of(copy));
    }
    LabelOptions options;
    options.rule = LabelRule::kTemplate;
    options.template_model = "m2";
    std::vector<LabelledModel> models;
    for (std::size_t k = 0; k < 4; ++k) models.push_back({"m" + std::to_string(k), {}, &trees[k]});
    const CohortLabels plain = label_branches(options, models);
    std::reverse(models.begin(), models.end());
    const CohortLabels other = label_branches(options, models);
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(plain.of[k].label, other.of[3 - k].label);
        EXPECT_EQ(plain.of[k].confidence, other.of[3 - k].confidence);
    }
}

}  // namespace
}  // namespace lumenline
