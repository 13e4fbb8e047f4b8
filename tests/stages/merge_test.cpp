// Structured tubes have hundreds of cells around each centre. Rotated or rounded, these centres
// scatter, and only merging keeps the axis in one piece and the line in few points. Along the axis
// the scatter is real: the sites of one ring are on a common circle, and rounding puts the centres
// of its flat cells anywhere between the neighbouring rings. Lines are therefore compared across.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/stages/complex_checks.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

using std::numbers::pi;

struct Rotation {
    Vec3 axis;
    double angle;
};
const std::vector<Rotation> kRotations{
    {{0, 0, 1}, 0.3}, {{1, 0, 0}, pi / 2}, {{1, 1, 1}, 2 * pi / 3}, {{0.2, -1, 0.7}, 1.234}, {{3, 1, -2}, 2.5}};

PhantomOptions structured_cylinder() {
    PhantomOptions options;
    options.length = 40;
    options.points_around = 32;
    options.caps = true;
    return options;
}

/// A line between two given points on the axis.
struct AxisLine {
    double off_axis = 0;  ///< largest distance of a point from the axis
    double least_radius = 0, largest_radius = 0;
    double first = 0, last = 0;  ///< along the axis
    std::size_t points = 0, components = 0;
    double rounding = 0;
};

AxisLine line_of(const PhantomOptions& options) {
    const Phantom phantom = make_phantom(options);
    const PhantomTruth& truth = phantom.truth;
    const Surface surface = test::closed_surface(phantom);
    TraceOptions on_the_complex;
    on_the_complex.refine = Refinement::kPath;
    const test::Traced traced = test::trace_closed(surface, {truth.position(0.2031 * truth.total_length())},
                                                   {truth.position(0.8117 * truth.total_length())}, on_the_complex);
    const Centerlines& lines = traced.lines;
    const AxisFrame frame = truth.frame(0);
    AxisLine line;
    for (const Vec3& p : lines.points)
        line.off_axis = std::max(line.off_axis, norm(cross(p - frame.origin, frame.tangent)));
    const auto [least, largest] = std::minmax_element(lines.ball_radius.begin(), lines.ball_radius.end());
    line.least_radius = *least;
    line.largest_radius = *largest;
    line.first = dot(lines.points.front() - frame.origin, frame.tangent);
    line.last = dot(lines.points.back() - frame.origin, frame.tangent);
    line.points = lines.points.size();
    line.components = test::count_components(traced.complex);
    line.rounding = surface.coordinate_rounding;
    return line;
}

constexpr double kSize = 40, kRadius = 5;
constexpr double kRowSpacing = 0.86;  // of rings of 32

/// Balls touch a ring or, the largest, two neighbouring rings at once.
const double kLargestBall = std::hypot(kRadius, 0.5 * kRowSpacing);

void expect_axis(const AxisLine& line, double allowed) {
    EXPECT_EQ(line.components, 1U);
    EXPECT_LT(line.off_axis, allowed);
    EXPECT_GT(line.least_radius, kRadius - allowed);
    EXPECT_LT(line.largest_radius, kLargestBall + allowed);
    // It ends at the vertices nearest to the given points.
    EXPECT_NEAR(line.first, 0.2031 * kSize, kRowSpacing);
    EXPECT_NEAR(line.last, 0.8117 * kSize, kRowSpacing);
    EXPECT_LT(static_cast<double>(line.points), 40 * (line.last - line.first) / kRadius);
}

TEST(MergedVertices, StructuredCylinderGivesTheAxisInEveryPlacement) {
    expect_axis(line_of(structured_cylinder()), 1e-9 * kSize);
    for (const Rotation& rotation : kRotations)
        for (const Vec3 offset : {Vec3{}, Vec3{70, -30, 110}}) {
            PhantomOptions options = structured_cylinder();
            options.rotation_axis = rotation.axis;
            options.rotation_angle = rotation.angle;
            options.offset = offset;
            expect_axis(line_of(options), 1e-9 * kSize);
        }
}

TEST(MergedVertices, StructuredCylinderOfFloat32KeepsItsAxisInFewPoints) {
    for (const Rotation& rotation : kRotations)
        for (const Vec3 offset : {Vec3{}, Vec3{70, -30, 110}}) {
            PhantomOptions options = structured_cylinder();
            options.rotation_axis = rotation.axis;
            options.rotation_angle = rotation.angle;
            options.offset = offset;
            options.float32 = true;
            const AxisLine line = line_of(options);
            expect_axis(line, 128 * line.rounding);  // centres closer than 64 roundings are one
        }
}

TEST(MergedVertices, WithoutMergingTheLineOfARoundedTubeIsCrowded) {
    // Shows that the case needs merging: it would pass without, otherwise.
    PhantomOptions options = structured_cylinder();
    options.rotate = true;
    Surface surface = test::closed_surface(make_phantom(options));
    const std::size_t merged = test::complex_of(surface).vertex_count();
    surface.coordinate_rounding = 0;
    const std::size_t apart = test::complex_of(surface, 0).vertex_count();
    EXPECT_GT(apart, 2 * merged);
}

TEST(MergedVertices, JitteredPhantomHasNothingToMerge) {
    PhantomOptions options = structured_cylinder();
    options.jitter = 0.2;
    const Surface surface = test::closed_surface(make_phantom(options));
    // Cells of the flat caps may share centres; of the wall's none do.
    EXPECT_NEAR(static_cast<double>(test::complex_of(surface).vertex_count()),
                static_cast<double>(test::complex_of(surface, 0).vertex_count()), 0.01 * 1000);
}

}  // namespace
}  // namespace lumenline
