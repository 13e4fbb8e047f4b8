// The curved surface against walls that are known in closed form.
#include "engine/geometry/curved_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/condition/condition.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

Surface conditioned(const PhantomOptions& options) {
    StageContext context(Stage::kCondition);
    return condition_surface(to_soup(make_phantom(options)), {}, context);
}

PhantomOptions tube(PhantomKind kind, int points_around) {
    PhantomOptions options;
    options.kind = kind;
    options.points_around = points_around;
    options.jitter = 0.2;
    options.seed = 11;
    options.rotate = true;
    return options;
}

struct Errors {
    double flat = 0, curved = 0;  ///< mean |distance - true distance| / least radius
};

/// At points between a twentieth and three quarters of the inscribed radius from the wall: closer to the axis, feet are
/// those of whichever facet is nearest.
Errors errors_of(const PhantomOptions& options) {
    const Surface surface = conditioned(options);
    const PhantomTruth truth(options);
    const SurfaceDistance flat(surface.points, surface.triangles);
    CurvedSurface curved(surface, flat);
    test::Random random(3);
    Errors errors;
    constexpr int kCount = 2000;
    const Vec3 hint = surface.points[at(surface.triangles[0][0])];
    for (int i = 0; i < kCount; ++i) {
        const double s = random.uniform(0.1, 0.9) * truth.total_length();
        const WallPoint wall = truth.wall_point(s, random.uniform(0, 6.28));
        const Vec3 x = wall.point - random.uniform(0.05, 0.75) * truth.inscribed_radius(s) * wall.normal;
        const double expected = truth.signed_distance(x), unit = kCount * truth.min_section_radius();
        const SurfaceDistance::Nearest nearest = flat.nearest(x, hint, TriangleId(std::size_t{0}));
        errors.flat += std::fabs(nearest.distance - expected) / unit;
        const SurfaceFoot foot = curved.foot(x, nearest.point, nearest.triangle);
        errors.curved += std::fabs(distance(x, foot.point) - expected) / unit;
        EXPECT_NEAR(norm(foot.normal), 1, 1e-12);
    }
    return errors;
}

TEST(CurvedSurface, CylindersAreMetExactly) {
    for (const double b : {5.0, 4.0}) {
        PhantomOptions options = tube(PhantomKind::kCylinder, 20);
        options.b = b;
        const Errors errors = errors_of(options);
        EXPECT_GT(errors.flat, 5e-3);
        // What is left are feet of a facet beside the nearest one, and the limit of their last step.
        EXPECT_LT(errors.curved, 1e-4);
    }
}

TEST(CurvedSurface, DistanceConvergesToThirdOrder) {
    for (const PhantomKind kind : {PhantomKind::kTorus, PhantomKind::kStenosis}) {
        const Errors coarse = errors_of(tube(kind, 20)), fine = errors_of(tube(kind, 40));
        // Twice the points: a factor four for facets, measured 9 to 12 for patches; eight is third order.
        EXPECT_GT(coarse.flat / fine.flat, 3.5);
        EXPECT_GT(coarse.curved / fine.curved, 7);
        EXPECT_LT(fine.curved, 0.02 * fine.flat);
    }
}

TEST(CurvedSurface, NoiseMakesItNoWorseThanItsFacets) {
    for (const double noise : {0.05, 0.1}) {
        PhantomOptions options = tube(PhantomKind::kCylinder, 30);
        options.noise = noise;
        const Errors errors = errors_of(options);
        EXPECT_LT(errors.curved, errors.flat);
    }
}

TEST(CurvedSurface, UncertaintyIsTheNoiseOfTheSites) {
    PhantomOptions options = tube(PhantomKind::kCylinder, 30);
    options.noise = 0.1;
    const Phantom phantom = make_phantom(options);
    const Surface surface = conditioned(options);
    const SurfaceDistance flat(surface.points, surface.triangles);
    CurvedSurface curved(surface, flat);
    double sum2 = 0;
    int count = 0;
    for (std::size_t t = 0; t < surface.triangles.size(); t += 5, ++count) {
        const Vec3 x = surface.points[at(surface.triangles[t][0])];
        const double u = curved.uncertainty(curved.foot(x, x, TriangleId(t)));
        sum2 += u * u;
    }
    // The neighbours' own noise adds to the site's; extensions have none.
    const double mean = std::sqrt(sum2 / count) / (options.noise * phantom.edge_length);
    EXPECT_GT(mean, 0.6);
    EXPECT_LT(mean, 2.0);
}

TEST(QuadricFit, PlaneOfNoisySitesStaysFlat) {
    test::Random random(8);
    std::vector<Vec3> around;
    for (int i = 0; i < 18; ++i)
        around.push_back({random.uniform(-1, 1), random.uniform(-1, 1), 0.01 * random.uniform(-1, 1)});
    const Quadric quadric = fit_quadric(around, {0, 0, 1});
    EXPECT_LT(quadric.share, 0.7);
    EXPECT_LT(std::fabs(quadric.offset), 0.03);
    EXPECT_EQ(fit_quadric(std::vector<Vec3>(around.begin(), around.begin() + 5), {0, 0, 1}).share, 0);
    EXPECT_EQ(fit_quadric({}, {0, 0, 1}).share, 0);
}

TEST(NearestVertex, IsTheLeastDistanceToAnySite) {
    const Surface surface = conditioned(tube(PhantomKind::kTorus, 16));
    const SurfaceDistance flat(surface.points, surface.triangles);
    test::Random random(4);
    for (int i = 0; i < 200; ++i) {
        const Vec3 x = surface.points[random.below(surface.site_count())] + random.uniform(0, 4) * random.direction();
        double least = surface.diagonal;
        for (const Vec3& p : surface.points) least = std::min(least, distance(x, p));
        EXPECT_DOUBLE_EQ(flat.nearest_vertex(x, surface.diagonal), least);
    }
}

}  // namespace
}  // namespace lumenline
