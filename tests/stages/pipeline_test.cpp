// Whole models from an open surface to its line: the axis is known. Accuracy is stated as the mean
// distance of the line to the axis in percent of the tube's radius, arc-length weighted, 1.2 radii at
// either end left out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "engine/phantom/accuracy.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

constexpr double kExclusion = 1.2;  // radii

PhantomOptions options_of(PhantomKind kind, double jitter) {
    PhantomOptions options;
    options.kind = kind;
    options.points_around = 40;
    options.jitter = jitter;
    options.rotate = true;
    if (kind == PhantomKind::kHairpin) {
        options.bend_radius = 8;
        options.leg_length = 30;
    }
    return options;
}

const std::vector<PhantomKind> kBentKinds{PhantomKind::kTorus, PhantomKind::kHelix, PhantomKind::kHairpin};

struct Processed {
    Phantom phantom;
    ModelRecord record;

    [[nodiscard]] const Centerlines& lines() const { return *record.centerlines; }
    [[nodiscard]] LineError error() const {
        const double a = phantom.truth.max_section_radius();
        return line_error(phantom.truth, lines().points, lines().radius, kExclusion * a, a,
                          phantom.truth.min_section_radius());
    }
};

Processed run(const PhantomOptions& options) {
    Processed result{make_phantom(options), {}};
    result.record = test::run_pipeline(to_soup(result.phantom), test::from_start_to_end(result.phantom.truth));
    return result;
}

/// What holds for every line, whatever its accuracy.
void expect_sound(const Processed& run) {
    ASSERT_FALSE(run.record.failure.has_value()) << run.record.failure->sentence;
    ASSERT_EQ(run.lines().line_count(), 1U);
    const Centerlines& lines = run.lines();
    const PhantomTruth& truth = run.phantom.truth;
    EXPECT_FALSE(test::has_finding(run.record.diagnostics, "ball_clearance"));
    EXPECT_EQ(lines.abscissa.front(), 0);
    double last = -1e-3 * truth.min_section_radius();
    for (std::size_t i = 0; i < lines.points.size(); ++i) {
        EXPECT_GT(lines.clearance[i], 0);
        EXPECT_LE(lines.clearance[i], lines.ball_radius[i] * (1 + 1e-12));
        EXPECT_TRUE(i == 0 || lines.abscissa[i] > lines.abscissa[i - 1]);
        EXPECT_TRUE(truth.signed_distance(lines.points[i]) > 0);
        const double s = truth.abscissa_of(lines.points[i]);
        // Neighbours on one rung may be level along the axis, by far less than a thousandth of the radius.
        EXPECT_GT(s, last - 1e-3 * truth.min_section_radius());
        last = s;
    }
    // From plane to plane.
    EXPECT_NEAR(lines.abscissa.back(), truth.total_length(), 0.01 * truth.total_length());
    EXPECT_LT(distance(lines.points.front(), truth.position(0)), 0.05 * truth.max_section_radius());
    EXPECT_LT(distance(lines.points.back(), truth.position(truth.total_length())), 0.05 * truth.max_section_radius());
}

TEST(Pipeline, StructuredBentTubesGiveTheirAxis) {
    for (const PhantomKind kind : kBentKinds) {
        SCOPED_TRACE(phantom_name(kind));
        const Processed result = run(options_of(kind, 0));
        expect_sound(result);
        const LineError error = result.error();
        std::cout << phantom_name(kind) << ", structured: position " << error.position_mean << " %, radius "
                  << error.radius_mean << " %\n";
        EXPECT_LT(error.position_mean, 0.05);
    }
}

TEST(Pipeline, JitteredBentTubesGiveTheirAxis) {
    for (const PhantomKind kind : kBentKinds) {
        SCOPED_TRACE(phantom_name(kind));
        const Processed result = run(options_of(kind, 0.2));
        expect_sound(result);
        const LineError error = result.error();
        std::cout << phantom_name(kind) << ", 20 % jitter: position " << error.position_mean << " %, radius "
                  << error.radius_mean << " %\n";
        EXPECT_LT(error.position_mean, 0.1);
    }
}

TEST(Pipeline, ObliqueEndsOfATubeDoNotMoveItsAxis) {
    PhantomOptions options;
    options.jitter = 0.2;
    for (const double slope : {0.2, 0.4, 0.6, 0.9, 1.5}) {
        TriangleSoup soup = to_soup(make_phantom(options));
        for (Vec3& p : soup.points) p.z += slope * p.x;
        const ModelRecord record = test::run_pipeline(soup);
        ASSERT_TRUE(record.centerlines) << slope;
        const Centerlines& lines = *record.centerlines;
        // What the curved surface leaves of a tube of 40 points around.
        const double tolerance = 2e-3 * options.a;
        for (std::size_t i = 0; i < lines.points.size(); ++i) {
            EXPECT_LT(std::hypot(lines.points[i].x, lines.points[i].y), tolerance) << slope << " at " << i;
            EXPECT_NEAR(lines.radius[i], options.a, tolerance) << slope << " at " << i;
        }
        // The centres of the uneven openings are that far from the axis, and their planes are oblique.
        EXPECT_NEAR(lines.abscissa.back(), options.length, 1e-2 * options.a);
    }
}

