// Input that cannot be used, and each check of the result seen to fail.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "engine/condition/cgal_repair.h"
#include "engine/condition/crossings.h"
#include "engine/condition/finish.h"
#include "engine/condition/half_edges.h"
#include "tests/condition/shapes.h"

namespace lumenline::testing {
namespace {

using std::numbers::pi;

TEST(Refusal, OfNothing) {
    EXPECT_EQ(refusal({}), "no_surface");
    TriangleSoup points_only;
    points_only.points = {{0, 0, 0}, {1, 0, 0}};
    EXPECT_EQ(refusal(points_only), "no_surface");
}

TEST(Refusal, OfNothingButDegenerateTriangles) {
    TriangleSoup soup = cube(2, {0, 0, 0});
    for (auto& t : soup.triangles) t[1] = t[0];
    EXPECT_EQ(refusal(soup), "no_surface");
    // All vertices at one place: everything is within the tolerance.
    EXPECT_EQ(refusal(mapped(cube(2, {0, 0, 0}), [](Vec3) { return Vec3{1, 2, 3}; })), "no_surface");
}

TEST(Refusal, OfCoordinatesThatAreNotFinite) {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        TriangleSoup soup = cube(2, {0, 0, 0});
        soup.points[3].y = bad;
        std::string sentence;
        EXPECT_EQ(refusal(soup, 1e-7, &sentence), "bad_coordinate");
        EXPECT_NE(sentence.find("vertex 3"), std::string::npos) << sentence;
    }
    EXPECT_EQ(refusal(mapped(cube(2, {0, 0, 0}), [](Vec3 p) { return 1e300 * p; })), "bad_coordinate");
}

TEST(Refusal, OfIndicesBeyondTheVertices) {
    TriangleSoup soup = cube(2, {0, 0, 0});
    soup.triangles[5][2] = 1000;
    EXPECT_EQ(refusal(soup), "file_format");
}

TEST(Refusal, OfACubeThatCannotBeWelded) {
    TriangleSoup soup = exploded(cube(1, {0, 0, 0}));
    for (std::size_t v = 0; v < soup.points.size(); ++v)
        soup.points[v].x += 1e-3 * std::sin(7.0 * static_cast<double>(v));
    std::string sentence;
    EXPECT_EQ(refusal(soup, 1e-7, &sentence), "open_boundary");
    EXPECT_NE(sentence.find("weld"), std::string::npos) << sentence;
}

TEST(Refusal, OfAFlatSheet) {
    TriangleSoup sheet;
    constexpr std::uint32_t n = 60;
    for (std::uint32_t i = 0; i <= n; ++i)
        for (std::uint32_t j = 0; j <= n; ++j) sheet.points.push_back({1.0 * i, 1.0 * j, 0.1 * std::sin(0.1 * i)});
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
            sheet.triangles.push_back({a, b, b + 1});
            sheet.triangles.push_back({a, b + 1, a + 1});
        }
    }
    std::string sentence;
    EXPECT_EQ(refusal(sheet, 1e-7, &sentence), "open_boundary");
    EXPECT_NE(sentence.find("flat sheet"), std::string::npos) << sentence;
}

TEST(Refusal, OfAnOpeningWithoutArea) {
    // A slit along the tube, a hundred-thousandth of its length wide.
    TriangleSoup soup = round_tube(24, 31, 2, 16);
    for (std::uint32_t ring = 10; ring < 18; ++ring) {
        const std::uint32_t old = ring * 24, twin = static_cast<std::uint32_t>(soup.points.size());
        soup.points.push_back(soup.points[old] + Vec3{0, 1e-5, 0});
        for (auto& t : soup.triangles)
            for (auto& v : t)
                if (v == old && soup.points[t[0]].y + soup.points[t[1]].y + soup.points[t[2]].y > 1e-3) v = twin;
    }
    EXPECT_EQ(condition(soup).count("hole_filled"), 1U);
    ConditionOptions options;
    options.fill_holes = false;
    EXPECT_EQ(refusal(soup, options), "open_boundary");
}

