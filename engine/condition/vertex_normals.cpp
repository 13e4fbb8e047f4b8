// The angle is taken between sides from the corner, so that a vertex has the same normal however its fan is cut.
#include "engine/condition/vertex_normals.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lumenline {

namespace {

// Height of a triangle, per longest side, below which double precision gives its normal at random.
constexpr double kThinnest = 1e-12;

// Twice the area vector of a triangle; zero if it is too thin to have a direction.
Vec3 area_vector(const std::array<Vec3, 3>& p, double rounding) {
    const Vec3 doubled = cross(p[1] - p[0], p[2] - p[0]);
    const double longest = std::max({distance(p[0], p[1]), distance(p[1], p[2]), distance(p[2], p[0])});
    const double thinnest = std::max(kThinnest * longest, 4 * rounding);
    return norm(doubled) > thinnest * longest ? doubled : Vec3{};
}

}  // namespace

VertexNormals vertex_normals(std::span<const Vec3> points, std::span<const Corners> triangles, double rounding) {
    VertexNormals result;
    result.normals.resize(points.size());
    for (const Corners& t : triangles) {
        const std::array<Vec3, 3> p{points[t[0]], points[t[1]], points[t[2]]};
        const Vec3 doubled = area_vector(p, rounding);
        const double area = norm(doubled);
        if (area == 0) {
            ++result.thin_triangles;
            continue;
        }
        const Vec3 normal = (1 / area) * doubled;
        for (std::size_t k = 0; k < 3; ++k) {
            const double angle = std::atan2(area, dot(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]));
            result.normals[t[k]] += angle * normal;
        }
    }
    for (Vec3& n : result.normals) n = normalized(n);
    return result;
}

}  // namespace lumenline
