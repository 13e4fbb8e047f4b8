// Dirty input that can be used: each defect is mended, reported, and does not show in the result.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "engine/condition/holes.h"
#include "tests/condition/shapes.h"

namespace lumenline::testing {
namespace {

constexpr std::uint32_t kAround = 24;

TriangleSoup clean_tube() { return round_tube(kAround, 31, 2, 16); }

std::uint32_t vertex(std::uint32_t i, std::uint32_t ring) { return ring * kAround + i; }

bool uses(const std::array<std::uint32_t, 3>& t, std::uint32_t v) { return std::count(t.begin(), t.end(), v) > 0; }

void erase_fan(TriangleSoup& soup, std::uint32_t centre) {
    std::erase_if(soup.triangles, [=](const auto& t) { return uses(t, centre); });
}

TEST(Weld, JoinsTheCornersOfLooseTriangles) {
    const TriangleSoup soup = clean_tube();
    const Conditioned loose = condition(exploded(soup)), whole = condition(soup);
    EXPECT_EQ(loose.value("welded_vertices"), static_cast<double>(3 * soup.triangles.size() - soup.points.size()));
    EXPECT_EQ(loose.warnings(), 0U);
    EXPECT_TRUE(is_closed_manifold(loose.surface));
    EXPECT_EQ(loose.surface.site_count(), whole.surface.site_count());
    EXPECT_NEAR(volume(loose.surface), volume(whole.surface), 0.01 * volume(whole.surface));
}

TEST(Weld, ToleranceDecidesWhatIsOnePlace) {
    TriangleSoup soup = exploded(clean_tube());
    std::mt19937 random(1);
    std::uniform_real_distribution<double> noise(-1e-8, 1e-8);
    for (Vec3& p : soup.points) p += {noise(random), noise(random), noise(random)};
    EXPECT_TRUE(is_closed_manifold(condition(soup).surface));
    EXPECT_EQ(refusal(soup, 0), "open_boundary");
}

TEST(Weld, KeepsTheLowestVertexAndTellsWhereSitesComeFrom) {
    TriangleSoup soup = clean_tube();
    const Vec3 p = soup.points[100];
    soup.points.push_back(p + Vec3{0, 0, 1e-9});
    for (auto& t : soup.triangles)
        if (uses(t, 100) && uses(t, 101))
            std::replace(t.begin(), t.end(), 100U, static_cast<std::uint32_t>(soup.points.size() - 1));
    const Conditioned result = condition(soup);
    EXPECT_EQ(result.value("welded_vertices"), 1);
    EXPECT_EQ(result.surface.points[100], p);
    EXPECT_EQ(result.surface.input_vertex[100], 100U);
    EXPECT_TRUE(is_closed_manifold(result.surface));
}

TEST(Soup, LosesDegenerateRepeatedAndUnusedParts) {
    TriangleSoup soup = clean_tube();
    soup.triangles.push_back({5, 5, 9});
    soup.triangles.push_back(soup.triangles[7]);
    auto turned = soup.triangles[8];
    std::swap(turned[0], turned[2]);
    soup.triangles.push_back(turned);
    soup.points.insert(soup.points.begin(), {1e6, 1e6, 1e6});  // far away: must not count for the diagonal
    for (auto& t : soup.triangles)
        for (auto& v : t) ++v;
    const Conditioned result = condition(soup), clean = condition(clean_tube());
    EXPECT_EQ(result.value("degenerate_triangles"), 1);
    EXPECT_EQ(result.value("duplicate_triangles"), 2);
    EXPECT_EQ(result.value("unreferenced_vertices"), 1);
    EXPECT_EQ(result.warnings(), 0U);
    EXPECT_EQ(result.surface.triangles, clean.surface.triangles);
    EXPECT_EQ(result.surface.points, clean.surface.points);
    EXPECT_EQ(result.surface.diagonal, clean.surface.diagonal);
    EXPECT_EQ(result.surface.input_vertex[0], 1U);
}

TEST(Orientation, OfRandomlyTurnedTrianglesIsRestored) {
    TriangleSoup soup = clean_tube();
    std::mt19937 random(3);
    std::size_t turned = 0;
    for (auto& t : soup.triangles) {
        if (random() % 5 != 0) continue;
        std::swap(t[1], t[2]);
        ++turned;
    }
    const Conditioned result = condition(soup), clean = condition(clean_tube());
    EXPECT_EQ(result.value("triangles_reoriented"), static_cast<double>(turned));
    EXPECT_EQ(result.count("non_manifold_split"), 0U);
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_EQ(result.surface.site_count(), clean.surface.site_count());
    EXPECT_DOUBLE_EQ(volume(result.surface), volume(clean.surface));
}

TEST(NonManifold, FinIsTornOffAndRemoved) {
    TriangleSoup soup = clean_tube();
    soup.points.push_back({4, 0, 8});
    const auto tip = static_cast<std::uint32_t>(soup.points.size() - 1);
    soup.triangles.push_back({vertex(0, 15), vertex(0, 16), tip});
    const Conditioned result = condition(soup), clean = condition(clean_tube());
    EXPECT_EQ(result.count("non_manifold_split"), 1U);
    EXPECT_EQ(result.value("fragment_removed"), 1);
    EXPECT_EQ(result.count("multiple_components"), 0U);
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_EQ(result.surface.points, clean.surface.points);
}

TEST(NonManifold, RowOfFinsLeavesNoSlit) {
    TriangleSoup soup = clean_tube();
    for (std::uint32_t ring = 10; ring < 16; ++ring) {
        soup.points.push_back({4, 0, 0.5 * ring});
        const auto tip = static_cast<std::uint32_t>(soup.points.size() - 1);
        soup.triangles.push_back({vertex(0, ring), vertex(0, ring + 1), tip});
        if (ring > 10) soup.triangles.push_back({vertex(0, ring), tip, tip - 1});
    }
    const Conditioned result = condition(soup), clean = condition(clean_tube());
    EXPECT_EQ(result.value("fragment_removed"), 11);
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_EQ(result.surface.openings.size(), 2U);
    EXPECT_EQ(result.surface.points, clean.surface.points);
}

TEST(NonManifold, CubesOnACommonEdgeBecomeTwo) {
    const TriangleSoup soup = merged(cube(4, {0, 0, 0}), cube(4, {2, 2, 0}));
    const Conditioned result = condition(soup);
    EXPECT_EQ(result.value("welded_vertices"), 5);
    EXPECT_EQ(result.count("non_manifold_split"), 1U);
    EXPECT_EQ(result.surface.component_count, 2);
    EXPECT_EQ(result.count("multiple_components"), 1U);
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_NEAR(volume(result.surface), 16, 1e-12);
    ASSERT_EQ(result.surface.site_count(), soup.points.size());
    for (std::size_t s = 0; s < soup.points.size(); ++s)
        EXPECT_EQ(result.surface.points[s], soup.points[result.surface.input_vertex[s]]);
}

TEST(NonManifold, BowTieVertexIsSplit) {
    const TriangleSoup soup = merged(cube(3, {0, 0, 0}), cube(3, {2, 2, 2}));
    const Conditioned result = condition(soup);
    EXPECT_EQ(result.value("welded_vertices"), 1);
    EXPECT_EQ(result.value("non_manifold_split"), 1);
    EXPECT_EQ(result.surface.component_count, 2);
    EXPECT_TRUE(is_closed_manifold(result.surface));
}

TEST(Components, ApartAreKeptWithAWarning) {
    const TriangleSoup soup = merged(clean_tube(), mapped(clean_tube(), [](Vec3 p) {
                                         return Vec3{p.x + 20, p.y, p.z};
                                     }));
    const Conditioned result = condition(soup);
    EXPECT_EQ(result.surface.component_count, 2);
    EXPECT_EQ(result.surface.openings.size(), 4U);
    EXPECT_EQ(result.value("multiple_components"), 2);
    EXPECT_EQ(result.warnings(), 1U);
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_EQ(euler_characteristic(result.surface), 4);
    EXPECT_EQ(result.surface.genus, 0);
}

TEST(Hole, OfOneTriangleIsFilled) {
    TriangleSoup soup = clean_tube();
    const auto missing = soup.triangles[500];
    soup.triangles.erase(soup.triangles.begin() + 500);
    const Conditioned result = condition(soup), clean = condition(clean_tube());
    EXPECT_EQ(result.value("hole_filled"), 3);
    EXPECT_EQ(result.surface.openings.size(), 2U);
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_EQ(result.surface.points, clean.surface.points);
    const auto& filling = result.surface.triangles[soup.triangles.size()];
    EXPECT_TRUE(uses(missing, filling[0].value) && uses(missing, filling[1].value) && uses(missing, filling[2].value));
    EXPECT_TRUE(result.surface.cap[soup.triangles.size()].is_none());
}

TEST(Hole, OfTwoTrianglesIsFilled) {
    TriangleSoup soup = clean_tube();
    soup.triangles.erase(soup.triangles.begin() + 500, soup.triangles.begin() + 502);
    const Conditioned result = condition(soup);
    EXPECT_EQ(result.value("hole_filled"), 4);
    EXPECT_EQ(result.surface.openings.size(), 2U);
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_EQ(crossings(result.surface), 0U);
}

TEST(Hole, WhoseShortDiagonalIsAnEdgeElsewhereGetsAVertex) {
    // Triangle (p, q, r) of a tetrahedron with an ear b folded out over p r: the square p q r b is open,
    // and its diagonal p r is the ear's own edge.
    WallMesh wall;
    wall.points = {{0, 0, 0}, {2, -0.1, 0}, {0, 0.2, 0}, {-2, 0.1, 0}, {0, 0, -3}};
    wall.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 0, 4}, {0, 2, 3}};
    wall.input_vertex = {0, 1, 2, 3, 4};
    StageContext context(Stage::kCondition);
    WallTopology topology{{{0, 1, 2, 3}}, std::vector<std::uint32_t>(5, 0), 1};
    fill_holes(wall, topology, 2, context);
    EXPECT_TRUE(topology.loops.empty());
    EXPECT_EQ(wall.points.size(), 6U);
    EXPECT_EQ(wall.triangles.size(), 8U);
}

