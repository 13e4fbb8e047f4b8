// Project along the sites' difference; inside, the projection is the nearest point, else the nearest point of an edge
// is.
#include "engine/geometry/nearest_on_polygon.h"

#include <algorithm>
#include <limits>

namespace lumenline {

double nearest_on_segment(Vec3 a, Vec3 b, Vec3 x) {
    const Vec3 e = b - a;
    const double e2 = squared_norm(e);
    return e2 > 0 ? std::clamp(dot(x - a, e) / e2, 0.0, 1.0) : 0.0;
}

NearestOnPolygon nearest_on_polygon(const Surface& surface, const VoronoiComplex& complex, PolygonId p, Vec3 x) {
    const auto loop = complex.polygon(p);
    const auto vertex = [&](std::size_t i) { return complex.vertices[at(loop[i == loop.size() ? 0 : i])]; };
    if (loop.size() > 2) {
        const auto [s, t] = complex.polygon_sites[at(p)];
        const Vec3 n = normalized(surface.points[at(t)] - surface.points[at(s)]);
        const Vec3 foot = x - dot(x - vertex(0), n) * n;
        int left = 0, right = 0;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const double side = dot(cross(vertex(i + 1) - vertex(i), foot - vertex(i)), n);
            left += side > 0;
            right += side < 0;
        }
        if (left == 0 || right == 0) return {foot, {}};
    }
    NearestOnPolygon best{vertex(0), {loop[0], loop[0], 0}};
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec3 a = vertex(i), b = vertex(i + 1);
        const double t = nearest_on_segment(a, b, x);
        const Vec3 q = lerp(a, b, t);
        if (!(squared_norm(q - x) < squared_norm(best.point - x))) continue;
        const VoronoiVertexId va = loop[i], vb = loop[i + 1 == loop.size() ? 0 : i + 1];
        best.point = q;
        best.place = t <= 0 ? ComplexPoint{va, va, 0} : t >= 1 ? ComplexPoint{vb, vb, 0} : ComplexPoint{va, vb, t};
    }
    return best;
}

}  // namespace lumenline
