// Exact rational arithmetic on the very doubles that the function gets.
#include "engine/geometry/circumcentre.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/stages/exact_circumcentre.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

using test::Corners;
using test::exact_circumcentre;
using test::ExactCentre;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

double largest_coordinate(const Corners& p) {
    double largest = 0;
    for (const Vec3& x : p) largest = std::max({largest, std::fabs(x.x), std::fabs(x.y), std::fabs(x.z)});
    return largest;
}

double longest_edge(const Corners& p) {
    double longest = 0;
    for (const Vec3& x : p)
        for (const Vec3& y : p) longest = std::max(longest, distance(x, y));
    return longest;
}

/// The error that rounding allows: of the sum p0 + offset, and, in double precision, of coordinate
/// differences and numerators magnified by the flatness.
double allowed_error(const Corners& p, const ExactCentre& truth) {
    const double sum = 4 * kEpsilon * (largest_coordinate(p) + truth.radius);
    if (truth.relative_determinant < 0.99e-8) return sum;
    return sum + 64 * kEpsilon * (longest_edge(p) + truth.radius) / truth.relative_determinant;
}

TEST(Circumcentre, RandomTetrahedraAgreeWithExactArithmetic) {
    test::Random random(7);
    for (int i = 0; i < 1500; ++i) {
        Corners p;
        for (Vec3& x : p) x = random.in_box({-1, -1, -1}, {1, 1, 1});
        const ExactCentre truth = exact_circumcentre(p);
        const Vec3 c = circumcentre(p[0], p[1], p[2], p[3]);
        EXPECT_LE(distance(c, truth.centre), allowed_error(p, truth));
        for (const Vec3& x : p)
            EXPECT_NEAR(distance(c, x), truth.radius, allowed_error(p, truth) + 4 * kEpsilon * truth.radius);
    }
}

TEST(Circumcentre, NearlyFlatTetrahedraAgreeWithExactArithmetic) {
    test::Random random(8);
    int flat = 0;
    for (int i = 0; i < 1500; ++i) {
        const double height = std::pow(10, random.uniform(-16, -4));
        const Vec3 n = random.direction(), u = any_perpendicular(n), v = cross(n, u);
        Corners p;
        for (Vec3& x : p)
            x = random.uniform(-1, 1) * u + random.uniform(-1, 1) * v + height * random.uniform(-1, 1) * n;
        const ExactCentre truth = exact_circumcentre(p);
        if (!(truth.relative_determinant > 1e-17)) continue;  // nothing but rounding left of the volume
        flat += truth.relative_determinant < 1e-8;
        EXPECT_LE(distance(circumcentre(p[0], p[1], p[2], p[3]), truth.centre), allowed_error(p, truth));
    }
    EXPECT_GT(flat, 500);
}

TEST(Circumcentre, CosphericalFlatTetrahedraOfARotatedRingAgreeWithExactArithmetic) {
    // Two neighbouring rings of a structured tube: four nearly coplanar points on one sphere, whose centre
    // double precision misses by many radii.
    test::Random random(9);
    double naive_worst = 0;
    int flat = 0;
    for (int i = 0; i < 1000; ++i) {
        const Vec3 n = random.direction(), u = any_perpendicular(n), v = cross(n, u);
        const double a = random.uniform(0, 6.3), b = random.uniform(0, 6.3), lift = random.uniform(0.05, 0.5);
        const auto on_tube = [&](double angle, double z) {
            return 5 * std::cos(angle) * u + 5 * std::sin(angle) * v + z * n;
        };
        // A rectangle of two chords: exactly flat but for rounding.
        const Corners p{on_tube(a, 0), on_tube(b, 0), on_tube(a, lift), on_tube(b, lift)};
        const ExactCentre truth = exact_circumcentre(p);
        if (!(truth.relative_determinant > 0)) continue;
        flat += truth.relative_determinant < 1e-8;
        const Vec3 c = circumcentre(p[0], p[1], p[2], p[3]);
        EXPECT_LE(distance(c, truth.centre), allowed_error(p, truth));
        const Vec3 e = p[1] - p[0], f = p[2] - p[0], g = p[3] - p[0];
        const Vec3 fg = cross(f, g);
        const double det = dot(e, fg);
        const Vec3 naive =
            p[0] + 0.5 / det * (squared_norm(e) * fg + squared_norm(f) * cross(g, e) + squared_norm(g) * cross(e, f));
        if (det != 0) naive_worst = std::max(naive_worst, distance(naive, truth.centre) / truth.radius);
    }
    EXPECT_GT(flat, 500);
    EXPECT_GT(naive_worst, 0.1) << "these cases are meant to be beyond double precision";
}

TEST(Circumcentre, FarFromTheOriginOnlyTheRoundingOfTheCoordinatesShows) {
    test::Random random(10);
    for (int i = 0; i < 300; ++i) {
        Corners p;
        for (Vec3& x : p) x = Vec3{1e6, -2e6, 3e6} + random.in_box({-1, -1, -1}, {1, 1, 1});
        const ExactCentre truth = exact_circumcentre(p);
        EXPECT_LE(distance(circumcentre(p[0], p[1], p[2], p[3]), truth.centre), allowed_error(p, truth));
    }
}

TEST(Circumcentre, CoplanarPointsHaveNoFiniteCentre) {
    const auto is_finite = [](Vec3 c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); };
    EXPECT_FALSE(is_finite(circumcentre({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}))) << "square";
    EXPECT_FALSE(is_finite(circumcentre({0, 0, 0}, {3, 1, 2}, {-1, 2, 5}, {5, 4, 9}))) << "a + b twice and once";
    EXPECT_FALSE(is_finite(circumcentre({1, 2, 3}, {2, 4, 6}, {3, 6, 9}, {4, 8, 12}))) << "collinear";
    EXPECT_FALSE(is_finite(circumcentre({1, 2, 3}, {1, 2, 3}, {3, 6, 9}, {4, 8, 1}))) << "two points alike";
    EXPECT_FALSE(is_finite(circumcentre({1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}))) << "one point";
    EXPECT_TRUE(is_finite(circumcentre({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1e-12}))) << "nearly square";
}

TEST(FlatTetrahedra, HeightOverTheLargestFaceDecides) {
    test::Random random(11);
    for (int i = 0; i < 2000; ++i) {
        // A triangle of random shape in general position and a point at a known height over it.
        const Vec3 a = random.in_box({-3, -3, -3}, {3, 3, 3}), b = random.in_box({-1, -1, -1}, {1, 1, 1}),
                   c = random.in_box({-1, -1, -1}, {1, 1, 1});
        const Vec3 n = normalized(cross(b - a, c - a));
        const double s = random.uniform(0.2, 0.4), t = random.uniform(0.2, 0.4),
                     height = 1e-6 * norm(cross(b - a, c - a));
        const Vec3 d = a + s * (b - a) + t * (c - a) + height * n;  // above the triangle: it is the largest face
        Corners p{a, b, c, d};
        for (int turn = 0; turn < 4; ++turn) {
            std::rotate(p.begin(), p.begin() + 1, p.end());
            EXPECT_TRUE(is_flat(p[0], p[1], p[2], p[3], 1.001 * height));
            EXPECT_FALSE(is_flat(p[0], p[1], p[2], p[3], 0.999 * height));
        }
    }
    EXPECT_TRUE(is_flat({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, 0)) << "coplanar";
}

}  // namespace
}  // namespace lumenline