TEST(Hole, OfOneVertexInTheWallIsFilled) {
    TriangleSoup soup = clean_tube();
    erase_fan(soup, vertex(5, 15));
    const Conditioned result = condition(soup);
    EXPECT_EQ(result.value("hole_filled"), 6);
    EXPECT_EQ(result.value("boundary_loops"), 3);
    EXPECT_EQ(result.count("opening_in_wall"), 0U);
    EXPECT_EQ(result.surface.openings.size(), 2U);
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_EQ(crossings(result.surface), 0U);
    for (std::size_t s = 0; s < result.surface.site_count(); ++s)
        if (result.surface.origin[s] == SiteOrigin::kWall && result.surface.input_vertex[s] == SiteId::kNoneValue) {
            EXPECT_NEAR(std::hypot(result.surface.points[s].x, result.surface.points[s].y), 2, 0.1);  // sagitta .07
        }
}

TEST(Hole, IsKeptAsAnOpeningWhereFillingIsOff) {
    TriangleSoup soup = clean_tube();
    erase_fan(soup, vertex(5, 15));
    ConditionOptions options;
    options.fill_holes = false;
    EXPECT_EQ(condition(soup, options).surface.openings.size(), 3U);
}

TEST(Hole, TooLargeIsAnOpeningAndSuspicious) {
    TriangleSoup soup = clean_tube();
    std::vector<std::uint32_t> centres;
    for (std::uint32_t ring = 14; ring < 17; ++ring)
        for (std::uint32_t i = 4; i < 7; ++i) centres.push_back(vertex(i, ring));
    for (const std::uint32_t v : centres) erase_fan(soup, v);
    const Conditioned result = condition(soup);
    EXPECT_EQ(result.count("hole_filled"), 0U);
    EXPECT_EQ(result.count("opening_in_wall"), 1U);
    EXPECT_EQ(result.surface.openings.size(), 3U);
    EXPECT_TRUE(is_closed_manifold(result.surface));
}

