// Flat caps of phantoms are taken off; boxes, domes and flattened coarse tubes have none.
#include "engine/condition/flat_caps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/condition/condition.h"
#include "engine/phantom/phantom.h"
#include "tests/condition/shapes.h"

namespace lumenline::testing {
namespace {

Conditioned opened(const TriangleSoup& soup, FlatCaps caps = FlatCaps::kOpen) {
    ConditionOptions options;
    options.check_self_intersections = false;
    options.flat_caps = caps;
    StageContext context(Stage::kCondition);
    Conditioned result;
    result.surface = condition_surface(soup, options, context);
    result.diagnostics = context.diagnostics();
    return result;
}

PhantomOptions capped_cylinder() {
    PhantomOptions options;
    options.length = 30;
    options.points_around = 24;
    options.jitter = 0.2;
    options.caps = true;
    options.rotate = true;
    return options;
}

TEST(FlatCaps, PhantomsLoseTheirCaps) {
    for (const PhantomKind kind : {PhantomKind::kCylinder, PhantomKind::kHairpin})
        for (const double scale : {1e-3, 1.0})
            for (const bool float32 : {false, true}) {
                PhantomOptions options = capped_cylinder();
                options.kind = kind;
                options.scale = scale;
                options.float32 = float32;
                options.offset = {100 * scale, 0, 0};
                const Phantom phantom = make_phantom(options);
                const Conditioned result = opened(to_soup(phantom));
                ASSERT_EQ(result.surface.openings.size(), 2U) << phantom_name(kind) << scale << float32;
                EXPECT_EQ(result.value("flat_caps_opened"), 2);
                EXPECT_TRUE(is_closed_manifold(result.surface));
                for (const Opening& o : result.surface.openings) {
                    EXPECT_TRUE(o.flat_cap);
                    EXPECT_GT(o.extension_length, 0);
                    // The polygon of 24 has 99 % of the circle's radius.
                    EXPECT_NEAR(o.radius, 5 * scale, 0.02 * 5 * scale);
                    const double s = phantom.truth.abscissa_of(o.point);
                    EXPECT_LT(std::min(s, phantom.truth.total_length() - s), 0.01 * 5 * scale);
                }
            }
}

TEST(FlatCaps, StayWhereTheyAreNotAskedFor) {
    const TriangleSoup soup = to_soup(make_phantom(capped_cylinder()));
    EXPECT_TRUE(opened(soup, FlatCaps::kKeep).surface.openings.empty());
    EXPECT_EQ(opened(soup, FlatCaps::kOpenIfClosed).surface.openings.size(), 2U);
    TriangleSoup open = soup;
    const PhantomTruth truth(capped_cylinder());
    std::erase_if(open.triangles, [&](const Corners& t) {
        return std::all_of(t.begin(), t.end(),
                           [&](std::uint32_t v) { return truth.abscissa_of(open.points[v]) < 1e-6; });
    });
    const Conditioned half = opened(open, FlatCaps::kOpenIfClosed);
    ASSERT_EQ(half.surface.openings.size(), 1U);
    EXPECT_FALSE(half.surface.openings[0].flat_cap);
    const Conditioned both = opened(open, FlatCaps::kOpen);
    ASSERT_EQ(both.surface.openings.size(), 2U);
    EXPECT_NE(both.surface.openings[0].flat_cap, both.surface.openings[1].flat_cap);
}

TEST(FlatCaps, BoxesHaveNoneButTheEndsOfALongOne) {
    EXPECT_TRUE(opened(cube(6, {})).surface.openings.empty());
    const auto stretched = [](double x, double y, double z) {
        return mapped(cube(8, {}), [=](Vec3 p) { return Vec3{x * p.x, y * p.y, z * p.z}; });
    };
    EXPECT_TRUE(opened(stretched(4, 4, 1)).surface.openings.empty());
    EXPECT_TRUE(opened(stretched(1.3, 1, 1.6)).surface.openings.empty());
    EXPECT_EQ(opened(stretched(1, 1, 6)).surface.openings.size(), 2U);
}

TEST(FlatCaps, WallOfACoarseFlattenedTubeIsNone) {
    // Ten vertices around an ellipse of aspect three: its broad sides are nearly plane and turn by 40 degrees and more.
    PhantomOptions options = capped_cylinder();
    options.a = 9;
    options.b = 3;
    options.points_around = 10;
    options.jitter = 0;
    for (const double length : {12.0, 20.0, 60.0}) {
        options.length = length;
        const Conditioned result = opened(to_soup(make_phantom(options)));
        for (const Opening& o : result.surface.openings)
            EXPECT_GT(std::fabs(dot(o.normal, PhantomTruth(options).tangent(0))), 0.99) << length;
    }
}

TEST(FlatCaps, DomesAreNoneUnlessLabelled) {
    const PhantomOptions options = capped_cylinder();
    const PhantomTruth truth(options);
    TriangleSoup soup = to_soup(make_phantom(options));
    CellLabels labels{"ModelFaceID", {}};
    for (const auto& t : soup.triangles)
        labels.values.push_back(
            std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return truth.abscissa_of(soup.points[v]) < 1e-6; })
                ? 2
                : 1);
    const auto domed = [&](double height) {
        TriangleSoup result = soup;
        for (Vec3& p : result.points) {
            const double r = truth.distance_to_axis(p);
            if (truth.abscissa_of(p) < 1e-6 && r < 5) p += -height * 5 * (1 - r * r / 25) * truth.tangent(0);
        }
        return result;
    };
    const auto count = [](const TriangleSoup& s) { return opened(s).surface.openings.size(); };
    EXPECT_EQ(count(domed(0.08)), 1U) << "only the flat one";
    TriangleSoup labelled = domed(0.08);
    labelled.cell_labels = {labels};
    EXPECT_EQ(count(labelled), 2U);
    TriangleSoup high = domed(0.5);
    high.cell_labels = {labels};
    EXPECT_EQ(count(high), 1U) << "a label does not make a dome flat";
}

}  // namespace
}  // namespace lumenline::testing
