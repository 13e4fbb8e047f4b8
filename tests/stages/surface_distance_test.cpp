// Brute force over all triangles, and the inequality that the checks of lines rest on.
#include "engine/geometry/surface_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/stages/support.h"

namespace lumenline {
namespace {

Surface hairpin_surface() {
    PhantomOptions options;
    options.kind = PhantomKind::kHairpin;
    options.points_around = 12;
    options.jitter = 0.2;
    options.caps = true;
    options.rotate = true;
    return test::closed_surface(make_phantom(options));
}

std::array<Vec3, 3> corners(const Surface& surface, std::size_t triangle) {
    const auto& t = surface.triangles[triangle];
    return {surface.points[at(t[0])], surface.points[at(t[1])], surface.points[at(t[2])]};
}

double brute_force(const Surface& surface, Vec3 x) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
        const auto [a, b, c] = corners(surface, i);
        least = std::min(least, test::distance_to_triangle(x, a, b, c));
    }
    return least;
}

/// The definition in the header, by sampling the triangle in steps of 1/n of its sides.
double sampled_covering_radius(Vec3 a, Vec3 b, Vec3 c, int n) {
    double largest = 0.5 * std::max({distance(a, b), distance(b, c), distance(c, a)});
    for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) {
            const Vec3 x = a + (i / double(n)) * (b - a) + (j / double(n)) * (c - a);
            largest = std::max(largest, std::min({distance(x, a), distance(x, b), distance(x, c)}));
        }
    return largest;
}

TEST(SurfaceDistance, AgreesWithBruteForceWhateverTheHint) {
    const Surface surface = hairpin_surface();
    const SurfaceDistance measure(surface.points, surface.triangles);
    test::Random random(16);
    const double reach = 0.6 * surface.diagonal;
    for (int i = 0; i < 400; ++i) {
        const Vec3 x =
            surface.points[random.below(surface.site_count())] + random.uniform(0, reach) * random.direction();
        const std::size_t hint = random.below(surface.triangles.size());
        const auto found = measure.nearest(x, corners(surface, hint)[0], TriangleId(hint));
        EXPECT_NEAR(found.distance, brute_force(surface, x), 1e-12 * surface.diagonal);  // some tens of roundings
        EXPECT_NEAR(distance(x, found.point), found.distance, 1e-14 * surface.diagonal);
        const auto [a, b, c] = corners(surface, at(found.triangle));
        EXPECT_LT(test::distance_to_triangle(found.point, a, b, c), 1e-12 * surface.diagonal);
        EXPECT_NEAR(test::distance_to_triangle(x, a, b, c), found.distance, 1e-12 * surface.diagonal);
    }
}

TEST(SurfaceDistance, IsZeroOnTheSurface) {
    const Surface surface = hairpin_surface();
    const SurfaceDistance measure(surface.points, surface.triangles);
    for (std::size_t i = 0; i < surface.site_count(); i += 11) {
        const auto found = measure.nearest(surface.points[i], corners(surface, 0)[0], TriangleId(0));
        EXPECT_LT(found.distance, 1e-13 * surface.diagonal);
    }
}

TEST(CoveringRadius, IsTheSampledSupremum) {
    test::Random random(17);
    constexpr int kSteps = 150;
    for (int i = 0; i < 300; ++i) {
        const Vec3 a = random.in_box({-1, -1, -1}, {1, 1, 1}), b = random.in_box({-1, -1, -1}, {1, 1, 1}),
                   c = random.in_box({-1, -1, -1}, {1, 1, 1});
        const double rho = covering_radius(a, b, c), sampled = sampled_covering_radius(a, b, c, kSteps);
        EXPECT_GE(rho, sampled * (1 - 1e-12));
        // Between samples the distance to the nearest corner cannot grow by more than the step.
        EXPECT_LE(rho, sampled + 2 * std::max(distance(a, b), distance(a, c)) / kSteps);
        EXPECT_NEAR(covering_radius(c, a, b), rho, 1e-13);
        EXPECT_NEAR(covering_radius(b, a, c), rho, 1e-13);
    }
}

TEST(CoveringRadius, KnownTriangles) {
    const double side = std::sqrt(3.0);
    EXPECT_NEAR(covering_radius({0, 0, 0}, {side, 0, 0}, {side / 2, 1.5, 0}), 1, 1e-15) << "equilateral";
    EXPECT_NEAR(covering_radius({0, 0, 0}, {3, 0, 0}, {0, 4, 0}), 2.5, 1e-15) << "right angle";
    EXPECT_NEAR(covering_radius({0, 0, 0}, {10, 0, 0}, {5, 0.1, 0}), 5, 1e-12) << "obtuse: an end edge's middle";
    EXPECT_NEAR(covering_radius({0, 0, 0}, {2, 0, 0}, {1, 0, 0}), 1, 1e-15) << "no area";
    EXPECT_EQ(covering_radius({1, 1, 1}, {1, 1, 1}, {1, 1, 1}), 0) << "one point";
}

TEST(CoveringRadius, BoundsTheEmptyBallOverRandomTriangles) {
    // One triangle at a time: R is then the distance to its nearest corner, the largest there can be.
    test::Random random(18);
    for (int i = 0; i < 20000; ++i) {
        const Vec3 a = random.in_box({-1, -1, -1}, {1, 1, 1}), b = random.in_box({-1, -1, -1}, {1, 1, 1}),
                   c = random.in_box({-1, -1, -1}, {1, 1, 1}), x = random.in_box({-3, -3, -3}, {3, 3, 3});
        const double r = std::min({distance(x, a), distance(x, b), distance(x, c)});
        const double clearance = test::distance_to_triangle(x, a, b, c), rho = covering_radius(a, b, c);
        EXPECT_LE(r * r, clearance * clearance + rho * rho + 1e-13);
        EXPECT_GE(r, clearance - 1e-14);
    }
}

TEST(CoveringRadius, BoundsTheEmptyBallsOfASurface) {
    const Surface surface = hairpin_surface();
    const SurfaceDistance measure(surface.points, surface.triangles);
    test::Random random(19);
    double tightest = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 x = surface.points[random.below(surface.site_count())] + random.uniform(0, 6) * random.direction();
        double r = std::numeric_limits<double>::infinity();
        for (const Vec3& p : surface.points) r = std::min(r, distance(p, x));
        const auto wall = measure.nearest(x, corners(surface, 0)[0], TriangleId(0));
        const auto [a, b, c] = corners(surface, at(wall.triangle));
        const double rho = covering_radius(a, b, c);
        EXPECT_LE(r * r, (wall.distance * wall.distance + rho * rho) * (1 + 1e-12));
        tightest = std::max(tightest, (r * r - wall.distance * wall.distance) / (rho * rho));
    }
    EXPECT_GT(tightest, 0.5) << "the bound would be useless if it were far from reached";
}

}  // namespace
}  // namespace lumenline
