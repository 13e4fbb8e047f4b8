#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/core/soup.h"
#include "engine/core/vec3.h"
#include "engine/phantom/accuracy.h"

namespace lumenline {

/// What tree to build. Lengths are in units before `scale`.
struct TreeOptions {
    int leaves = 8;          ///< a power of two: every inner branch has two children
    double a = 5;            ///< radius at the root
    double length = 10;      ///< of a branch, in its own radii, 5 % more or less
    int points_around = 20;  ///< edges are 2 pi r / points_around, r the local radius: the same on root and leaves
    std::uint64_t seed = 1;  ///< of directions and lengths
    bool caps = false;       ///< flat caps at root and leaves; else open ends
    Vec3 offset;             ///< added after scaling
    double scale = 1;
};

/// A straight branch: the union of balls on the axis from `start` to `end` whose radius goes linearly
/// from `start_radius` to `end_radius`.
struct TreeBranch {
    static constexpr std::size_t kNoParent = std::numeric_limits<std::size_t>::max();

    std::size_t parent = kNoParent;
    Vec3 start, end;
    double start_radius = 0, end_radius = 0;    ///< [length]
    double abscissa = 0;                        ///< of `start`, counted from the root along the axes [length]
    double blend = 0;                           ///< distance from its wall within which others are blended with it
    bool open_start = false, open_end = false;  ///< root and leaves end in planes across the axis
    /// Between these the ball touches its own wall all around, with no blend: the axis is the medial
    /// axis there, and the radius that of the maximal inscribed ball [abscissa on this branch]
    double clear_from = 0, clear_to = 0;

    [[nodiscard]] double length() const { return distance(start, end); }
    [[nodiscard]] Vec3 direction() const { return normalized(end - start); }
    [[nodiscard]] Vec3 position(double s) const { return lerp(start, end, s / length()); }
    /// Of the ball at `s` from the start; also beyond the ends.
    [[nodiscard]] double radius(double s) const { return start_radius + (end_radius - start_radius) * s / length(); }
};

/// Place on the tree's axes.
struct TreeAbscissa {
    std::size_t branch = 0;
    double s = 0;  ///< from the branch's start [length]
};

/// Exact geometry of a tree of tubes: the points where sum_i max(0, 1 - d_i / k_i)^3 > 1, with d_i the
/// distance to branch i, negative inside, and k_i its blend. Where no two branches are nearer than
/// their blends the wall is exactly the branch's own cone; elsewhere it is blended twice
/// differentiably. Radii follow Murray: a branch narrows by a tenth, and the cubes of two children's
/// radii add up to their parent's.
class TreeTruth {
public:
    /// Grows the tree; a direction that would bring two branches within reach of each other's blends
    /// or openings is drawn again.
    /// @throws std::invalid_argument for impossible options, and when no direction is left or branches
    ///         are too short to have a clear part
    explicit TreeTruth(const TreeOptions& options = {});

    [[nodiscard]] const std::vector<TreeBranch>& branches() const { return branches_; }  ///< parents first
    /// Branches from the root to a leaf, for every leaf.
    [[nodiscard]] std::vector<std::vector<std::size_t>> lines() const;

    /// Nearest axis point, distances being compared in local radii.
    [[nodiscard]] TreeAbscissa nearest_axis(Vec3 point) const;
    [[nodiscard]] Vec3 position(TreeAbscissa at) const { return branches_[at.branch].position(at.s); }

    /// Nearer to a junction than two local radii, counted from where the ball's contact with the wall is
    /// whole: there the centerline need not be the axis.
    [[nodiscard]] bool near_junction(TreeAbscissa at) const;

    /// Distance from an axis point to the wall: closed form in the clear part of a branch, else by search.
    /// @cost microseconds; in a junction about a millisecond
    [[nodiscard]] double inscribed_radius(TreeAbscissa at) const;

    /// Value and gradient of the sum above, minus one: positive inside. Open ends go on straight for two radii.
    /// Zero gradient where no branch is near.
    struct Field {
        double value = -1;
        Vec3 gradient;
        double radius = 0;  ///< of the branches there, weighted by their terms; 0 = none near
    };
    [[nodiscard]] Field field(Vec3 point) const;

    /// Distance to branch `i` alone, negative inside. Open ends go on straight for two radii.
    [[nodiscard]] double distance_to_branch(std::size_t i, Vec3 point) const;

    /// Whether a point is within the wall and before the planes of the open ends.
    [[nodiscard]] bool inside(Vec3 point) const;

    /// Newton's method along the gradient: the point of the wall near `point`.
    [[nodiscard]] Vec3 projected(Vec3 point) const;

    /// Distance from an inner point to the wall (without caps) by search from `directions` rays.
    [[nodiscard]] double distance_to_wall(Vec3 point, int directions) const;

private:
    /// Sphere around all that a branch's kernel reaches.
    struct Reach {
        Vec3 centre;
        double squared_radius = 0;
        [[nodiscard]] bool holds(Vec3 x) const { return squared_norm(x - centre) <= squared_radius; }
    };

    std::vector<TreeBranch> branches_;
    std::vector<Reach> reach_;  // per branch
};

/// A triangulated tree, oriented outward.
struct TreePhantom {
    std::vector<Vec3> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    TreeTruth truth;
};

/// Mesh of the wall by Delaunay refinement (CGAL Mesh_3, whose sharp edges are the circles of the
/// openings), vertices moved onto the wall to rounding. The same options give the same tree.
/// @throws std::invalid_argument as TreeTruth, and for fewer than 8 points around
/// @cost 0.3 ms per vertex of 8 leaves, three times that of 64: the field asks every branch
TreePhantom make_tree(const TreeOptions& options);

/// The tree as a reader would have returned it; source_file is "phantom".
TriangleSoup to_soup(const TreePhantom& tree);

/// As line_error of a tube, in percent of the local radius, leaving out what is near a junction or
/// within a quarter of a radius of an open end.
/// @throws std::invalid_argument as there
LineError line_error(const TreeTruth& truth, std::span<const Vec3> points, std::span<const double> radius);

}  // namespace lumenline