TEST(Pipeline, HairpinOfANarrowGapIsFollowedAround) {
    for (const double jitter : {0.0, 0.2})
        for (const double bend_radius : {5.3, 6.0}) {
            PhantomOptions options = options_of(PhantomKind::kHairpin, jitter);
            options.bend_radius = bend_radius;  // gaps of 0.6 and 2
            SCOPED_TRACE("jitter " + std::to_string(jitter) + ", bend radius " + std::to_string(bend_radius));
            expect_sound(run(options));
        }
}

/// Points of a line in units and axes of the unmoved model.
std::vector<Vec3> unmoved(const Centerlines& lines, double scale, Vec3 offset) {
    std::vector<Vec3> points;
    for (const Vec3& p : lines.points) points.push_back(1 / scale * (p - offset));
    return points;
}

void expect_same_in_every_placement(const PhantomOptions& options) {
    const Processed original = run(options);
    expect_sound(original);
    const double size = original.record.surface->diagonal;
    for (const auto& [scale, shift] :
         {std::pair{1e-3, 0.0}, std::pair{1e3, 0.0}, std::pair{1.0, 1000.0}, std::pair{1e-3, 1000.0}}) {
        SCOPED_TRACE("scale " + std::to_string(scale) + ", moved by " + std::to_string(shift) + " sizes");
        PhantomOptions moved = options;
        moved.scale = scale;
        moved.offset = scale * shift * size * Vec3{0.6, -0.64, 0.48};
        const Processed result = run(moved);
        expect_sound(result);
        const auto points = unmoved(result.lines(), scale, moved.offset);
        EXPECT_LT(test::distance_between_lines(points, original.lines().points), 1e-6 * size);
        EXPECT_NEAR(result.lines().abscissa.back() / scale, original.lines().abscissa.back(), 1e-6 * size);
        EXPECT_EQ(result.record.diagnostics.size(), original.record.diagnostics.size());
        ASSERT_EQ(result.record.endpoints->size(), original.record.endpoints->size());
        for (std::size_t i = 0; i < result.record.endpoints->size(); ++i) {
            const Endpoint &e = (*result.record.endpoints)[i], &f = (*original.record.endpoints)[i];
            EXPECT_NEAR(e.radius / scale, f.radius, 1e-6 * size);
            EXPECT_LT(distance(1 / scale * (e.point - moved.offset), f.point), 1e-6 * size);
        }
    }
}

TEST(Pipeline, ResultDoesNotDependOnUnitOrPlaceOfAJitteredModel) {
    PhantomOptions options = options_of(PhantomKind::kTorus, 0.2);
    options.points_around = 24;
    expect_same_in_every_placement(options);
}

TEST(Pipeline, ResultDoesNotDependOnUnitOrPlaceOfAFlatSection) {
    PhantomOptions options = options_of(PhantomKind::kCylinder, 0.2);
    options.points_around = 24;
    options.b = 2.5;
    expect_same_in_every_placement(options);
}

TEST(Pipeline, StructuredAxisIsTheSameInEveryUnitAndPlace) {
    // Openings of equal area up to rounding: their order, and so their extensions, may be exchanged.
    PhantomOptions options = options_of(PhantomKind::kTorus, 0);
    options.points_around = 24;
    const Processed original = run(options);
    const double size = original.record.surface->diagonal;
    for (const auto& [scale, shift] : {std::pair{1e-3, 0.0}, std::pair{1e3, 0.0}, std::pair{1.0, 1000.0}}) {
        PhantomOptions moved = options;
        moved.scale = scale;
        moved.offset = scale * shift * size * Vec3{0.6, -0.64, 0.48};
        const Processed result = run(moved);
        expect_sound(result);
        EXPECT_NEAR(result.error().position_mean, original.error().position_mean, 2e-3);
        // Rounding chooses the points between two rings where the balls are told; they vary by
        // h^2 / 8 a^2 = 0.65 % along the axis.
        EXPECT_NEAR(result.error().radius_mean, original.error().radius_mean, 0.65);
    }
}

