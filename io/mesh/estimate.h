#pragma once

#include <cstdint>
#include <string>

namespace lumenline {

/// Size of a surface file, without reading it.
struct SurfaceEstimate {
    std::uintmax_t bytes = 0;  ///< of the file; 0 = there is none
    double sites = 0;          ///< vertices, stated by the file or by its length
};

/// What the first bytes and the length of a file tell of its surface. Exact where the file states its vertices (PLY,
/// OFF, VTK, VTP; binary STL by its triangles), else within a factor of about two. Nothing is checked, nothing throws.
/// @cost one read of 4 kB
SurfaceEstimate estimate_surface(const std::string& path);

}  // namespace lumenline
