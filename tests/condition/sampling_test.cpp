// Local radii before the Voronoi diagram, and sites added where triangles are large for the vessel.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/condition/refine.h"
#include "engine/condition/wall_radius.h"
#include "tests/condition/shapes.h"

namespace lumenline::testing {
namespace {

using std::numbers::pi;

WallMesh wall_of(const TriangleSoup& soup) {
    WallMesh wall{soup.points, {}, {}};
    for (const auto& t : soup.triangles) wall.triangles.push_back(t);
    for (std::uint32_t v = 0; v < soup.points.size(); ++v) wall.input_vertex.push_back(v);
    return wall;
}

ConditionOptions refining() {
    ConditionOptions options;
    options.refine_undersampled = true;
    return options;
}

// Rings of n points, each turned by half a side against the one before: equilateral triangles around a round tube.
TriangleSoup coarse_tube(std::size_t n, double radius = 2) {
    const double side = 2 * radius * std::sin(pi / static_cast<double>(n)), row = side * std::sqrt(3) / 2;
    return tube(n, static_cast<std::size_t>(20 / row) + 2, [=](std::size_t i, std::size_t k) {
        const double angle = 2 * pi * (static_cast<double>(i) + 0.5 * static_cast<double>(k)) / static_cast<double>(n);
        return Vec3{radius * std::cos(angle), radius * std::sin(angle), row * static_cast<double>(k)};
    });
}

TEST(WallRadius, IsAboutTheApothemOfATube) {
    for (const std::size_t n : {4U, 6U, 24U}) {
        const WallMesh wall = wall_of(round_tube(n, 41, 2, 20));
        const WallRadius radius(wall);
        const auto middle = static_cast<std::uint32_t>(wall.triangles.size() / 2);
        // The middles of triangles are beside the middle of a side, where the ball of a polygon is smaller.
        const double apothem = 2 * std::cos(pi / static_cast<double>(n));
        EXPECT_LT(radius.at(middle, 100), 1.02 * apothem);
        EXPECT_GT(radius.at(middle, 100), 0.8 * apothem);
        EXPECT_EQ(radius.at(middle, 1), 1);
    }
}

TEST(WallRadius, IsNotTheDistanceToACornerBesideIt) {
    // A long box: the ball beside an edge of it meets the end face, which is not the opposite wall.
    const TriangleSoup box = mapped(cube(20, {0, 0, 0}), [](Vec3 p) { return Vec3{p.x, p.y, 5 * p.z}; });
    const WallMesh wall = wall_of(box);
    const WallRadius radius(wall);
    for (std::uint32_t t = 0; t < wall.triangles.size(); ++t) {
        const double r = radius.at(t, 100);
        EXPECT_GT(r, 0.9) << t;  // half the width, or no opposite wall found
    }
}

TEST(Refinement, LeavesWellSampledTubesAlone) {
    const TriangleSoup soup = coarse_tube(16);
    const Conditioned result = condition(soup, refining());
    EXPECT_EQ(result.count("undersampled_refined"), 0U);
    EXPECT_EQ(count_origin(result.surface, SiteOrigin::kWall), soup.points.size());
}

TEST(Refinement, PutsSitesOnTheCurvedSurface) {
    for (const std::size_t n : {4U, 5U, 6U}) {
        const TriangleSoup soup = coarse_tube(n);
        const Conditioned result = condition(soup, refining());
        EXPECT_EQ(result.count("undersampled_refined"), 1U);
        EXPECT_TRUE(is_closed_manifold(result.surface));
        EXPECT_EQ(crossings(result.surface), 0U);
        EXPECT_EQ(result.surface.openings.size(), 2U);
        std::size_t added = 0;
        for (std::size_t s = 0; s < result.surface.site_count(); ++s) {
            if (result.surface.origin[s] != SiteOrigin::kWall) continue;
            const Vec3 p = result.surface.points[s];
            if (s < soup.points.size()) {
                EXPECT_EQ(p, soup.points[s]);
                EXPECT_EQ(result.surface.input_vertex[s], s);
                continue;
            }
            ++added;
            EXPECT_EQ(result.surface.input_vertex[s], SiteId::kNoneValue);
            // Chords would reach in to the apothem, .71 to .87 radii. Arcs from mean normals, which are not quite
            // radial at the open ends and where points were added on one side only, come within a few percent.
            EXPECT_NEAR(std::hypot(p.x, p.y) / 2, 1, n == 4 ? 0.1 : 0.06) << n << " " << p.z;
        }
        EXPECT_GT(added, soup.points.size());
    }
}

TEST(Refinement, KeepsPlanarOpeningsPlanar) {
    const Conditioned result = condition(coarse_tube(6), refining());
    for (const Opening& opening : result.surface.openings) {
        EXPECT_GT(opening.loop.size(), 6U);
        for (const SiteId s : opening.loop)
            EXPECT_NEAR(dot(result.surface.points[at(s)] - opening.point, opening.normal), 0, 1e-9);
    }
}

TEST(Refinement, HappensWhereItIsNeededOnly) {
    // A tube that narrows from 24 edges around to 6 in the middle at the same edge length along it.
    const TriangleSoup soup = tube(12, 61, [](std::size_t i, std::size_t k) {
        const double z = 0.5 * (static_cast<double>(k) - 30);
        const double r = 2 - 1.7 * std::exp(-z * z / 8);
        const double angle = 2 * pi * (static_cast<double>(i) + 0.5 * static_cast<double>(k)) / 12;
        return Vec3{r * std::cos(angle), r * std::sin(angle), z};
    });
    const Conditioned result = condition(soup, refining());
    EXPECT_EQ(result.count("undersampled_refined"), 1U);
    for (std::size_t s = soup.points.size(); s < result.surface.site_count(); ++s)
        if (result.surface.origin[s] == SiteOrigin::kWall) {
            EXPECT_LT(std::fabs(result.surface.points[s].z), 6);
        }
}

TEST(Refinement, IsBounded) {
    // Three sides only: never round, but at most four points for each of the input's.
    const TriangleSoup soup = coarse_tube(3);
    const Conditioned result = condition(soup, refining());
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_LE(count_origin(result.surface, SiteOrigin::kWall), 5 * soup.points.size());
}

TEST(Refinement, DoesNotDependOnTheUnit) {
    const Conditioned original = condition(coarse_tube(6), refining());
    for (const int power : {-20, -10, 10}) {  // exact, since the diagonals of a symmetric tube are ties
        const double scale = std::ldexp(1, power);
        const Conditioned other = condition(mapped(coarse_tube(6), [=](Vec3 p) { return scale * p; }), refining());
        EXPECT_EQ(other.surface.triangles, original.surface.triangles);
    }
}

// ---- the whole stage at any scale, and far from the origin

TriangleSoup damaged_tube() {
    TriangleSoup soup = exploded(coarse_tube(9));
    soup.triangles.erase(soup.triangles.begin() + 60);
    std::swap(soup.triangles[30][0], soup.triangles[30][1]);
    soup.triangles.push_back(soup.triangles[12]);
    return merged(soup, cube(1, {30, 0, 0}, 0.02));
}

void expect_same_repairs(const Conditioned& other, const Conditioned& original) {
    ASSERT_EQ(other.diagnostics.size(), original.diagnostics.size());
    for (std::size_t i = 0; i < other.diagnostics.size(); ++i)
        EXPECT_EQ(other.diagnostics[i].code, original.diagnostics[i].code);
    EXPECT_EQ(other.surface.openings.size(), original.surface.openings.size());
    EXPECT_EQ(count_origin(other.surface, SiteOrigin::kWall), count_origin(original.surface, SiteOrigin::kWall));
}

TEST(Scale, OfTheModelDoesNotChangeItsRepairs) {
    const Conditioned original = condition(damaged_tube(), refining());
    EXPECT_EQ(original.count("hole_filled"), 1U);
    EXPECT_EQ(original.count("speck_removed"), 1U);
    for (const double scale : {1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e15})
        expect_same_repairs(condition(mapped(damaged_tube(), [=](Vec3 p) { return scale * p; }), refining()), original);
}

TEST(Place, FarFromTheOriginInSinglePrecisionDoesNotChangeTheRepairs) {
    const Conditioned original = condition(damaged_tube(), refining());
    // 1e4 sizes away, in the spacing of float32 there: about an eightieth of an edge, so that seams stay closed
    // because equal corners round alike, while nothing is welded that was apart.
    const double away = 1e4 * original.surface.diagonal;
    TriangleSoup soup = mapped(damaged_tube(), [=](Vec3 p) {
        const Vec3 q = p + Vec3{away, -away, away};
        return Vec3{static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
    });
    soup.coordinate_rounding = std::ldexp(away, -24);
    const Conditioned other = condition(soup, refining());
    EXPECT_TRUE(is_closed_manifold(other.surface));
    EXPECT_EQ(other.surface.openings.size(), 2U);
    EXPECT_EQ(other.count("hole_filled"), 1U);
    EXPECT_EQ(other.count("speck_removed"), 1U);
    EXPECT_NEAR(volume(other.surface), volume(original.surface), 0.02 * volume(original.surface));
}

}  // namespace
}  // namespace lumenline::testing