TEST(Pipeline, Float32FileIsTheModelOfItsRoundedCoordinates) {
    for (const double jitter : {0.0, 0.2}) {
        PhantomOptions options = options_of(PhantomKind::kTorus, jitter);
        options.points_around = 24;
        options.offset = {30, -40, 120};
        TriangleSoup rounded = to_soup(make_phantom(options));
        double largest = 0;
        for (Vec3& p : rounded.points)
            for (int axis = 0; axis < 3; ++axis) {
                p[axis] = static_cast<float>(p[axis]);
                largest = std::max(largest, std::fabs(p[axis]));
            }
        rounded.coordinate_rounding = 0x1p-24 * largest;
        options.float32 = true;
        const Processed from_file = run(options);
        expect_sound(from_file);
        const ModelRecord record = test::run_pipeline(rounded, test::from_start_to_end(from_file.phantom.truth));
        ASSERT_FALSE(record.failure.has_value());
        EXPECT_EQ(record.centerlines->points, from_file.lines().points);
        EXPECT_EQ(record.centerlines->radius, from_file.lines().radius);
        EXPECT_EQ(record.centerlines->clearance, from_file.lines().clearance);
        EXPECT_EQ(record.fields[0]->time, from_file.record.fields[0]->time);
        EXPECT_EQ(record.complex->vertices, from_file.record.complex->vertices);

        // And it is the model in double precision but for the rounding, and not crowded by it.
        options.float32 = false;
        const Processed exact = run(options);
        // Jitter decides the medial axis; float32 moves it by the rounding times the flatness of its cells,
        // seen below a thousandth of the radius.
        EXPECT_NEAR(from_file.error().position_mean, exact.error().position_mean, 0.1);
        EXPECT_LT(static_cast<double>(from_file.lines().points.size()), 40 * from_file.lines().abscissa.back() / 5);
    }
}

TEST(Pipeline, SinglePrecisionFarFromTheOriginKeepsTheLine) {
    constexpr double kAway = 1e4;  // sizes
    PhantomOptions options = options_of(PhantomKind::kTorus, 0.2);
    options.points_around = 24;
    const Processed original = run(options);
    const double size = original.record.surface->diagonal;
    for (const double scale : {1e-3, 1.0, 1e3}) {  // metres, millimetres, micrometres
        SCOPED_TRACE("scale " + std::to_string(scale));
        PhantomOptions moved = options;
        moved.float32 = true;
        moved.scale = scale;
        moved.offset = scale * kAway * size * Vec3{0.6, -0.64, 0.48};
        const Processed result = run(moved);
        ASSERT_FALSE(result.record.failure.has_value()) << result.record.failure->sentence;
        ASSERT_EQ(result.lines().line_count(), 1U);
        for (const Diagnostic& d : result.record.diagnostics) EXPECT_NE(d.severity, Severity::kError) << d.message;
        // Coordinates are on a grid of a twentieth of an edge, which is noise of up to half of it in each of them:
        // lines move by no more than a few times that.
        const double spacing = 0x1p-23 * kAway * size;
        EXPECT_LT(test::distance_between_lines(unmoved(result.lines(), scale, moved.offset), original.lines().points),
                  4 * spacing);
        for (std::size_t i = 0; i < 2; ++i)
            EXPECT_NEAR((*result.record.endpoints)[i].radius / scale, (*original.record.endpoints)[i].radius, spacing);
    }
}

TEST(Pipeline, SecondRunIsEqualToTheLastBit) {
    const PhantomOptions options = options_of(PhantomKind::kHelix, 0.2);
    const Processed first = run(options), second = run(options);
    EXPECT_EQ(first.lines().points, second.lines().points);
    EXPECT_EQ(first.lines().radius, second.lines().radius);
    EXPECT_EQ(first.lines().clearance, second.lines().clearance);
    EXPECT_EQ(first.record.fields[0]->time, second.record.fields[0]->time);
}

TEST(Pipeline, FailureNamesItsStageAndLeavesTheLaterPartsOut) {
    PhantomOptions options = options_of(PhantomKind::kTorus, 0.2);
    options.points_around = 16;
    const TriangleSoup open = to_soup(make_phantom(options));
    PipelineOptions far;
    far.endpoints.mode = EndpointMode::kPoints;
    far.endpoints.inlets = {{1e6, 0, 0}};
    far.endpoints.outlets = {{0, 0, 0}};
    const ModelRecord record = test::run_pipeline(open, far);
    EXPECT_EQ(record.status, ModelStatus::kFailed);
    ASSERT_TRUE(record.failure.has_value());
    EXPECT_EQ(record.failure->code, ErrorCode::kEndpointOutside);
    EXPECT_EQ(record.failure->stage, Stage::kEndpoints);
    EXPECT_NE(record.complex, nullptr);
    EXPECT_EQ(record.centerlines, nullptr);
    EXPECT_TRUE(record.fields.empty());

    const ModelRecord empty = test::run_pipeline(TriangleSoup{});
    ASSERT_TRUE(empty.failure.has_value());
    EXPECT_EQ(empty.failure->code, ErrorCode::kNoSurface);
    EXPECT_EQ(empty.surface, nullptr);
}

}  // namespace
}  // namespace lumenline