TEST(Refusal, OfAMoebiusBand) {
    constexpr std::uint32_t n = 60, w = 24;
    TriangleSoup soup;
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j <= w; ++j) {
            const double a = 2 * pi * i / n, s = 2.0 * j / w - 1;
            const double r = 5 + s * std::cos(a / 2);
            soup.points.push_back({r * std::cos(a), r * std::sin(a), s * std::sin(a / 2)});
        }
    }
    const auto id = [](std::uint32_t i, std::uint32_t j) { return i < n ? i * (w + 1) + j : w - j; };
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < w; ++j) {
            soup.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
            soup.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
        }
    }
    std::string sentence;
    EXPECT_EQ(refusal(soup, 1e-7, &sentence), "non_manifold");
    EXPECT_NE(sentence.find("Moebius"), std::string::npos) << sentence;
}

TEST(Refusal, OfNestedComponents) {
    EXPECT_EQ(refusal(merged(cube(4, {0, 0, 0}, 3), cube(2, {0, 0, 0}, 1))), "nested_components");
    EXPECT_EQ(refusal(merged(cube(2, {0, 0, 0}, 1), cube(4, {0, 0, 0}, 3))), "nested_components");
    // Inside the bounding box is not inside: a speck in the hollow of a bent tube.
    std::vector<Vec3> arc;
    for (int k = 0; k <= 60; ++k) arc.push_back({5 * std::cos(pi * k / 60), 0, 5 * std::sin(pi * k / 60)});
    EXPECT_EQ(refusal(merged(swept_tube(16, arc), cube(2, {0, 0, 2}, 0.3))), "");
    EXPECT_EQ(refusal(merged(swept_tube(16, arc), cube(2, {0, 0, 5}, 0.3))), "nested_components");
}

TEST(Refusal, OfAClosedSurfaceWithoutVolume) {
    // Two coats of one disc, with different centres so that they are no duplicates.
    TriangleSoup soup;
    constexpr std::uint32_t n = 12;
    for (std::uint32_t i = 0; i < n; ++i)
        soup.points.push_back({std::cos(2 * pi * i / n), std::sin(2 * pi * i / n), 0});
    soup.points.push_back({0.1, 0, 0});
    soup.points.push_back({-0.1, 0, 0});
    for (std::uint32_t i = 0; i < n; ++i) {
        soup.triangles.push_back({i, (i + 1) % n, n});
        soup.triangles.push_back({(i + 1) % n, i, n + 1});
    }
    EXPECT_EQ(refusal(soup), "no_volume");
}

Surface surface_of(const TriangleSoup& soup) {
    Surface surface;
    surface.points = soup.points;
    for (const auto& t : soup.triangles) surface.triangles.push_back({SiteId(t[0]), SiteId(t[1]), SiteId(t[2])});
    return surface;
}

std::string verdict(Surface surface) {
    try {
        verify_closed(surface);
    } catch (const StageError& e) {
        return std::string(error_name(e.code()));
    }
    return "";
}

TEST(VerifyClosed, FindsEveryDefect) {
    const TriangleSoup sound = cube(3, {0, 0, 0});
    EXPECT_EQ(verdict(surface_of(sound)), "");
    TriangleSoup open = sound;
    open.triangles.pop_back();
    EXPECT_EQ(verdict(surface_of(open)), "not_closed");
    TriangleSoup repeated = sound;
    repeated.triangles.push_back(sound.triangles[0]);
    EXPECT_EQ(verdict(surface_of(repeated)), "non_manifold");
    TriangleSoup turned = sound;
    std::swap(turned.triangles[4][0], turned.triangles[4][1]);
    EXPECT_EQ(verdict(surface_of(turned)), "non_manifold");
    TriangleSoup touching = merged(sound, cube(3, {10, 0, 0}));
    for (auto& t : touching.triangles)
        for (auto& v : t)
            if (v == sound.points.size()) v = 0;
    EXPECT_EQ(verdict(surface_of(touching)), "non_manifold");
    TriangleSoup infinite = sound;
    infinite.points[0].z = std::numeric_limits<double>::infinity();
    EXPECT_EQ(verdict(surface_of(infinite)), "bad_coordinate");
}