TEST(Hole, AsWideAsTheVesselIsSuspicious) {
    // Half of the way around and longer than the radius: the wall beside it faces all ways.
    for (const double half : {1.0, 1.3}) {
        TriangleSoup soup = round_tube(40, 81, 2, 20);
        std::erase_if(soup.triangles, [&](const Corners& t) {
            const Vec3 p = (1.0 / 3) * (soup.points[t[0]] + soup.points[t[1]] + soup.points[t[2]]);
            return std::fabs(p.z - 10) < 2 * half && std::fabs(std::atan2(p.y, p.x)) < half;
        });
        const Conditioned result = condition(soup);
        EXPECT_EQ(result.count("opening_in_wall"), 1U);
        EXPECT_EQ(result.surface.openings.size(), 3U);
    }
}

TEST(Hole, ThatIsAVesselsEndStaysAnOpening) {
    // A square tube, so thin that its end has four edges.
    const Conditioned result = condition(tube(4, 60, [](std::size_t i, std::size_t k) {
        const double a = std::numbers::pi * static_cast<double>(i) / 2;
        return Vec3{std::cos(a), std::sin(a), static_cast<double>(k)};
    }));
    EXPECT_EQ(result.surface.openings.size(), 2U);
    EXPECT_EQ(result.count("hole_filled"), 0U);
    EXPECT_TRUE(is_closed_manifold(result.surface));
}

