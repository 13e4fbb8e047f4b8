// Sampled phantoms: closed manifolds near the analytic wall, with and without smoothing.
#include "engine/phantom/voxels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "tests/phantom/shapes.h"

namespace lumenline {
namespace {

using std::numbers::pi;

/// Is every directed edge there once, with its twin; one sphere?
bool is_sphere(const Phantom& p) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
    for (const auto& t : p.triangles)
        for (std::size_t k = 0; k < 3; ++k) ++directed[{t[k], t[(k + 1) % 3]}];
    for (const auto& [edge, count] : directed)
        if (count != 1 || !directed.contains({edge.second, edge.first})) return false;
    return p.points.size() + p.triangles.size() == directed.size() / 2 + 2;
}

double volume_of(const Phantom& p) {
    double volume = 0;
    for (const auto& [a, b, c] : p.triangles) {
        const Vec3 o = p.points[0];
        volume += dot(p.points[a] - o, cross(p.points[b] - o, p.points[c] - o)) / 6;
    }
    return volume;
}

struct WallError {
    double largest = 0, mean = 0;  // in voxels
};

/// Distance of the vertices to the wall, two voxels and more from the ends.
WallError wall_error(const Phantom& p) {
    WallError error;
    double count = 0;
    for (const Vec3& x : p.points) {
        const double s = p.truth.abscissa_of(x);
        if (s < 2 * p.edge_length || s > p.truth.total_length() - 2 * p.edge_length) continue;
        const double away = std::fabs(p.truth.signed_distance(x)) / p.edge_length;
        error.largest = std::max(error.largest, away);
        error.mean += away;
        ++count;
    }
    error.mean /= count;
    return error;
}

std::vector<NamedShape> sampled_shapes() {
    std::vector<NamedShape> shapes;
    for (const auto& shape : test_shapes())
        // The others have necks or gaps that voxels of a quarter of a radius do not tell apart.
        if (shape.name != "sharp stenosis" && shape.name != "hairpin almost touching" && shape.name != "tight helix")
            shapes.push_back(shape);
    return shapes;
}

TEST(VoxelPhantom, StaircaseAndSmoothedSurfaceAreSpheresWithinAVoxelOfTheWall) {
    for (const auto& [name, options] : sampled_shapes()) {
        const Phantom stairs = make_voxel_phantom(options, {0.25, 0}), smooth = make_voxel_phantom(options, {0.25, 20});
        EXPECT_TRUE(is_sphere(stairs)) << name;
        EXPECT_TRUE(is_sphere(smooth)) << name;
        // A vertex lies between centres inside and outside, each sqrt(3)/2 away; filled voxels go a little farther.
        const WallError before = wall_error(stairs), after = wall_error(smooth);
        EXPECT_LT(before.largest, 1) << name;
        EXPECT_GT(before.largest, 0.5) << name << ": a staircase has steps";
        EXPECT_LT(after.largest, 1) << name;
        EXPECT_LT(after.mean, 0.6 * before.mean) << name;
        // Smoothing rounds the ends' rims.
        EXPECT_NEAR(volume_of(smooth), volume_of(stairs), 0.02 * volume_of(stairs)) << name;
    }
}

TEST(VoxelPhantom, VolumeIsThatOfTheShape) {
    PhantomOptions options;
    options.b = 3;
    options.rotate = true;
    const double exact = pi * options.a * options.b * options.length;
    for (const int passes : {0, 20}) {
        // Voxel counts err by the surface's noise alone, far below the 2 % that rounded ends take.
        EXPECT_NEAR(volume_of(make_voxel_phantom(options, {0.2, passes})), exact, 0.02 * exact) << passes;
    }
    options = shape_of(PhantomKind::kTorus);
    const double ring = pi * options.a * options.a * options.bend_radius * options.arc;
    EXPECT_NEAR(volume_of(make_voxel_phantom(options, {0.15, 20})), ring, 0.02 * ring);
}

TEST(VoxelPhantom, FinerVoxelsComeNearer) {
    PhantomOptions options = shape_of(PhantomKind::kTorus);
    options.rotate = true;
    const auto error = [&](double size) {
        const Phantom p = make_voxel_phantom(options, {size, 10});
        return wall_error(p).mean * p.edge_length;
    };
    EXPECT_LT(error(0.1), 0.7 * error(0.2));
}

TEST(VoxelPhantom, PlaceAndScaleComeAfterSampling) {
    PhantomOptions options;
    options.length = 20;
    options.rotate = true;
    const Phantom here = make_voxel_phantom(options, {0.25, 5});
    options.scale = 1000;
    options.offset = {1, 2, 3};
    const Phantom there = make_voxel_phantom(options, {0.25, 5});
    EXPECT_EQ(there.triangles, here.triangles);
    for (std::size_t i = 0; i < here.points.size(); ++i)
        EXPECT_EQ(there.points[i], options.offset + options.scale * here.points[i]);
    EXPECT_EQ(there.edge_length, 1000 * here.edge_length);
}

TEST(VoxelPhantom, ChecksSeeAHole) {
    PhantomOptions options;
    options.length = 20;
    Phantom p = make_voxel_phantom(options, {0.25, 0});
    p.triangles.pop_back();
    EXPECT_FALSE(is_sphere(p));
}

TEST(VoxelPhantom, WhatVoxelsCannotShowIsRefused) {
    const auto refused = [](PhantomOptions options, VoxelOptions voxels) {
        EXPECT_THROW(make_voxel_phantom(options, voxels), std::invalid_argument);
    };
    PhantomOptions hairpin = shape_of(PhantomKind::kHairpin);
    hairpin.bend_radius = 5.05;  // legs 0.1 apart
    refused(hairpin, {0.3, 0});
    PhantomOptions throat = shape_of(PhantomKind::kStenosis);
    throat.severity = 0.99;
    refused(throat, {0.5, 0});
    refused({}, {0, 0});
    refused({}, {1.5, 0});
    refused({}, {0.2, -1});
    refused({}, {1e-4, 0});
    PhantomOptions thick = shape_of(PhantomKind::kTorus);
    thick.a = 30;
    refused(thick, {0.2, 0});
}

}  // namespace
}  // namespace lumenline
