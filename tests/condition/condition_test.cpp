// The whole stage on clean input: an open tube, of which everything is known.

#include "engine/condition/condition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

#include "tests/condition/shapes.h"

namespace lumenline::testing {
namespace {

constexpr std::size_t kAround = 24, kRings = 31;
constexpr double kRadius = 2, kLength = 16;
// Coordinates of order ten carry roundings of 2e-15, sums over a few dozen of them stay below this.
constexpr double kRounding = 1e-12;

TriangleSoup plain_tube() { return round_tube(kAround, kRings, kRadius, kLength); }

TEST(OpenTube, IsClosedWithTwoOpeningsAndNothingToReport) {
    const Conditioned result = condition(plain_tube());
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_EQ(euler_characteristic(result.surface), 2);
    EXPECT_EQ(result.surface.genus, 0);
    EXPECT_EQ(result.surface.component_count, 1);
    EXPECT_EQ(result.surface.openings.size(), 2U);
    EXPECT_EQ(crossings(result.surface), 0U);
    EXPECT_TRUE(result.diagnostics.empty());
}

TEST(OpenTube, OpeningsHaveTheExactPlaneCentreAndRadius) {
    const Surface surface = condition(plain_tube()).surface;
    const double radius = regular_polygon_radius(kAround, kRadius);
    // Equal areas are ordered by position along (1, 0.6, 0.75): the end at z = 0 first.
    for (const std::size_t end : {0U, 1U}) {
        const Opening& opening = surface.openings[end];
        const double z = end == 0 ? 0 : kLength, outward = end == 0 ? -1 : 1;
        EXPECT_NEAR(distance(opening.point, {0, 0, z}), 0, kRounding);
        EXPECT_NEAR(distance(opening.normal, {0, 0, outward}), 0, kRounding);
        EXPECT_NEAR(opening.radius, radius, kRounding);
        EXPECT_NEAR(opening.extension_length, 1.2 * radius, kRounding);
        ASSERT_EQ(opening.loop.size(), kAround);
        for (std::size_t i = 0; i < kAround; ++i) {
            const Vec3 a = surface.points[at(opening.loop[i])], b = surface.points[at(opening.loop[(i + 1) % kAround])];
            EXPECT_NEAR(distance(a, b), 2 * kRadius * std::sin(std::numbers::pi / kAround), kRounding);
            EXPECT_GT(dot(cross(a - opening.point, b - opening.point), opening.normal), 0);
        }
    }
}

TEST(OpenTube, WallComesFirstAndUnchanged) {
    const TriangleSoup soup = plain_tube();
    const Surface surface = condition(soup).surface;
    const std::size_t n = soup.points.size();
    ASSERT_GT(surface.site_count(), n);
    for (std::size_t s = 0; s < surface.site_count(); ++s) {
        EXPECT_EQ(surface.origin[s] == SiteOrigin::kWall, s < n);
        EXPECT_EQ(surface.input_vertex[s], s < n ? s : SiteId::kNoneValue);
        if (s < n) {
            EXPECT_EQ(surface.points[s], soup.points[s]);
        }
    }
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        EXPECT_EQ(surface.cap[t].is_none(), t < soup.triangles.size());
        if (t >= soup.triangles.size()) continue;
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(surface.triangles[t][k].value, soup.triangles[t][k]);
    }
}

TEST(OpenTube, ExtensionContinuesTheWallAndEndsInAPlane) {
    const Surface surface = condition(plain_tube()).surface;
    const double end = surface.openings[1].extension_length;
    const double least = kRadius * std::cos(std::numbers::pi / kAround);  // in the middle of a side
    for (std::size_t s = 0; s < surface.site_count(); ++s) {
        const Vec3 p = surface.points[s];
        const double beyond = std::max(p.z - kLength, -p.z);
        if (surface.origin[s] == SiteOrigin::kExtension) {
            EXPECT_GT(beyond, 0);
            EXPECT_LT(beyond, end + kRounding);
            // The smooth curve through the corners of a regular 24-gon leaves the circle by 2e-4 radii.
            EXPECT_GT(std::hypot(p.x, p.y), least);
            EXPECT_LT(std::hypot(p.x, p.y), kRadius * 1.001);
        }
        if (surface.origin[s] == SiteOrigin::kCap) {
            EXPECT_NEAR(beyond, end, kRounding);
        }
    }
    EXPECT_GT(count_origin(surface, SiteOrigin::kExtension), 0U);
    EXPECT_GT(count_origin(surface, SiteOrigin::kCap), 0U);
}

TEST(OpenTube, VolumeIsThatOfTheLongerTube) {
    const Surface surface = condition(plain_tube()).surface;
    const double prism = std::numbers::pi * std::pow(regular_polygon_radius(kAround, kRadius), 2);
    const double length = kLength + 2 * surface.openings[0].extension_length;
    // The extension's polygon of the same number of sides is inscribed in nearly the same circle.
    EXPECT_NEAR(volume(surface), prism * length, 0.01 * prism * length);
    EXPECT_GT(volume(surface), prism * kLength);
}

TEST(OpenTube, NewTrianglesHaveTheWallsSizeAndNoFan) {
    for (const double extension : {1.2, 0.0}) {
        const Surface surface = condition(plain_tube(), extension).surface;
        double edge = 0;
        std::size_t count = 0;
        for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
            for (std::size_t k = 0; k < 3; ++k) {
                const SiteId a = surface.triangles[t][k], b = surface.triangles[t][(k + 1) % 3];
                if (surface.cap[t].is_none()) continue;
                const double length = distance(surface.points[at(a)], surface.points[at(b)]);
                EXPECT_LT(length, 2.2 * surface.median_edge);
                EXPECT_GT(length, 0.3 * surface.median_edge);
                edge += length;
                ++count;
            }
        }
        EXPECT_NEAR(edge / static_cast<double>(count), surface.median_edge, 0.25 * surface.median_edge);
        // Six in the mean; a fan of 24 would show.
        EXPECT_LE(largest_valence(surface, SiteOrigin::kCap), 9U);
        EXPECT_LE(largest_valence(surface, SiteOrigin::kExtension), 10U);
        EXPECT_LE(largest_valence(surface, SiteOrigin::kWall), 10U);
    }
}

