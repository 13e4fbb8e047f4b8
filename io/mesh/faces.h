#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/soup.h"
#include "io/mesh/cursor.h"

namespace lumenline::mesh {

/// Triangles of the polygons of one file, in their order.
class FaceCollector {
public:
    explicit FaceCollector(const SourceFile& file) : file_(file) {}

    void reserve(std::size_t triangles) { triangles_.reserve(triangles); }

    /// Adds a polygon; `position` is where it stands, for messages.
    /// @throws StageError kFileFormat with fewer than three corners, kTooLarge
    void add(std::span<const std::uint32_t> corners, std::size_t position);

    /// Gives the triangles away, with each quad cut along its shorter diagonal (which only the points tell).
    /// All indices must be below points.size().
    std::vector<std::array<std::uint32_t, 3>> take(std::span<const Vec3> points);

private:
    const SourceFile& file_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::vector<std::uint32_t> quads_;  // first of the two triangles of each quad
};

/// Finished soup but for source_file and source_sha256.
/// @param digits  most significant digits of any coordinate in a text file; 0 = binary file
/// @throws StageError kNoSurface without any triangle
TriangleSoup make_soup(const SourceFile& file, std::vector<Vec3> points, FaceCollector& faces, int digits);

/// Rounding error that the coordinates of a file carry (TriangleSoup::coordinate_rounding).
double coordinate_rounding(std::span<const Vec3> points, int digits);

}  // namespace lumenline::mesh
