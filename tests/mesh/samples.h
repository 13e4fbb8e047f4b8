#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <iosfwd>
#include <string>
#include <vector>

#include "engine/core/soup.h"

namespace lumenline::samples {

/// Corners of every triangle, which do not depend on how a format numbers its points.
using Corners = std::vector<std::array<Vec3, 3>>;

Corners corners_of(const TriangleSoup& soup);

/// A tetrahedron whose coordinates are exact in float32, and the unit cube; triangles oriented outward.
TriangleSoup tetrahedron();
TriangleSoup cube();

/// A small file, written by hand, and the triangles it holds.
struct Sample {
    std::string name;  ///< file name; the extension matters for OBJ only
    std::string bytes;
    Corners corners;
    /// Cut between two faces or solids the file is a valid smaller one: its format counts nothing there.
    bool can_shrink = false;
};

/// Name of a sample in a test's name, and where a test prints it.
std::string test_name(const Sample& sample);
void PrintTo(const Sample& sample, std::ostream* out);  // NOLINT: GoogleTest finds it by this name

/// Every variant of every format that is read.
const std::vector<Sample>& all();
const Sample& named(const std::string& name);

/// The bytes of `value` in the given order.
template <class T>
std::string bytes_of(T value, std::endian order) {
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    return {bytes.data(), bytes.size()};
}

/// Binary STL file with `header` at its beginning.
std::string binary_stl(const TriangleSoup& soup, std::string header);

/// Writes `bytes` to a file of this name in the tests' directory; returns its path.
std::string write_temporary(const std::string& name, const std::string& bytes);

}  // namespace lumenline::samples
