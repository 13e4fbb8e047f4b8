// Files that VTK wrote give the points, triangles and labels that VTK reads in them. Needs VTK's Python modules
// (Debian: python3-vtk9), and is skipped where they are missing.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "io/mesh/mesh_io.h"
#include "tests/mesh/samples.h"

namespace lumenline {
namespace {

namespace fs = std::filesystem;

// A triangle by its corners, turned until the least comes first, and its label.
using Face = std::pair<std::array<std::array<double, 3>, 3>, std::int32_t>;

struct Expected {
    std::vector<Vec3> points;
    std::vector<Face> faces;
};

Face face(std::array<std::array<double, 3>, 3> corners, std::int32_t label) {
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    return {corners, label};
}

Expected read_expected(const fs::path& path) {
    std::ifstream file(path);
    Expected expected;
    std::string word;
    std::size_t count = 0;
    file >> word >> count;
    expected.points.resize(count);
    for (Vec3& p : expected.points) file >> p.x >> p.y >> p.z;
    file >> word >> count;
    for (std::size_t t = 0; t < count; ++t) {
        std::array<std::array<double, 3>, 3> corners{};
        std::int32_t label = 0;
        for (auto& corner : corners) file >> corner[0] >> corner[1] >> corner[2];
        file >> label;
        expected.faces.push_back(face(corners, label));
    }
    EXPECT_TRUE(file.good()) << path;
    return expected;
}

// VTK reads the printed digits of a float into a float, Lumenline into a double.
double as_float(double x) {
    volatile const float narrow = static_cast<float>(x);  // GCC 12 may else drop the conversion there and back
    return static_cast<double>(narrow);
}

// Pieces and strips come in another order than VTK joins them: faces are compared as a sorted list.
void expect_agreement(const fs::path& path) {
    SCOPED_TRACE(path.filename().string());
    Expected expected = read_expected(path.string() + ".expected");
    TriangleSoup soup = read_surface(path.string());
    if (path.filename().string().starts_with("float_ascii")) {
        for (Vec3& p : soup.points) p = {as_float(p.x), as_float(p.y), as_float(p.z)};
    }
    EXPECT_EQ(soup.points, expected.points);
    ASSERT_EQ(soup.cell_labels.size(), 1U);
    EXPECT_EQ(soup.cell_labels[0].name, "ModelFaceID");
    std::vector<Face> faces;
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        std::array<std::array<double, 3>, 3> corners{};
        for (std::size_t c = 0; c < 3; ++c) {
            const Vec3& p = soup.points[soup.triangles[t][c]];
            corners[c] = {p.x, p.y, p.z};
        }
        faces.push_back(face(corners, soup.cell_labels[0].values[t]));
    }
    std::sort(faces.begin(), faces.end());
    std::sort(expected.faces.begin(), expected.faces.end());
    EXPECT_EQ(faces, expected.faces);
}

TEST(VtkAgreement, EveryVariantThatVtkWritesIsReadAsVtkReadsIt) {
    // Debian's own interpreter first: the modules belong to it.
    std::string python;
    for (const std::string candidate : {"/usr/bin/python3", "python3"}) {
        if (python.empty() && std::system((candidate + " -c 'import vtkmodules.all' 2>/dev/null").c_str()) == 0) {
            python = candidate;
        }
    }
    if (python.empty()) GTEST_SKIP() << "VTK's Python modules (python3-vtk9) are not installed";
    const fs::path folder = fs::path(::testing::TempDir()) / "lumenline_vtk_agreement";
    fs::remove_all(folder);
    fs::create_directories(folder);
    const std::string script = std::string(LUMENLINE_SOURCE_DIR) + "/tests/mesh/write_with_vtk.py";
    const std::string list = (folder / "list.txt").string();
    ASSERT_EQ(std::system((python + " '" + script + "' '" + folder.string() + "' > '" + list + "'").c_str()), 0);
    std::ifstream names(list);
    std::size_t count = 0;
    for (std::string name; std::getline(names, name); ++count) expect_agreement(folder / name);
    EXPECT_GT(count, 100U);
    fs::remove_all(folder);
}

}  // namespace
}  // namespace lumenline
