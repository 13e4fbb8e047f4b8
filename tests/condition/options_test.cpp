// Each repair can be switched off, and then refuses what it would have mended; components, specks, decimation.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/condition/crossing_repair.h"
#include "engine/condition/crossings.h"
#include "tests/condition/shapes.h"

namespace lumenline::testing {
namespace {

TriangleSoup clean_tube() { return round_tube(24, 31, 2, 16); }

TriangleSoup moved(TriangleSoup soup, Vec3 by) {
    for (Vec3& p : soup.points) p += by;
    return soup;
}

TEST(Switch, OffRefusesWhatItWouldMend) {
    ConditionOptions options;
    TriangleSoup soup = clean_tube();
    soup.triangles.push_back(soup.triangles[7]);
    EXPECT_EQ(refusal(soup, options), "");
    options.drop_faces = false;
    EXPECT_EQ(refusal(soup, options), "repair_off");
    EXPECT_EQ(refusal(clean_tube(), options), "");

    options = {};
    soup = clean_tube();
    std::swap(soup.triangles[9][0], soup.triangles[9][1]);
    EXPECT_EQ(refusal(soup, options), "");
    options.orient_faces = false;
    EXPECT_EQ(refusal(soup, options), "repair_off");
    soup = clean_tube();
    for (auto& t : soup.triangles) std::swap(t[0], t[1]);
    EXPECT_EQ(refusal(soup, options), "repair_off");
    EXPECT_EQ(refusal(clean_tube(), options), "");

    options = {};
    soup = clean_tube();
    soup.points.push_back({4, 0, 8});
    soup.triangles.push_back({24 * 15, 24 * 16, static_cast<std::uint32_t>(soup.points.size() - 1)});
    EXPECT_EQ(refusal(soup, options), "");
    options.split_non_manifold = false;
    EXPECT_EQ(refusal(soup, options), "repair_off");
    EXPECT_EQ(refusal(clean_tube(), options), "");
}

TEST(Coordinates, BeyondTheLimitsAreRefused) {
    for (const double bad : {1.1e20, -1e30, 1e300, std::numeric_limits<double>::infinity()}) {
        TriangleSoup soup = clean_tube();
        soup.points[100].y = bad;
        EXPECT_EQ(refusal(soup), "bad_coordinate") << bad;
    }
    // A whole model of that size has nothing wrong with it, and one just below the limit neither.
    EXPECT_EQ(refusal(mapped(clean_tube(), [](Vec3 p) { return 1e18 * p; })), "");
    EXPECT_EQ(refusal(mapped(clean_tube(), [](Vec3 p) { return 1e-18 * p; })), "");
    EXPECT_EQ(refusal(mapped(clean_tube(), [](Vec3 p) { return 1e-24 * p; })), "bad_coordinate");
    EXPECT_EQ(refusal(mapped(clean_tube(), [](Vec3 p) { return 1e-300 * p; })), "bad_coordinate");
}

TEST(Specks, BelowTheShareAreRemoved) {
    const TriangleSoup soup = merged(clean_tube(), cube(2, {20, 0, 0}, 0.05));  // area .06 of 200
    const Conditioned result = condition(soup);
    EXPECT_EQ(result.value("speck_removed"), 1);
    EXPECT_EQ(result.surface.component_count, 1);
    EXPECT_EQ(result.count("multiple_components"), 0U);
    ConditionOptions all;
    all.speck_share = 0;
    EXPECT_EQ(condition(soup, all).surface.component_count, 2);
    // One that lies inside the lumen is a speck too, and no reason to refuse the model.
    EXPECT_EQ(refusal(merged(clean_tube(), cube(2, {0, 0, 8}, 0.05))), "");
}

TEST(Components, AreRefusedSelectedOrKept) {
    const TriangleSoup longer = round_tube(24, 41, 2, 21);
    const TriangleSoup soup = merged(moved(clean_tube(), {20, 0, 0}), longer);
    ConditionOptions options;
    options.components = ComponentPolicy::kFail;
    EXPECT_EQ(refusal(soup, options), "several_components");
    EXPECT_EQ(refusal(longer, options), "");
    options.components = ComponentPolicy::kLargest;
    const Conditioned largest = condition(soup, options);
    EXPECT_EQ(largest.value("component_dropped"), 1);
    EXPECT_EQ(largest.surface.openings.size(), 2U);
    EXPECT_NEAR(std::fabs(largest.surface.openings[0].point.x), 0, 1e-12);
    options.components = ComponentPolicy::kEach;
    const Conditioned each = condition(soup, options);
    EXPECT_EQ(each.surface.component_count, 2);
    EXPECT_EQ(each.surface.openings.size(), 4U);
}

TEST(Decimation, KeepsTheSurfaceWithinTheError) {
    const TriangleSoup fine = round_tube(60, 121, 2, 16);
    ConditionOptions options;
    options.decimate = 1e-3;
    const Conditioned result = condition(fine, options);
    EXPECT_EQ(result.count("decimated"), 1U);
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_EQ(result.surface.openings.size(), 2U);
    EXPECT_LT(count_origin(result.surface, SiteOrigin::kWall), fine.points.size() / 2);
    const double error = 1e-3 * result.surface.diagonal;
    // Sites are points of the input; the middles of triangles stay as close to the circle as the error and the
    // sagitta of the input's own sides allow.
    const double sagitta = 2 * (1 - std::cos(std::numbers::pi / 60));
    for (std::size_t t = 0; t < result.surface.triangles.size(); ++t) {
        if (!result.surface.cap[t].is_none()) continue;
        Vec3 middle;
        for (const SiteId s : result.surface.triangles[t]) middle += (1.0 / 3) * result.surface.points[at(s)];
        EXPECT_NEAR(std::hypot(middle.x, middle.y), 2, 2 * error + sagitta);
    }
    for (std::size_t s = 0; s < result.surface.site_count(); ++s)
        if (result.surface.input_vertex[s] != SiteId::kNoneValue) {
            EXPECT_EQ(result.surface.points[s], fine.points[result.surface.input_vertex[s]]);
        }
}

// A vertex pushed in so deep that it comes out of the opposite wall.
TriangleSoup dented_tube() {
    TriangleSoup soup = clean_tube();
    Vec3& p = soup.points[15 * 24 + 5];
    p = {-1.3 * p.x, -1.3 * p.y, p.z};
    return soup;
}

TEST(Crossings, ThatAreLocalAreRepaired) {
    const Conditioned result = condition(dented_tube());
    EXPECT_EQ(result.count("self_intersections"), 0U);
    EXPECT_EQ(result.count("self_intersections_repaired"), 1U);
    EXPECT_EQ(crossings(result.surface), 0U);
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_EQ(result.surface.openings.size(), 2U);
    const double clean = volume(condition(clean_tube()).surface);
    EXPECT_NEAR(volume(result.surface), clean, 0.005 * clean);

    ConditionOptions options;
    options.repair_self_intersections = false;
    const Conditioned kept = condition(dented_tube(), options);
    EXPECT_EQ(kept.count("self_intersections_repaired"), 0U);
    EXPECT_EQ(kept.count("self_intersections"), 1U);
}

TEST(Crossings, OfTwoVesselsAreReportedOnly) {
    // Two tubes that pass through each other: no patch can mend that.
    const TriangleSoup other = mapped(clean_tube(), [](Vec3 p) { return Vec3{p.z - 8, p.y + 0.5, p.x + 8}; });
    const Conditioned result = condition(merged(clean_tube(), other));
    EXPECT_EQ(result.count("self_intersections"), 1U);
    EXPECT_EQ(result.count("self_intersections_repaired"), 0U);
    EXPECT_EQ(result.surface.component_count, 2);
}

}  // namespace
}  // namespace lumenline::testing