TEST(OpenTube, NormalsAreUnitAndOutward) {
    const Surface surface = condition(plain_tube()).surface;
    for (std::size_t s = 0; s < surface.site_count(); ++s) {
        EXPECT_NEAR(norm(surface.normals[s]), 1, kRounding);
        const Vec3 p = surface.points[s];
        // By symmetry of the tube's triangulation a wall normal is radial up to half a side's angle.
        if (surface.origin[s] == SiteOrigin::kWall) {
            EXPECT_GT(dot(surface.normals[s], normalized({p.x, p.y, 0})), std::cos(std::numbers::pi / kAround));
        }
    }
}

TEST(OpenTube, WithoutExtensionGetsPlainCaps) {
    const Conditioned result = condition(plain_tube(), 0);
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_TRUE(result.diagnostics.empty());
    EXPECT_EQ(count_origin(result.surface, SiteOrigin::kExtension), 0U);
    EXPECT_EQ(result.surface.openings[0].extension_length, 0);
    const double prism = std::numbers::pi * std::pow(regular_polygon_radius(kAround, kRadius), 2) * kLength;
    EXPECT_NEAR(volume(result.surface), prism, 1e-12 * prism);
}

TEST(OpenTube, FacingInwardIsTurned) {
    TriangleSoup soup = plain_tube();
    for (auto& t : soup.triangles) std::swap(t[0], t[1]);
    const Conditioned result = condition(soup);
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_EQ(result.count("orientation_flipped"), 1U);
    EXPECT_EQ(result.warnings(), 0U);
    EXPECT_GT(volume(result.surface), 0);
    EXPECT_NEAR(result.surface.openings[1].normal.z, 1, kRounding);
}

TEST(OpenTube, MeasuresOfTheWallAreRight) {
    const Surface surface = condition(plain_tube()).surface;
    EXPECT_NEAR(surface.diagonal, std::sqrt(2 * 16 + kLength * kLength), kRounding);
    EXPECT_GT(surface.median_edge, 0.5);
    EXPECT_LT(surface.median_edge, 0.75);
}

// An uneven tube, so that no predicate is near a tie.
TriangleSoup uneven_tube() {
    return tube(20, 25, [](std::size_t i, std::size_t k) {
        const double a =
            2 * std::numbers::pi * (static_cast<double>(i) + 0.3 * std::sin(5.0 * static_cast<double>(i + k))) / 20;
        const double r = 1.5 + 0.3 * std::cos(a) + 0.02 * static_cast<double>(k);
        return Vec3{r * std::cos(a), 1.2 * r * std::sin(a), 0.4 * static_cast<double>(k) + 0.1 * std::sin(3 * a)};
    });
}