TEST(HalfEdges, OfOneTriangleAreAllBoundary) {
    const HalfEdgePairs pairs = pair_half_edges({{0, 1, 2}}, 3);
    EXPECT_EQ(pairs.boundary_edges, 3U);
    EXPECT_EQ(pairs.first_irregular, kNoHalfEdge);
}

TEST(HalfEdges, TellConflictsFromNonManifoldEdges) {
    const HalfEdgePairs conflict = pair_half_edges({{0, 1, 2}, {0, 1, 3}}, 4);
    EXPECT_EQ(conflict.conflicting_edges, 1U);
    EXPECT_EQ(conflict.non_manifold_edges, 0U);
    const HalfEdgePairs fin = pair_half_edges({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, 5);
    EXPECT_EQ(fin.conflicting_edges, 0U);
    EXPECT_EQ(fin.non_manifold_edges, 1U);
    EXPECT_EQ(fin.boundary_edges, 6U);
}

TEST(HalfEdges, FindABowTie) {
    const std::vector<Corners> bow_tie{{0, 1, 2}, {0, 3, 4}};
    EXPECT_EQ(find_split_vertex(bow_tie, pair_half_edges(bow_tie, 5), 5), 0U);
    const std::vector<Corners> strip{{0, 1, 2}, {0, 2, 3}};
    EXPECT_EQ(find_split_vertex(strip, pair_half_edges(strip, 4), 4), kDropped);
}

TEST(Crossings, FollowFromPenetrationTouchAndFold) {
    const auto pairs = [](const std::vector<Vec3>& points, const std::vector<Corners>& triangles) {
        return crossing_triangles(points, triangles, 100).size();
    };
    const std::vector<Corners> apart{{0, 1, 2}, {3, 4, 5}};
    EXPECT_EQ(pairs({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {2, 1, 1}}, apart), 1U);
    EXPECT_EQ(pairs({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0}, {1, 1, 1}, {2, 1, 1}}, apart), 1U);
    EXPECT_EQ(pairs({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0.1}, {1, 1, 1}, {2, 1, 1}}, apart), 0U);
    const std::vector<Corners> on_a_vertex{{0, 1, 2}, {0, 3, 4}};
    EXPECT_EQ(pairs({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}}, on_a_vertex), 1U);
    EXPECT_EQ(pairs({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {-1, -1, -1}, {-1, -1, 1}}, on_a_vertex), 0U);
    const std::vector<Corners> on_an_edge{{0, 1, 2}, {1, 0, 3}};
    EXPECT_EQ(pairs({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {2, 1, 0}}, on_an_edge), 1U);
    EXPECT_EQ(pairs({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {2, -1, 0}}, on_an_edge), 0U);
    EXPECT_EQ(pairs({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {2, 1, 0.01}}, on_an_edge), 0U);
    EXPECT_EQ(crossing_triangles({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {2, 1, 0}}, on_an_edge, 1).size(), 1U);
}

TEST(InsideClosedMesh, TellsInsideFromOutside) {
    const TriangleSoup soup = cube(2, {0, 0, 0});
    const std::vector<Vec3> queries{{0, 0, 0}, {2, 0, 0}, {0.9, 0.9, 0.9}, {1.1, 0.9, 0.9}};
    EXPECT_EQ(inside_closed_mesh(soup.points, soup.triangles, queries), (std::vector<char>{1, 0, 1, 0}));
}

}  // namespace
}  // namespace lumenline::testing
