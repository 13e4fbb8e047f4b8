// The branching phantom: its mesh against its implicit surface, its truth against brute force.
#include "engine/phantom/tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "engine/phantom/random.h"

namespace lumenline {
namespace {

using std::numbers::pi;

TreeOptions options_of(int leaves, std::uint64_t seed = 1) {
    TreeOptions options;
    options.leaves = leaves;
    options.points_around = 12;
    options.seed = seed;
    options.scale = 0.37;
    options.offset = {3, -20, 11};
    return options;
}

/// Four leaves, meshed once for all tests that only look.
const TreePhantom& small_tree() {
    static const TreePhantom tree = make_tree(options_of(4));
    return tree;
}

struct Topology {
    bool manifold = true;  // no directed edge twice
    std::map<std::uint32_t, std::uint32_t> boundary;
    long euler = 0;
};

Topology topology_of(const TreePhantom& tree) {
    Topology topology;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
    for (const auto& t : tree.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            if (++directed[{t[k], t[(k + 1) % 3]}] > 1) topology.manifold = false;
    long edges = 0;
    for (const auto& [edge, count] : directed) {
        const bool twin = directed.contains({edge.second, edge.first});
        if (!twin || edge.first < edge.second) ++edges;
        if (!twin && !topology.boundary.emplace(edge.first, edge.second).second) topology.manifold = false;
    }
    topology.euler = static_cast<long>(tree.points.size() + tree.triangles.size()) - edges;
    return topology;
}

/// The boundary loops, each a list of vertices.
std::vector<std::vector<std::uint32_t>> loops_of(Topology topology) {
    std::vector<std::vector<std::uint32_t>> loops;
    while (!topology.boundary.empty()) {
        loops.emplace_back();
        for (auto at = topology.boundary.begin(); at != topology.boundary.end();) {
            loops.back().push_back(at->first);
            const std::uint32_t next = at->second;
            topology.boundary.erase(at);
            at = topology.boundary.find(next);
        }
    }
    return loops;
}

double volume_of(const TreePhantom& tree) {
    double volume = 0;
    for (const auto& [a, b, c] : tree.triangles) {
        const Vec3 p = tree.points[a] - tree.points[0];
        volume += dot(p, cross(tree.points[b] - tree.points[0], tree.points[c] - tree.points[0])) / 6;
    }
    return volume;
}

/// Triangles that do not face the way the field falls at their corners.
std::size_t inward_triangles(const TreePhantom& tree) {
    return static_cast<std::size_t>(std::count_if(tree.triangles.begin(), tree.triangles.end(), [&](const auto& t) {
        const Vec3 a = tree.points[t[0]], b = tree.points[t[1]], c = tree.points[t[2]];
        Vec3 outward;
        for (const Vec3& x : {a, b, c}) outward += -normalized(tree.truth.field(x).gradient);
        return !(dot(cross(b - a, c - a), outward) > 0);
    }));
}

TEST(TreeMesh, IsAManifoldThatIsOpenAtRootAndLeavesOnly) {
    const TreePhantom& tree = small_tree();
    const Topology topology = topology_of(tree);
    EXPECT_TRUE(topology.manifold);
    const auto loops = loops_of(topology);
    EXPECT_EQ(loops.size(), 5U);
    EXPECT_EQ(topology.euler, 2 - 5);
    EXPECT_EQ(inward_triangles(tree), 0U);
}

TEST(TreeMesh, OpeningsArePlaneCirclesOfEvenlyManyEdges) {
    const TreePhantom& tree = small_tree();
    std::vector<std::size_t> found;
    for (const auto& loop : loops_of(topology_of(tree))) {
        const TreeAbscissa end = tree.truth.nearest_axis(tree.points[loop.front()]);
        const TreeBranch& b = tree.truth.branches()[end.branch];
        const Vec3 centre = b.open_start ? b.start : b.end;
        const double slope = (b.start_radius - b.end_radius) / b.length();
        const double radius = (b.open_start ? b.start_radius : b.end_radius) / std::sqrt(1 - slope * slope);
        found.push_back(end.branch);
        // Rounding of coordinates of the tree's size.
        const double tolerance = 1e-12 * norm(centre);
        for (const std::uint32_t v : loop) {
            EXPECT_NEAR(dot(tree.points[v] - centre, b.direction()), 0, tolerance);
            EXPECT_NEAR(distance(tree.points[v], centre), radius, tolerance);
        }
        // Protecting balls make the circle's edges up to a quarter shorter than asked for.
        EXPECT_GE(loop.size(), 12U);
        EXPECT_LE(loop.size(), 18U);
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, (std::vector<std::size_t>{0, 3, 4, 5, 6}));
}

TEST(TreeMesh, EveryVertexLiesOnTheImplicitSurface) {
    const TreePhantom& tree = small_tree();
    double extent = 0;
    for (const Vec3& x : tree.points) extent = std::max(extent, norm(x));
    for (const Vec3& x : tree.points) {
        const TreeTruth::Field f = tree.truth.field(x);
        ASSERT_GT(norm(f.gradient), 0);
        EXPECT_LT(std::fabs(f.value) / norm(f.gradient), 1e-12 * extent);
    }
}

TEST(TreeMesh, EdgesFollowTheLocalRadius) {
    const TreePhantom& tree = small_tree();
    double sum = 0;
    for (const auto& t : tree.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 a = tree.points[t[k]], b = tree.points[t[(k + 1) % 3]];
            const double wanted = 2 * pi / 12 * tree.truth.field(a).radius;
            const double share = distance(a, b) / wanted;
            sum += share;
            // Refinement spreads edges about their mean; these are the ends seen, with room.
            EXPECT_GT(share, 0.4);
            EXPECT_LT(share, 2.2);
        }
    EXPECT_NEAR(sum / static_cast<double>(3 * tree.triangles.size()), 1, 0.15);
}

TEST(TreeMesh, CapsCloseItAndEncloseTheVolumeOfItsCones) {
    TreeOptions options = options_of(4);
    options.caps = true;
    const TreePhantom tree = make_tree(options);
    const Topology topology = topology_of(tree);
    EXPECT_TRUE(topology.manifold);
    EXPECT_TRUE(topology.boundary.empty());
    EXPECT_EQ(topology.euler, 2);
    double cones = 0;
    for (const TreeBranch& b : tree.truth.branches()) {
        const double p = b.start_radius, q = b.end_radius;
        cones += pi / 3 * b.length() * (p * p + p * q + q * q);
    }
    // Chords of 12 points around cost 4.5 %; children overlap at their start, blends fill a little.
    EXPECT_GT(volume_of(tree), 0.85 * cones);
    EXPECT_LT(volume_of(tree), cones);
}

TEST(TreeMesh, ChecksSeeWhatIsWrong) {
    TreePhantom tree = small_tree();
    std::swap(tree.triangles[17][0], tree.triangles[17][1]);
    EXPECT_FALSE(topology_of(tree).manifold);
    EXPECT_EQ(inward_triangles(tree), 1U);
    tree = small_tree();
    tree.triangles.erase(tree.triangles.begin() + 100);
    EXPECT_NE(topology_of(tree).euler, topology_of(small_tree()).euler);
}

TEST(TreeMesh, SameOptionsGiveTheSameBytes) {
    TreeOptions options = options_of(2);
    const TreePhantom a = make_tree(options), b = make_tree(options);
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.triangles, b.triangles);
    options.scale = 1000 * options.scale;
    options.offset = {};
    EXPECT_EQ(make_tree(options).triangles, a.triangles) << "the mesh is made before it is scaled and moved";
}

TEST(TreeTruth, BranchesKeepApartAndNarrowByMurraysLaw) {
    for (const std::uint64_t seed : {1, 2, 3}) {
        const TreeTruth truth(options_of(64, seed));
        const auto& branches = truth.branches();
        ASSERT_EQ(branches.size(), 127U);
        EXPECT_EQ(truth.lines().size(), 64U);
        std::vector<double> cubes(branches.size(), 0);
        for (const TreeBranch& b : branches)
            if (b.parent != TreeBranch::kNoParent) {
                cubes[b.parent] += std::pow(b.start_radius, 3);
                EXPECT_EQ(b.start, branches[b.parent].end);
                EXPECT_NEAR(b.abscissa, branches[b.parent].abscissa + branches[b.parent].length(), 1e-12 * b.abscissa);
            }
        for (std::size_t i = 0; i < branches.size(); ++i)
            if (!branches[i].open_end) {
                EXPECT_NEAR(cubes[i], std::pow(branches[i].end_radius, 3), 1e-12 * cubes[i]);
            }
        // From points of one axis to all other branches that share no node with it.
        for (std::size_t i = 0; i < branches.size(); ++i)
            for (double s = 0; s <= branches[i].length(); s += branches[i].radius(0) / 4)
                for (std::size_t j = 0; j < branches.size(); ++j) {
                    if (i == j || branches[j].parent == i || branches[i].parent == j ||
                        branches[i].parent == branches[j].parent)
                        continue;
                    EXPECT_GT(truth.distance_to_branch(j, branches[i].position(s)),
                              branches[i].radius(s) + branches[i].blend + branches[j].blend);
                }
    }
}

TEST(TreeTruth, EveryBranchHasAPartAwayFromJunctions) {
    for (const std::uint64_t seed : {1, 2, 3}) {
        const TreeTruth truth(options_of(64, seed));
        for (std::size_t i = 0; i < truth.branches().size(); ++i) {
            const TreeBranch& b = truth.branches()[i];
            double away = 0;
            const double step = b.length() / 200;
            for (double s = step / 2; s < b.length(); s += step) away += truth.near_junction({i, s}) ? 0 : step;
            EXPECT_GT(away, 2 * b.start_radius) << "branch " << i << ", seed " << seed;
        }
    }
}

TEST(TreeTruth, RadiusInClearPartsIsTheDistanceToTheWall) {
    const TreeTruth truth(options_of(4));
    for (std::size_t i = 0; i < truth.branches().size(); ++i) {
        const TreeBranch& b = truth.branches()[i];
        for (const double share : {0.0, 0.3, 0.7, 1.0}) {
            const double s = b.clear_from + share * (b.clear_to - b.clear_from);
            // By search: exact but for the slide's last step, whose square counts.
            EXPECT_NEAR(truth.distance_to_wall(b.position(s), 300), truth.inscribed_radius({i, s}),
                        1e-6 * b.start_radius)
                << "branch " << i << " at " << share;
        }
    }
}

TEST(TreeTruth, RadiusInJunctionsIsTheDistanceToAFineCloudOnTheWall) {
    const TreePhantom& tree = small_tree();
    for (const std::size_t i : {0U, 1U, 2U}) {
        const TreeBranch& b = tree.truth.branches()[i];
        for (const double back : {0.0, 0.3}) {
            const TreeAbscissa at{i, b.length() - back * b.end_radius};
            const Vec3 x = tree.truth.position(at);
            double cloud = std::numeric_limits<double>::infinity();
            for (const auto& t : tree.triangles) {
                if (distance(tree.points[t[0]], x) > 4 * b.end_radius) continue;
                for (int p = 0; p <= 8; ++p)
                    for (int q = 0; p + q <= 8; ++q) {
                        const Vec3 flat = (p / 8.0) * tree.points[t[0]] + (q / 8.0) * tree.points[t[1]] +
                                          ((8 - p - q) / 8.0) * tree.points[t[2]];
                        cloud = std::min(cloud, distance(x, tree.truth.projected(flat)));
                    }
            }
            // Samples are a fifteenth of the radius apart: the nearest one is up to 0.03 r aside, and so 0.0005 r far.
            const double radius = tree.truth.inscribed_radius(at);
            EXPECT_LE(radius, cloud * (1 + 1e-9));
            EXPECT_GT(radius, cloud - 2e-3 * b.end_radius);
            EXPECT_GT(radius, b.end_radius) << "the blend makes room";
        }
    }
}

TEST(TreeTruth, GradientIsTheSlopeOfTheField) {
    const TreePhantom& tree = small_tree();
    RandomStream random(5);
    const double h = 1e-5 * tree.truth.branches().back().end_radius;
    for (int k = 0; k < 200; ++k) {
        Vec3 x = tree.points[static_cast<std::size_t>(random.unit() * static_cast<double>(tree.points.size()))];
        x += 2000 * h * Vec3{random.symmetric(), random.symmetric(), random.symmetric()};
        const Vec3 gradient = tree.truth.field(x).gradient;
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 step;
            step[axis] = h;
            const double slope = (tree.truth.field(x + step).value - tree.truth.field(x + -step).value) / (2 * h);
            // Central differences: h^2 times the third derivative, which jumps at the ends of the cones.
            EXPECT_NEAR(slope, gradient[axis], 1e-4 * norm(gradient));
        }
    }
}

TEST(TreeLineError, ShiftedAxisIsMeasuredInLocalRadii) {
    const TreeTruth truth(options_of(4));
    const auto line = truth.lines().front();
    std::vector<Vec3> points;
    std::vector<double> radius;
    for (const std::size_t i : line) {
        const TreeBranch& b = truth.branches()[i];
        for (int k = 0; k <= 200; ++k) {
            const double s = b.length() * k / 200;
            points.push_back(b.position(s) + 0.02 * b.radius(s) * any_perpendicular(b.direction()));
            radius.push_back(1.03 * b.radius(s));
        }
    }
    const LineError error = line_error(truth, points, radius);
    EXPECT_NEAR(error.position_mean, 2, 0.01);
    EXPECT_NEAR(error.radius_mean, 3, 0.01);
    EXPECT_LT(error.position_sigma + error.radius_sigma, 0.01);
    EXPECT_THROW(line_error(truth, points, std::vector<double>{1}), std::invalid_argument);
}

TEST(TreeOptions, ImpossibleTreesAreRefused) {
    const auto refused = [](auto change) {
        TreeOptions options;
        change(options);
        EXPECT_THROW(make_tree(options), std::invalid_argument);
    };
    refused([](TreeOptions& o) { o.leaves = 0; });
    refused([](TreeOptions& o) { o.leaves = 6; });
    refused([](TreeOptions& o) { o.a = 0; });
    refused([](TreeOptions& o) { o.length = 3; });
    refused([](TreeOptions& o) { o.points_around = 5; });
    refused([](TreeOptions& o) { o.scale = -1; });
    refused([](TreeOptions& o) { o.offset.x = std::nan(""); });
}

}  // namespace
}  // namespace lumenline