TEST(Units, DoNotChangeTheTriangulation) {
    const Surface original = condition(uneven_tube()).surface;
    for (const double scale : {1e-3, 1e3}) {
        const Surface scaled = condition(mapped(uneven_tube(), [=](Vec3 p) { return scale * p; })).surface;
        EXPECT_EQ(scaled.triangles, original.triangles);
        ASSERT_EQ(scaled.site_count(), original.site_count());
        for (std::size_t s = 0; s < scaled.site_count(); ++s)
            EXPECT_LT(distance(scaled.points[s], scale * original.points[s]), 1e-10 * scale);
    }
}

TEST(Position, DoesNotChangeTheTriangulation) {
    const Surface original = condition(uneven_tube()).surface;
    const Vec3 far{1e4, -1e4, 1e4};
    const Surface moved = condition(mapped(uneven_tube(), [=](Vec3 p) { return p + far; })).surface;
    EXPECT_EQ(moved.triangles, original.triangles);
    ASSERT_EQ(moved.site_count(), original.site_count());
    // Coordinates of 1e4 are rounded to 1e-12; normals of openings amplify that by some ten edges.
    for (std::size_t s = 0; s < moved.site_count(); ++s)
        EXPECT_LT(distance(moved.points[s], original.points[s] + far), 1e-9);
}

TEST(Order, OfInputDoesNotChangeTheOpenings) {
    const TriangleSoup cone = tube(20, 25, [](std::size_t i, std::size_t k) {
        const double a = 2 * std::numbers::pi * static_cast<double>(i) / 20, r = 1 + 0.05 * static_cast<double>(k);
        return Vec3{r * std::cos(a), r * std::sin(a), 0.4 * static_cast<double>(k)};
    });
    for (const TriangleSoup& soup : {plain_tube(), cone}) {
        const Surface original = condition(soup).surface;
        EXPECT_GE(original.openings[0].radius, original.openings[1].radius * (1 - 1e-9));
        for (const unsigned seed : {1U, 2U, 3U, 4U}) {
            const Surface other = condition(shuffled(soup, seed)).surface;
            ASSERT_EQ(other.openings.size(), 2U);
            for (std::size_t i = 0; i < 2; ++i)
                EXPECT_LT(distance(other.openings[i].point, original.openings[i].point), 1e-10);
        }
    }
}

TEST(Repetition, GivesTheSameBits) {
    const Surface a = condition(uneven_tube()).surface, b = condition(uneven_tube()).surface;
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.normals, b.normals);
}

TEST(ClosedCube, StaysAsItIs) {
    const TriangleSoup soup = cube(4, {1, 2, 3});
    const Conditioned result = condition(soup);
    EXPECT_TRUE(result.diagnostics.empty());
    EXPECT_TRUE(result.surface.openings.empty());
    EXPECT_EQ(result.surface.points, soup.points);
    EXPECT_NEAR(volume(result.surface), 8, kRounding);
}

TEST(Tetrahedron, IsTheSmallestSurface) {
    const Conditioned result = condition(tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}));
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_NEAR(volume(result.surface), 1.0 / 6, kRounding);
    EXPECT_TRUE(result.diagnostics.empty());
}

TEST(Torus, HasGenusOne) {
    TriangleSoup soup;
    constexpr std::uint32_t n = 24, m = 12;
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < m; ++j) {
            const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * j / m;
            soup.points.push_back({(3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v)});
            const auto id = [](std::uint32_t a, std::uint32_t b) { return a % n * m + b % m; };
            soup.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
            soup.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
        }
    }
    EXPECT_EQ(condition(soup).surface.genus, 1);
}

TEST(Cancellation, StopsTheStage) {
    const std::atomic<bool> cancelled = true;
    StageContext context(Stage::kCondition, &cancelled);
    try {
        condition_surface(plain_tube(), {}, context);
        ADD_FAILURE();
    } catch (const StageError& e) {
        EXPECT_EQ(e.code(), ErrorCode::kInterrupted);
    }
}

}  // namespace
}  // namespace lumenline::testing