TEST(Hole, SharingAVertexWithAnotherIsClosedOnItsOwn) {
    TriangleSoup soup = clean_tube();
    erase_fan(soup, vertex(5, 15));
    erase_fan(soup, vertex(7, 15));  // (6, 15) is a corner of both holes
    ConditionOptions options;
    options.fill_holes = false;
    options.refine_undersampled = false;
    EXPECT_EQ(condition(soup).count("hole_filled"), 2U);
    EXPECT_TRUE(is_closed_manifold(condition(soup).surface));
    const Conditioned result = condition(soup, options);
    EXPECT_EQ(result.surface.openings.size(), 4U);
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_EQ(euler_characteristic(result.surface), 2);
    EXPECT_EQ(count_origin(result.surface, SiteOrigin::kWall), soup.points.size() - 2);
}

TEST(ThinTriangle, KeepsTheTopologyAndHasNoSayInNormals) {
    TriangleSoup soup = clean_tube();
    // A vertex in the middle of an edge that only one of the two triangles there knows, and the
    // triangle without area between them.
    const auto first = soup.triangles[500];
    soup.points.push_back(lerp(soup.points[first[0]], soup.points[first[1]], 0.5));
    const auto middle = static_cast<std::uint32_t>(soup.points.size() - 1);
    soup.triangles[500] = {middle, first[1], first[2]};
    soup.triangles.push_back({first[0], middle, first[2]});
    soup.triangles.push_back({first[0], first[1], middle});
    const Conditioned result = condition(soup);
    EXPECT_EQ(result.value("zero_area_triangles"), 1);
    EXPECT_TRUE(is_closed_manifold(result.surface));
    for (const Vec3& n : result.surface.normals) EXPECT_NEAR(norm(n), 1, 1e-12);
    const Vec3 p = result.surface.points[middle];
    EXPECT_GT(dot(result.surface.normals[middle], normalized({p.x, p.y, 0})), 0.9);
}

TEST(ThinTriangle, OnlyOnesAroundASiteTakeTheNeighboursNormal) {
    TriangleSoup soup = clean_tube();
    // Triangle (a, b, c) split at a point of its side a b: the point's own two triangles without area.
    const auto t = soup.triangles[500];
    const Vec3 a = soup.points[t[0]], b = soup.points[t[1]];
    const auto n = static_cast<std::uint32_t>(soup.points.size());
    soup.points.push_back(lerp(a, b, 0.25));
    soup.points.push_back(lerp(a, b, 0.75));
    soup.points.push_back(lerp(a, b, 0.5));
    soup.triangles[500] = {t[2], t[0], n};
    soup.triangles.push_back({t[2], n, n + 1});
    soup.triangles.push_back({t[2], n + 1, t[1]});
    soup.triangles.push_back({n, n + 2, n + 1});
    soup.triangles.push_back({t[0], n + 2, n});
    soup.triangles.push_back({n + 1, n + 2, t[1]});
    soup.triangles.push_back({t[0], t[1], n + 2});
    // The folds cross each other, and would be smoothed out with the whole place.
    ConditionOptions options;
    options.repair_self_intersections = false;
    options.refine_undersampled = false;
    const Conditioned result = condition(soup, options);
    EXPECT_EQ(result.value("zero_area_triangles"), 4);
    EXPECT_TRUE(is_closed_manifold(result.surface));
    for (const Vec3& normal : result.surface.normals) EXPECT_NEAR(norm(normal), 1, 1e-12);
}

}  // namespace
}  // namespace lumenline::testing
