// Estimates against the surfaces that were written.
#include "io/mesh/estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include "io/mesh/mesh_io.h"

namespace lumenline {
namespace {

namespace fs = std::filesystem;

fs::path scratch(const std::string& name) { return fs::path(::testing::TempDir()) / ("estimate-" + name); }

/// A wavy sheet of n x n points.
struct Sheet {
    std::vector<Vec3> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

Sheet sheet(std::uint32_t n) {
    Sheet s;
    for (std::uint32_t i = 0; i < n * n; ++i)
        s.points.push_back({0.37 * (i / n), 0.41 * (i % n), std::sin(0.1 * static_cast<double>(i))});
    for (std::uint32_t i = 0; i + 1 < n; ++i)
        for (std::uint32_t j = 0; j + 1 < n; ++j) {
            const std::uint32_t k = i * n + j;
            s.triangles.push_back({k, k + 1, k + n});
            s.triangles.push_back({k + 1, k + n + 1, k + n});
        }
    return s;
}

TEST(Estimate, FilesThatStateTheirVerticesAreExactAndOthersWithinAFactorOfTwo) {
    const Sheet s = sheet(60);
    const auto sites = static_cast<double>(s.points.size());
    for (const std::string extension : {".ply", ".off", ".vtk", ".stl", ".obj"}) {
        const fs::path file = scratch("sheet" + extension);
        write_surface(file.string(), s.points, s.triangles);
        const SurfaceEstimate estimate = estimate_surface(file.string());
        EXPECT_EQ(estimate.bytes, fs::file_size(file));
        if (extension == ".stl") {
            EXPECT_EQ(estimate.sites, static_cast<double>(s.triangles.size()) / 2);
        } else if (extension == ".obj") {
            EXPECT_GT(estimate.sites, sites / 2);
            EXPECT_LT(estimate.sites, sites * 2);
        } else {
            EXPECT_EQ(estimate.sites, sites) << extension;
        }
    }
}

TEST(Estimate, XmlStatesItsPoints) {
    const fs::path file = scratch("a.vtp");
    std::ofstream(file) << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\"><PolyData>"
                           "<Piece NumberOfPoints=\"123\" NumberOfPolys=\"7\">"
                        << std::string(200, ' ');
    EXPECT_EQ(estimate_surface(file.string()).sites, 123);
}

TEST(Estimate, WhatIsNoSurfaceIsNothingOrSmall) {
    EXPECT_EQ(estimate_surface(scratch("nowhere.stl").string()).bytes, 0U);
    EXPECT_EQ(estimate_surface(::testing::TempDir()).sites, 0);
    const fs::path file = scratch("liar.ply");
    std::ofstream(file) << "ply\nelement vertex 99999999999\n";
    EXPECT_LE(estimate_surface(file.string()).sites, static_cast<double>(fs::file_size(file)));
    std::ofstream(scratch("empty.obj"));
    EXPECT_EQ(estimate_surface(scratch("empty.obj").string()).sites, 0);
}

}  // namespace
}  // namespace lumenline
