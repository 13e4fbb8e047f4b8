// Findings that sound models hardly make: each is provoked by a model made for it, or by one stage that is given what
// does not belong together, as the complex of one surface and the wall of another.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/stage_context.h"
#include "engine/trace/trace.h"
#include "tests/stages/implicit_shape.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

/// A tube from its one end to the other, and what is needed to trace it.
struct Tube {
    Phantom phantom;
    Surface surface;
    test::Traced traced;
    Vec3 start, end;
};

Tube tube_of(Refinement refine) {
    Tube t;
    PhantomOptions options = test::capped_options(PhantomKind::kCylinder, 0.2, 16, 20);
    options.b = 0.6 * options.a;  // flat: its lines lie on sheets of the complex, where they can move
    t.phantom = make_phantom(options);
    t.surface = test::closed_surface(t.phantom);
    t.start = t.phantom.truth.position(0);
    t.end = t.phantom.truth.position(t.phantom.truth.total_length());
    t.traced = test::trace_closed(t.surface, {t.start}, {t.end}, {refine});
    return t;
}

/// What the trace says of a tube whose complex, ends or wall were changed.
Diagnostics trace_again(const Tube& t, Refinement refine) {
    StageContext context(Stage::kTrace);
    try {
        trace_centerlines(t.surface, t.traced.complex, t.traced.endpoints, t.traced.fields, {refine}, context);
    } catch (const StageError& error) {
        EXPECT_EQ(error.code(), ErrorCode::kNoLineTraced);
    }
    return context.diagnostics();
}

/// Adds a tetrahedron to the wall, as an obstacle in the lumen.
void add_obstacle(Surface& surface, Vec3 centre, double size) {
    const std::size_t first = surface.points.size();
    for (const Vec3 d : {Vec3{1, 1, 1}, Vec3{1, -1, -1}, Vec3{-1, 1, -1}, Vec3{-1, -1, 1}})
        surface.points.push_back(centre + size * d);
    surface.normals.resize(surface.points.size(), {0, 0, 1});
    surface.input_vertex.resize(surface.points.size(), SiteId::kNoneValue);
    surface.origin.resize(surface.points.size(), SiteOrigin::kCap);  // without a cell in the complex
    for (const auto& [a, b, c] : {std::array<std::size_t, 3>{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
        surface.triangles.push_back({SiteId(first + a), SiteId(first + b), SiteId(first + c)});
        surface.cap.emplace_back();
    }
}

/// Where one line is farthest from another, and how far.
std::pair<Vec3, double> farthest_from(std::span<const Vec3> line, std::span<const Vec3> other) {
    std::pair<Vec3, double> farthest{line.front(), 0};
    for (const Vec3& x : line) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 1; i < other.size(); ++i) {
            const Vec3 a = other[i - 1], d = other[i] - a;
            const double t = squared_norm(d) > 0 ? std::clamp(dot(x - a, d) / squared_norm(d), 0.0, 1.0) : 0.0;
            least = std::min(least, distance(x, a + t * d));
        }
        if (least > farthest.second) farthest = {x, least};
    }
    return farthest;
}

TEST(Findings, LineOutsideOfTheWallIsLeftOut) {
    Tube t = tube_of(Refinement::kPath);
    const Vec3 aside = t.surface.diagonal * any_perpendicular(normalized(t.end - t.start));
    for (Vec3& p : t.surface.points) p += aside;
    EXPECT_TRUE(test::has_finding(trace_again(t, Refinement::kPath), "line_leaves_lumen"));
}

TEST(Findings, BallsLargerThanTheWallAllowsAreDoubtful) {
    Tube t = tube_of(Refinement::kPath);
    EXPECT_FALSE(test::has_finding(trace_again(t, Refinement::kPath), "ball_clearance"));
    for (double& r : t.traced.complex.ball_radius) r *= 1.5;
    EXPECT_TRUE(test::has_finding(trace_again(t, Refinement::kPath), "ball_clearance"));
}

TEST(Findings, LineWithoutAPartBetweenItsPlanesVanishes) {
    Tube t = tube_of(Refinement::kPath);
    Endpoint& inlet = t.traced.endpoints[0];
    inlet.opening = OpeningId(0);
    inlet.normal = normalized(t.start - t.end);
    inlet.point = t.end - t.surface.diagonal * inlet.normal;  // beyond the outlet
    EXPECT_TRUE(test::has_finding(trace_again(t, Refinement::kPath), "line_vanished"));
}

TEST(Findings, ObstacleOfTheRelaxedLineAloneKeepsTheTracedOne) {
    Tube t = tube_of(Refinement::kNone);
    const Tube relaxed = tube_of(Refinement::kPath);
    const auto [place, away] = farthest_from(relaxed.traced.lines.points, t.traced.lines.points);
    add_obstacle(t.surface, place, 0.2 * away);
    EXPECT_TRUE(test::has_finding(trace_again(t, Refinement::kPath), "line_not_relaxed"));
    EXPECT_FALSE(test::has_finding(trace_again(t, Refinement::kNone), "line_leaves_lumen"));
}

TEST(Findings, ObstacleOfTheRefinedLineAloneKeepsThePath) {
    Tube t = tube_of(Refinement::kPath);
    const Tube refined = tube_of(Refinement::kMedial);
    EXPECT_FALSE(test::has_finding(refined.traced.findings, "line_not_refined"));
    const auto [place, away] = farthest_from(refined.traced.lines.points, t.traced.lines.points);
    add_obstacle(t.surface, place, 0.2 * away);
    EXPECT_TRUE(test::has_finding(trace_again(t, Refinement::kMedial), "line_not_refined"));
}

PipelineOptions as_it_is() {
    PipelineOptions options;
    options.condition.refine_undersampled = false;
    return options;
}

TEST(Findings, SixPointsAroundATubeAreTooFew) {
    PhantomOptions options = test::capped_options(PhantomKind::kCylinder, 0.1, 6, 40);
    options.caps = false;
    const ModelRecord coarse = test::run_pipeline(to_soup(make_phantom(options)), as_it_is());
    EXPECT_TRUE(test::has_finding(coarse.diagnostics, "undersampled"));
    EXPECT_EQ(coarse.status, ModelStatus::kWarning);
    options.points_around = 20;
    EXPECT_FALSE(
        test::has_finding(test::run_pipeline(to_soup(make_phantom(options)), as_it_is()).diagnostics, "undersampled"));
}

TEST(Findings, OnlyEndOfItsPartIsLeftOut) {
    const auto tube_and_bottle = [](Vec3 x) {
        return std::min(test::straight_tube(x, {-20, 0, 0}, {20, 0, 0}, 1),
                        test::straight_tube(x, {0, 5, 0}, {20, 5, 0}, 1));
    };
    const ModelRecord record =
        test::run_pipeline(test::polygonized(tube_and_bottle, {-7, -1.7, -1.7}, {7, 6.7, 1.7}, 0.37), as_it_is());
    ASSERT_TRUE(record.centerlines) << record.failure->sentence;
    EXPECT_EQ(record.surface->component_count, 2);
    EXPECT_EQ(record.centerlines->line_count(), 1U);
    EXPECT_TRUE(test::has_finding(record.diagnostics, "endpoint_unconnected"));
}

}  // namespace
}  // namespace lumenline
