// Where jitter, noise, scale, offset and rounding put the vertices.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/phantom/phantom.h"
#include "tests/phantom/shapes.h"

namespace lumenline {
namespace {

using std::numbers::pi;

TEST(PhantomPlacement, JitterStaysWithinItsBoundsAndReachesThem) {
    for (const PhantomKind kind : {PhantomKind::kCylinder, PhantomKind::kHelix, PhantomKind::kHairpin}) {
        PhantomOptions options = shape_of(kind);
        const Phantom plain = make_phantom(options);
        options.jitter = 0.2;
        const Phantom p = make_phantom(options);
        ASSERT_EQ(p.points.size(), plain.points.size());
        const double bound = 0.2 * p.edge_length * (1 + 1e-9);  // rounding
        double most_along = 0, most_around = 0;
        for (std::size_t i = 0; i < p.points.size(); ++i) {
            const bool is_end = i < 40 || i + 40 >= p.points.size();
            const double s = p.truth.abscissa_of(p.points[i]);
            const double s0 = plain.truth.abscissa_of(plain.points[i]);
            const AxisFrame f = p.truth.frame(s);
            const AxisFrame f0 = p.truth.frame(s0);
            const auto angle = [](const AxisFrame& g, Vec3 x) {
                return std::atan2(dot(x - g.origin, g.e2), dot(x - g.origin, g.e1));
            };
            const double around =
                options.a * std::remainder(angle(f, p.points[i]) - angle(f0, plain.points[i]), 2 * pi);
            EXPECT_LE(std::fabs(s - s0), is_end ? 1e-9 * p.edge_length : bound);
            EXPECT_LE(std::fabs(around), bound);
            most_along = std::max(most_along, std::fabs(s - s0));
            most_around = std::max(most_around, std::fabs(around));
        }
        EXPECT_GT(most_along, 0.19 * p.edge_length);  // of more than 1,000 uniform draws
        EXPECT_GT(most_around, 0.19 * p.edge_length);
    }
}

TEST(PhantomPlacement, SameSeedSameBytesOtherSeedOtherBytes) {
    for (auto [name, options] : test_shapes()) {
        options.jitter = 0.2;
        const Phantom p = make_phantom(options);
        EXPECT_EQ(p.points, make_phantom(options).points) << name;
        EXPECT_EQ(p.triangles, make_phantom(options).triangles) << name;
        options.seed = 2;
        EXPECT_NE(p.points, make_phantom(options).points) << name;
    }
}

// The first word of mt19937_64 seeded with 5489 is fixed by its authors' reference output.
TEST(PhantomPlacement, RandomStreamIsTheOneOfTheReferenceGenerator) {
    PhantomOptions options;
    options.seed = 5489;
    options.jitter = 0.25;
    const Vec3 p = make_phantom(options).points[0];
    const double unit = static_cast<double>(14514284786278117030ULL >> 11) * 0x1p-53;
    EXPECT_NEAR(std::atan2(p.y, p.x), 2 * pi / 40 * 0.25 * (2 * unit - 1), 1e-15);
}

TEST(PhantomPlacement, NoiseIsNormalAlongTheNormalOnly) {
    for (const PhantomKind kind : {PhantomKind::kCylinder, PhantomKind::kTorus}) {
        PhantomOptions options = shape_of(kind);
        options.points_around = 120;
        options.jitter = 0.1;
        const Phantom plain = make_phantom(options);
        options.noise = 0.1;
        const Phantom p = make_phantom(options);
        const auto n = static_cast<double>(p.points.size());
        ASSERT_GT(n, 20000);
        const double tolerance = 1e-12 * extent_of(p);
        double sum = 0, squares = 0, fourth = 0;
        for (std::size_t i = 0; i < p.points.size(); ++i) {
            const double height = -p.truth.signed_distance(p.points[i]) / (0.1 * p.edge_length);
            // The step is along the normal: as long as the change of the distance to the wall.
            EXPECT_NEAR(distance(p.points[i], plain.points[i]), std::fabs(height) * 0.1 * p.edge_length, tolerance);
            sum += height;
            squares += height * height;
            fourth += std::pow(height, 4);
        }
        // Five standard errors of a normal sample's moments.
        EXPECT_NEAR(sum / n, 0, 5 / std::sqrt(n));
        EXPECT_NEAR(squares / n, 1, 5 * std::sqrt(2 / n));
        EXPECT_NEAR(fourth / n, 3, 5 * std::sqrt(96 / n));
    }
}

TEST(PhantomPlacement, NoiseLeavesEndRingsInTheirPlanesAndTheJitterStreamAlone) {
    PhantomOptions options = shape_of(PhantomKind::kStenosis);
    options.stenosis_width = 20;  // the wall is oblique at the ends
    options.noise = 0.1;
    const Phantom p = make_phantom(options);
    for (int i = 0; i < 40; ++i) EXPECT_NEAR(p.points[i].z, 0, 1e-15);
    for (std::size_t i = p.points.size() - 40; i < p.points.size(); ++i) EXPECT_NEAR(p.points[i].z, 50, 1e-12);

    options = PhantomOptions{};
    options.jitter = 0.2;
    const Phantom plain = make_phantom(options);
    options.noise = 0.1;
    const Phantom noisy = make_phantom(options);
    for (std::size_t i = 0; i < plain.points.size(); ++i) EXPECT_EQ(noisy.points[i].z, plain.points[i].z);
}

TEST(PhantomPlacement, Float32RoundsEveryFinalCoordinate) {
    for (auto [name, options] : test_shapes()) {
        const Phantom exact = make_phantom(options);
        options.float32 = true;
        const Phantom p = make_phantom(options);
        ASSERT_EQ(p.points.size(), exact.points.size());
        for (std::size_t i = 0; i < p.points.size(); ++i) {
            for (int k = 0; k < 3; ++k) ASSERT_EQ(p.points[i][k], static_cast<float>(exact.points[i][k])) << name;
        }
        double largest = 0;
        for (const Vec3& x : p.points) largest = std::max({largest, std::fabs(x.x), std::fabs(x.y), std::fabs(x.z)});
        EXPECT_EQ(to_soup(p).coordinate_rounding, 0x1p-24 * largest);
    }
}

TEST(PhantomPlacement, ScaleAndOffsetAreOneRoundingEach) {
    for (auto [name, options] : test_shapes()) {
        options.jitter = 0.2;
        options.noise = name == "hairpin almost touching" || name == "tight helix" ? 0.005 : 0.05;
        PhantomOptions unplaced = options;
        unplaced.scale = 1;
        unplaced.offset = {};
        const Phantom plain = make_phantom(unplaced);
        const Phantom p = make_phantom(options);
        EXPECT_EQ(p.triangles, plain.triangles) << name;
        EXPECT_EQ(p.edge_length, options.scale * plain.edge_length) << name;
        ASSERT_EQ(p.points.size(), plain.points.size()) << name;
        for (std::size_t i = 0; i < p.points.size(); ++i) {
            ASSERT_EQ(p.points[i], options.offset + options.scale * plain.points[i]) << name;
        }
    }
}

TEST(PhantomPlacement, SoupIsThePhantomItself) {
    const Phantom p = make_phantom(shape_of(PhantomKind::kTorus));
    const TriangleSoup soup = to_soup(p);
    EXPECT_EQ(soup.points, p.points);
    EXPECT_EQ(soup.triangles, p.triangles);
    EXPECT_EQ(soup.source_file, "phantom");
    EXPECT_TRUE(soup.source_sha256.empty());
    // The major radius and the tube's, up to the rounding of a sum.
    EXPECT_NEAR(soup.coordinate_rounding, 0x1p-53 * 25, 1e-12 * 0x1p-53 * 25);
}

}  // namespace
}  // namespace lumenline
