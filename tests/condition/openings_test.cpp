// Openings of other shapes than a circle, and extensions that run into something.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/condition/cap.h"
#include "engine/condition/collision.h"
#include "engine/condition/planar.h"
#include "tests/condition/shapes.h"

namespace lumenline::testing {
namespace {

using std::numbers::pi;

// Straight tube whose section has the polar radius `radius(angle)` and whose upper end is raised by `rise`.
TriangleSoup shaped_tube(std::size_t around, std::size_t rings, double length,
                         const std::function<Vec2(double)>& section, const std::function<double(Vec2)>& rise) {
    return tube(around, rings, [=](std::size_t i, std::size_t k) {
        const Vec2 q = section(2 * pi * static_cast<double>(i) / static_cast<double>(around));
        const double share = static_cast<double>(k) / static_cast<double>(rings - 1);
        return Vec3{q.x, q.y, share * (length + rise(q))};
    });
}

double level(Vec2) { return 0; }
Vec2 circle(double a) { return {std::cos(a), std::sin(a)}; }

const Opening& upper(const Surface& surface) {
    return *std::max_element(surface.openings.begin(), surface.openings.end(),
                             [](const Opening& a, const Opening& b) { return a.point.z < b.point.z; });
}

void expect_sound(const Conditioned& result) {
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_EQ(crossings(result.surface), 0U);
    EXPECT_EQ(result.count("self_intersections"), 0U);
    for (const Vec3& n : result.surface.normals) EXPECT_NEAR(norm(n), 1, 1e-12);
}

// Sites of the cap that `opening` ends in lie in one plane.
void expect_planar_end(const Surface& surface, const Opening& opening) {
    for (std::size_t s = 0; s < surface.site_count(); ++s)
        if (surface.origin[s] == SiteOrigin::kCap && dot(surface.points[s] - opening.point, opening.normal) > 0) {
            EXPECT_NEAR(dot(surface.points[s] - opening.point, opening.normal), opening.extension_length,
                        1e-12 * surface.diagonal);
        }
}

TEST(Opening, CutObliquelyHasTheCutsPlane) {
    const Conditioned result = condition(shaped_tube(24, 41, 10, circle, [](Vec2 q) { return q.x; }));
    expect_sound(result);
    const Opening& opening = upper(result.surface);
    EXPECT_NEAR(distance(opening.normal, normalized({-1, 0, 1})), 0, 1e-12);
    EXPECT_NEAR(distance(opening.point, {0, 0, 10}), 0, 1e-12);
    EXPECT_NEAR(opening.radius, regular_polygon_radius(24, 1) * std::pow(2, 0.25), 1e-12);
    EXPECT_EQ(result.warnings(), 0U);
}

TEST(Opening, CutObliquelyIsExtendedAlongTheTube) {
    const double inner = std::cos(pi / 24);  // of the polygon's sides, per radius
    for (const double slope : {0.3, 1.0, 2.0}) {
        const Conditioned result = condition(shaped_tube(24, 41, 10, circle, [=](Vec2 q) { return slope * q.x; }));
        expect_sound(result);
        const Opening& opening = upper(result.surface);
        EXPECT_NEAR(distance(opening.axis, {0, 0, 1}), 0, 1e-12);
        EXPECT_NEAR(opening.extension_length, slope + 1.2 * opening.radius, 1e-12);
        for (std::size_t s = 0; s < result.surface.site_count(); ++s) {
            const Vec3 p = result.surface.points[s];
            if (result.surface.origin[s] != SiteOrigin::kExtension) continue;
            EXPECT_GT(std::hypot(p.x, p.y), inner - 1e-12);
            EXPECT_LT(std::hypot(p.x, p.y), 1 + 1e-3);  // as the smooth curve through the corners
        }
    }
}

TEST(Opening, CutAcrossIsExtendedAlongItsNormal) {
    // The last also bends: on the way of a radius by 19 degrees.
    const TriangleSoup straight = shaped_tube(24, 41, 10, circle, level);
    const TriangleSoup bent = tube(24, 41, [](std::size_t i, std::size_t k) {
        const double a = 2 * pi * static_cast<double>(i) / 24, turn = pi / 40 * static_cast<double>(k);
        return Vec3{(3 + std::cos(a)) * std::cos(turn) - 3, std::sin(a), (3 + std::cos(a)) * std::sin(turn)};
    });
    for (const TriangleSoup& soup : {straight, bent})
        for (const Opening& opening : condition(soup).surface.openings) EXPECT_EQ(opening.axis, opening.normal);
}

TEST(Opening, OfAWideFunnelIsExtendedAlongItsNormal) {
    // Of 45 degrees: its normals are across no direction.
    const Conditioned result = condition(tube(24, 21, [](std::size_t i, std::size_t k) {
        const double a = 2 * pi * static_cast<double>(i) / 24, z = 0.1 * static_cast<double>(k);
        return Vec3{(1 + z) * std::cos(a), (1 + z) * std::sin(a), z + (k == 20 ? 0.5 * std::cos(a) : 0)};
    }));
    for (const Opening& opening : result.surface.openings) EXPECT_EQ(opening.axis, opening.normal);
}

TEST(Opening, NotPlanarIsExtendedToAPlane) {
    for (const double height : {0.1, 0.4}) {
        const Conditioned result =
            condition(shaped_tube(24, 41, 10, circle, [=](Vec2 q) { return height * (q.x * q.x - q.y * q.y); }));
        expect_sound(result);
        const Opening& opening = upper(result.surface);
        EXPECT_NEAR(distance(opening.normal, {0, 0, 1}), 0, 1e-12);
        EXPECT_NEAR(opening.point.z, 10, 1e-12);
        EXPECT_NEAR(opening.extension_length, height + 1.2 * opening.radius, 1e-12);
        expect_planar_end(result.surface, opening);
        EXPECT_EQ(result.warnings(), 0U);
    }
}

TEST(Opening, NotPlanarGetsASmoothPlainCap) {
    const Conditioned result =
        condition(shaped_tube(24, 41, 10, circle, [](Vec2 q) { return 0.4 * (q.x * q.x - q.y * q.y); }), 0);
    expect_sound(result);
    EXPECT_EQ(upper(result.surface).extension_length, 0);
    for (std::size_t s = 0; s < result.surface.site_count(); ++s)
        if (result.surface.origin[s] == SiteOrigin::kCap && result.surface.points[s].z > 5) {
            // The boundary data are harmonic of degree two, so is what mean values approximate.
            EXPECT_NEAR(result.surface.points[s].z - 10,
                        0.4 * (std::pow(result.surface.points[s].x, 2) - std::pow(result.surface.points[s].y, 2)), 0.1);
        }
}

TEST(Opening, ElongatedIsMeasuredAndCapped) {
    const auto ellipse = [](double a) { return Vec2{3 * std::cos(a), 0.5 * std::sin(a)}; };
    for (const double extension : {1.2, 0.0}) {
        const Conditioned result = condition(shaped_tube(60, 61, 12, ellipse, level), extension);
        expect_sound(result);
        EXPECT_NEAR(upper(result.surface).radius, regular_polygon_radius(60, std::sqrt(1.5)), 1e-12);
        EXPECT_LE(largest_valence(result.surface, SiteOrigin::kCap), 10U);
    }
}

TEST(Opening, ConcaveIsCappedInsideItself) {
    const auto peanut = [](double a) { return (1 + 0.6 * std::cos(2 * a)) * Vec2{std::cos(a), std::sin(a)}; };
    for (const double extension : {1.2, 0.0}) {
        const Conditioned result = condition(shaped_tube(48, 61, 8, peanut, level), extension);
        expect_sound(result);
        // No cap triangle bridges the waist: the volume is that of the prism, within the resampling of its outline.
        std::vector<Vec2> outline;
        for (int i = 0; i < 48; ++i) outline.push_back(peanut(2 * pi * i / 48));
        double area = 0;
        for (std::size_t i = 0; i < 48; ++i) area += cross(outline[i], outline[(i + 1) % 48]) / 2;
        const double prism = area * (8 + 2 * upper(result.surface).extension_length);
        EXPECT_NEAR(volume(result.surface), prism, extension > 0 ? 0.01 * prism : 1e-12 * prism);
        EXPECT_EQ(result.warnings(), 0U);
    }
}

TEST(Opening, WithAJaggedEdgeIsStillClosed) {
    const Conditioned result = condition(tube(40, 41, [](std::size_t i, std::size_t k) {
        const double a = 2 * pi * (static_cast<double>(i) + (i % 2 == 0 ? 0.35 : -0.35)) / 40;
        const double z = 0.25 * static_cast<double>(k);
        return Vec3{std::cos(a), std::sin(a), z + (k == 40 ? 0.08 * std::sin(2.5 * static_cast<double>(i)) : 0)};
    }));
    expect_sound(result);
    expect_planar_end(result.surface, upper(result.surface));
}

TEST(Opening, OverlappingItselfSeenAlongItsNormalIsCappedInSpace) {
    // Two neighbouring corners of the edge change places at different heights.
    const Conditioned result = condition(tube(24, 41, [](std::size_t i, std::size_t k) {
        double turn = static_cast<double>(i), z = 0.25 * static_cast<double>(k);
        if (k == 40 && i == 5) turn += 1.4, z += 0.2;
        if (k == 40 && i == 6) turn -= 1.4, z += 0.5;
        return Vec3{std::cos(2 * pi * turn / 24), std::sin(2 * pi * turn / 24), z};
    }));
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_EQ(result.count("crooked_opening"), 1U);
    EXPECT_EQ(upper(result.surface).extension_length, 0);
    EXPECT_GT(count_origin(result.surface, SiteOrigin::kCap), 10U);
}

// A tube bent like a question mark, whose end looks at its own straight part from the given distance.
TriangleSoup hook(double gap) {
    std::vector<Vec3> path;
    for (int k = 0; k < 20; ++k) path.push_back({0, 0, 0.4 * k});
    for (int k = 0; k < 24; ++k) path.push_back({3 - 3 * std::cos(pi * k / 24), 0, 8 + 3 * std::sin(pi * k / 24)});
    for (int k = 0; k < 8; ++k) path.push_back({4 + 2 * std::cos(pi * k / 16), 0, 8 - 2 * std::sin(pi * k / 16)});
    for (int k = 0; k <= 4; ++k) path.push_back({4 + (gap - 3) * k / 4, 0, 6});
    return swept_tube(16, path);
}

double hook_extension(const Surface& surface) {
    for (const Opening& o : surface.openings)
        if (o.normal.x < -0.9) return o.extension_length;
    return -1;
}

TEST(Collision, FarFromTheWallChangesNothing) {
    const Conditioned result = condition(hook(2.4));
    expect_sound(result);
    EXPECT_EQ(result.warnings(), 0U);
    EXPECT_NEAR(hook_extension(result.surface), 1.2, 0.05);
}

TEST(Collision, WithTheWallShortensTheExtension) {
    const Conditioned result = condition(hook(1.3));
    expect_sound(result);
    EXPECT_EQ(result.count("extension_shortened"), 1U);
    EXPECT_NEAR(hook_extension(result.surface), 0.6, 0.05);
}

TEST(Collision, CloseToTheWallLeavesAPlainCap) {
    const Conditioned result = condition(hook(0.6));
    expect_sound(result);
    EXPECT_EQ(result.count("extension_blocked"), 1U);
    EXPECT_EQ(hook_extension(result.surface), 0);
}

TriangleSoup facing_tubes(double gap) {
    const TriangleSoup one = round_tube(16, 21, 1, 8);
    return merged(one, mapped(one, [=](Vec3 p) { return Vec3{p.x, p.y, p.z + 8 + gap}; }));
}

TEST(Collision, OfTwoExtensionsShortensTheSecond) {
    const Conditioned result = condition(facing_tubes(2.5));
    expect_sound(result);
    EXPECT_EQ(result.count("extension_shortened"), 1U);
    EXPECT_EQ(result.count("extension_blocked"), 0U);
}

TEST(Collision, OfTwoExtensionsBlocksTheSecond) {
    const Conditioned result = condition(facing_tubes(2.0));
    expect_sound(result);
    EXPECT_EQ(result.count("extension_blocked"), 1U);
}

TEST(Collision, BesideACrookedLoopIsFoundByTheCrossingTest) {
    // A speck that pokes through the extension's side between the lowest and the highest point of the loop.
    const TriangleSoup saddle = shaped_tube(24, 41, 10, circle, [](Vec2 q) { return 0.8 * (q.x * q.x - q.y * q.y); });
    const TriangleSoup speck = tetrahedron({0, 0.9, 9.7}, {0.05, 1.2, 9.7}, {-0.05, 1.2, 9.7}, {0, 1.1, 9.8});
    ConditionOptions options;
    options.speck_share = 0;
    options.refine_undersampled = false;
    const Conditioned result = condition(merged(saddle, speck), options);
    EXPECT_EQ(result.count("extension_blocked"), 1U);
    EXPECT_EQ(upper(result.surface).extension_length, 0);
    EXPECT_TRUE(is_closed_manifold(result.surface));
    EXPECT_EQ(condition(saddle).count("extension_blocked"), 0U);
}

TEST(SelfIntersection, OfTheWallIsReportedWithItsPlace) {
    const TriangleSoup one = round_tube(16, 41, 1, 16);
    const Conditioned result = condition(merged(one, mapped(one, [](Vec3 p) {
                                                    return Vec3{p.z - 8, p.y + 0.3, 8 - p.x};
                                                })));
    EXPECT_EQ(result.count("self_intersections"), 1U);
    EXPECT_EQ(result.value("self_intersections"), static_cast<double>(crossings(result.surface)));
    EXPECT_GT(crossings(result.surface), 10U);
}

TEST(Cap, OfASquareHasItsAreaAndNoSteinerPointOnASide) {
    const std::vector<Vec2> square{{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
    const auto cap = cap_polygon(square, 0.5, 0);
    ASSERT_TRUE(cap.has_value());
    std::vector<Vec2> points = square;
    points.insert(points.end(), cap->interior.begin(), cap->interior.end());
    double area = 0;
    for (const Corners& t : cap->triangles) {
        const double part = cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]) / 2;
        EXPECT_GT(part, 0);
        area += part;
    }
    EXPECT_NEAR(area, 16, 1e-12);
    for (const Vec2& q : cap->interior) EXPECT_LT(std::max(std::fabs(q.x), std::fabs(q.y)), 2 - 0.3);
    EXPECT_EQ(cap->triangles.size(), 2 + 2 * cap->interior.size());
}

TEST(Cap, RefusesWhatIsNoSimplePolygon) {
    EXPECT_FALSE(cap_polygon({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, 0.5, 0).has_value());          // crosses itself
    EXPECT_FALSE(cap_polygon({{0, 0}, {0, 1}, {1, 1}, {1, 0}}, 0.5, 0).has_value());          // clockwise
    EXPECT_FALSE(cap_polygon({{0, 0}, {1, 0}, {1, 1}, {1, 0}, {0, 1}}, 0.5, 0).has_value());  // repeats a corner
    EXPECT_FALSE(cap_polygon({{0, 0}, {1, 0}}, 0.5, 0).has_value());
}

TEST(MeanValues, ReproduceLinearData) {
    const std::vector<Vec2> concave{{0, 0}, {4, 0}, {4, 3}, {2, 1}, {0, 3}};
    std::vector<double> values;
    for (const Vec2& p : concave) values.push_back(2 * p.x - p.y + 3);
    EXPECT_NEAR(interpolate_inside(concave, values, {1, 0.7}), 2 - 0.7 + 3, 1e-12);
    EXPECT_NEAR(interpolate_inside(concave, values, {3.5, 2}), 7 - 2 + 3, 1e-12);
}

TEST(ClosedCurve, ThroughARegularPolygonStaysOnTheCircle) {
    std::vector<Vec2> corners;
    for (int i = 0; i < 16; ++i) corners.push_back({std::cos(2 * pi * i / 16), std::sin(2 * pi * i / 16)});
    const ClosedCurve smooth(corners, std::vector<double>(16, 1.0), true),
        straight(corners, std::vector<double>(16, 1.0), false);
    for (int i = 0; i < 500; ++i) {
        const double s = smooth.length() * i / 250;  // two turns
        // Cubic through points a sixteenth of a turn apart: error (pi/16)^4 / 6 of the radius.
        EXPECT_NEAR(norm(smooth.at(s).point), 1, 1e-3);
        EXPECT_GE(norm(straight.at(s).point), std::cos(pi / 16) - 1e-12);
        EXPECT_LE(norm(straight.at(s).point), 1 + 1e-12);
        EXPECT_DOUBLE_EQ(smooth.at(s).height, 1);
    }
}

}  // namespace
}  // namespace lumenline::testing
