#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/core/soup.h"
#include "engine/core/vec3.h"

namespace lumenline {

/// A phantom's mesh as a reader would have returned it; source_file is "phantom".
/// @param relative_rounding  of coordinates, per largest coordinate
TriangleSoup mesh_soup(const std::vector<Vec3>& points, const std::vector<std::array<std::uint32_t, 3>>& triangles,
                       double relative_rounding);

}  // namespace lumenline
