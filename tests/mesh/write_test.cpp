// What is written reads back as the same surface: bit by bit, or rounded to float32 for STL.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>

#include "io/mesh/mesh_io.h"
#include "tests/mesh/samples.h"

namespace lumenline {
namespace {

std::string temporary(const std::string& name) { return ::testing::TempDir() + "lumenline_write_" + name; }

// Coordinates of many magnitudes, none of them exact in float32, and the doubles at the ends of their range.
TriangleSoup awkward() {
    TriangleSoup soup;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> mantissa(-1, 1);
    for (int i = 0; i < 200; ++i) {
        const auto draw = [&] { return std::ldexp(mantissa(random), static_cast<int>(random() % 60) - 30); };
        soup.points.push_back({draw(), draw(), draw()});
    }
    for (std::uint32_t i = 0; i < 300; ++i) {
        soup.triangles.push_back({i % 200, (7 * i + 1) % 200, static_cast<std::uint32_t>(random() % 200)});
    }
    return soup;
}

bool same_bits(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    const auto same = [](double x, double y) {
        return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
    };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [&](const Vec3& p, const Vec3& q) { return same(p.x, q.x) && same(p.y, q.y) && same(p.z, q.z); });
}

class WriteDouble : public ::testing::TestWithParam<std::string> {};

TEST_P(WriteDouble, ReadsBackBitByBit) {
    TriangleSoup soup = awkward();
    soup.points.push_back({std::numeric_limits<double>::max(), std::numeric_limits<double>::denorm_min(), -0.0});
    const std::string path = temporary("double" + GetParam());
    write_surface(path, soup.points, soup.triangles);
    const TriangleSoup back = read_surface(path);
    EXPECT_TRUE(same_bits(back.points, soup.points));
    EXPECT_EQ(back.triangles, soup.triangles);
    EXPECT_FALSE(std::filesystem::exists(path + ".tmp"));
}

INSTANTIATE_TEST_SUITE_P(MeshWrite, WriteDouble, ::testing::Values(".ply", ".obj", ".off", ".vtk", ".PLY"),
                         [](const auto& test) { return test.param.substr(1); });

TEST(MeshWrite, StlReadsBackRoundedToFloat) {
    const TriangleSoup soup = awkward();
    const std::string path = temporary("float.stl");
    write_surface(path, soup.points, soup.triangles);
    const samples::Corners given = samples::corners_of(soup);
    const samples::Corners back = samples::corners_of(read_surface(path));
    ASSERT_EQ(back.size(), given.size());
    const auto rounded = [](double x) {
        volatile const float narrow = static_cast<float>(x);  // GCC 12 may else drop the conversion there and back
        return static_cast<double>(narrow);
    };
    for (std::size_t t = 0; t < given.size(); ++t) {
        for (std::size_t c = 0; c < 3; ++c) {
            const Vec3 p = given[t][c];
            EXPECT_EQ(back[t][c], (Vec3{rounded(p.x), rounded(p.y), rounded(p.z)})) << t;
        }
    }
}

TEST(MeshWrite, StlCarriesUnitNormals) {
    const TriangleSoup solid = samples::tetrahedron();
    const std::string path = temporary("normals.stl");
    write_surface(path, solid.points, solid.triangles);
    std::ifstream file(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    ASSERT_EQ(bytes.size(), 84U + 4 * 50);
    const std::string down = samples::bytes_of(0.0F, std::endian::little) +
                             samples::bytes_of(0.0F, std::endian::little) +
                             samples::bytes_of(-1.0F, std::endian::little);
    EXPECT_EQ(bytes.substr(84, 12), down);  // the first triangle lies in z = 0 and looks down
}

// Whatever the reader accepts from here on it accepted from hand-written files of the same form.
TEST(MeshWrite, SampleSurfacesSurviveEveryFormat) {
    for (const TriangleSoup& soup : {samples::tetrahedron(), samples::cube()}) {
        for (const std::string extension : {".stl", ".ply", ".obj", ".off", ".vtk"}) {
            const std::string path = temporary("sample" + extension);
            write_surface(path, soup.points, soup.triangles);
            EXPECT_EQ(samples::corners_of(read_surface(path)), samples::corners_of(soup)) << extension;
        }
    }
}

void expect_not_written(const std::string& name, const TriangleSoup& soup, const std::string& part) {
    const std::string path = temporary(name);
    try {
        write_surface(path, soup.points, soup.triangles);
        ADD_FAILURE() << "wrote " << path;
    } catch (const std::runtime_error& error) {
        const std::string sentence = error.what();
        EXPECT_NE(sentence.find(path), std::string::npos) << sentence;
        EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
    }
    EXPECT_FALSE(std::filesystem::exists(path + ".tmp"));
}

TEST(MeshWrite, UnusableSurfacesAreNotWritten) {
    TriangleSoup soup = samples::tetrahedron();
    expect_not_written("a.vtp", soup, "'.vtp'");
    expect_not_written("no_such_directory/a.stl", soup, "opening");
    expect_not_written("a.stl", {}, "no triangle");
    soup.points[2].y = 1e39;
    expect_not_written("a.stl", soup, "point 2");
    soup.points[2].y = std::numeric_limits<double>::quiet_NaN();
    expect_not_written("a.ply", soup, "point 2");
    soup = samples::tetrahedron();
    soup.triangles[1][2] = 4;
    expect_not_written("a.obj", soup, "triangle 1 refers to point 4 of 4");
}

TEST(MeshWrite, FailureLeavesTheStandingFile) {
    const TriangleSoup good = samples::tetrahedron();
    TriangleSoup bad = good;
    bad.points[0].x = std::numeric_limits<double>::infinity();
    const std::string path = temporary("standing.ply");
    write_surface(path, good.points, good.triangles);
    EXPECT_THROW(write_surface(path, bad.points, bad.triangles), std::runtime_error);
    EXPECT_EQ(read_surface(path).points, good.points);
}

TEST(MeshWrite, DirectoryInTheWayIsReportedAndNothingIsLeft) {
    const TriangleSoup soup = samples::tetrahedron();
    std::filesystem::create_directories(temporary("directory.off") + "/inside");
    expect_not_written("directory.off", soup, "renaming");
}

}  // namespace
}  // namespace lumenline
