#pragma once

#include <string>
#include <string_view>

#include "engine/core/soup.h"

namespace lumenline::mutation {

/// The bytes of a surface file, whatever the coordinates and indices are: binary STL (float32), binary PLY, legacy VTK
/// and VTK XML with raw data (double), OBJ and OFF with 17 digits. io/mesh writes sound surfaces only.
std::string file_of(const TriangleSoup& soup, std::string_view format);

/// The same for stl, ply, vtk and vtp, all numbers in the other byte order than the format's.
std::string swapped_file_of(const TriangleSoup& soup, std::string_view format);

}  // namespace lumenline::mutation
