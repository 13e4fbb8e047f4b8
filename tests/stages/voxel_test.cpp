// Whole models of surfaces as segmentations give them.
#include <gtest/gtest.h>

#include <cstdio>

#include "engine/phantom/accuracy.h"
#include "engine/phantom/voxels.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

/// Errors of the line between points half a radius inside the closed ends, without 1.5 radii there.
LineError error_of(const PhantomOptions& options, const VoxelOptions& voxels) {
    const Phantom phantom = make_voxel_phantom(options, voxels);
    const PhantomTruth& truth = phantom.truth;
    const double a = truth.max_section_radius(), b = truth.min_section_radius();
    PipelineOptions pipeline;
    pipeline.endpoints.inlets = {truth.position(0.5 * b)};
    pipeline.endpoints.outlets = {truth.position(truth.total_length() - 0.5 * b)};
    const ModelRecord record = test::run_pipeline(to_soup(phantom), pipeline);
    EXPECT_FALSE(record.failure.has_value()) << record.failure->sentence;
    if (record.failure) return {};
    EXPECT_EQ(record.centerlines->line_count(), 1U);
    const LineError error = line_error(truth, record.centerlines->points, record.centerlines->radius, 1.5 * a, a, b);
    std::printf("%s, b/a %.1f, voxel %.2f, %d passes, %zu vertices: position %.2f(%.2f) %%, radius %.2f(%.2f) %%\n",
                phantom_name(options.kind).data(), b / a, voxels.size, voxels.smoothing, phantom.points.size(),
                error.position_mean, error.position_sigma, error.radius_mean, error.radius_sigma);
    return error;
}

PhantomOptions shape(PhantomKind kind, double b) {
    PhantomOptions options;
    options.kind = kind;
    options.b = b;
    options.rotate = true;
    return options;
}

// A voxel is 20 % of the radius. Balls in the staircase are held by its innermost corners, which are up to
// sqrt(3)/2 voxels within the wall: radii are too small by nearly that, 17 %. The place where they are held
// changes from side to side: half a voxel at most.
TEST(VoxelSurfaces, StaircaseGivesTheAxisWithinItsSteps) {
    for (const PhantomKind kind : {PhantomKind::kCylinder, PhantomKind::kTorus}) {
        const LineError error = error_of(shape(kind, 5), {0.2, 0});
        EXPECT_LT(error.position_mean, 10);
        EXPECT_LT(error.radius_mean, 17.3);
    }
}

// Smoothing takes steps down to a tenth of a voxel and less in the mean; the innermost ripples hold the balls.
TEST(VoxelSurfaces, SmoothedSurfaceGivesTheAxisWithinAQuarterVoxel) {
    for (const PhantomKind kind : {PhantomKind::kCylinder, PhantomKind::kTorus, PhantomKind::kHelix}) {
        const LineError error = error_of(shape(kind, 5), {0.2, 20});
        EXPECT_LT(error.position_mean, 2.5);
        EXPECT_LT(error.radius_mean, 5);
    }
}

// The voxel is 12 % of the greatest radius here.
TEST(VoxelSurfaces, SmoothedFlatSectionGivesTheAxisWithinHalfAVoxel) {
    const LineError error = error_of(shape(PhantomKind::kCylinder, 3), {0.2, 20});
    EXPECT_LT(error.position_mean, 6);
    EXPECT_LT(error.radius_mean, 5);
}

}  // namespace
}  // namespace lumenline
