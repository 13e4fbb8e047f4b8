#include "engine/condition/wall_mesh.h"

#include <algorithm>
#include <cmath>

// Helpers that all steps of conditioning share.

namespace lumenline {

double bounding_diagonal(const std::vector<Vec3>& points) {
    if (points.empty()) return 0;
    Vec3 low = points.front(), high = points.front();
    for (const Vec3& p : points) {
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    }
    const Vec3 extent = high - low;
    return std::hypot(extent.x, extent.y, extent.z);  // squares of the extents of a tiny surface vanish
}

std::vector<std::uint32_t> drop_unused_vertices(WallMesh& wall) {
    std::vector<std::uint32_t> renumbered(wall.points.size(), kDropped);
    for (const Corners& t : wall.triangles)
        for (const std::uint32_t v : t) renumbered[v] = 0;
    std::uint32_t count = 0;
    for (std::size_t v = 0; v < renumbered.size(); ++v) {
        if (renumbered[v] == kDropped) continue;
        wall.points[count] = wall.points[v];
        wall.input_vertex[count] = wall.input_vertex[v];
        renumbered[v] = count++;
    }
    if (count == wall.points.size()) return renumbered;
    wall.points.resize(count);
    wall.input_vertex.resize(count);
    for (Corners& t : wall.triangles)
        for (std::uint32_t& v : t) v = renumbered[v];
    return renumbered;
}

void refuse(ErrorCode code, const std::string& sentence) { throw StageError(Stage::kCondition, code, sentence); }

}  // namespace lumenline
