#include "engine/trace/polyline.h"

#include <algorithm>

#include "engine/geometry/segment_cost.h"

namespace lumenline {

void Polyline::append(Vec3 x, double r) {
    abscissa.push_back(points.empty() ? 0.0 : abscissa.back() + distance(points.back(), x));
    points.push_back(x);
    radius.push_back(r);
}

double cut_at_plane(Polyline& line, Vec3 origin, Vec3 normal, bool at_front) {
    const std::size_t n = line.size();
    const auto index = [&](std::size_t i) { return at_front ? i : n - 1 - i; };
    const auto height = [&](std::size_t i) { return dot(line.points[index(i)] - origin, normal); };
    if (n == 0 || height(0) <= 0) return 0;
    std::size_t inner = 1;
    while (inner < n && height(inner) > 0) ++inner;
    const double whole = line.abscissa.back();
    Polyline cut;
    if (inner < n) {
        const double h0 = height(inner - 1), h1 = height(inner);
        const std::size_t i = index(inner - 1), j = index(inner);
        const double t = h0 / (h0 - h1);
        cut.append(lerp(line.points[i], line.points[j], t),
                   radius_between(line.radius[i], line.radius[j], squared_norm(line.points[j] - line.points[i]), t));
        for (std::size_t k = inner; k < n; ++k) cut.append(line.points[index(k)], line.radius[index(k)]);
    }
    if (!at_front) {
        std::reverse(cut.points.begin(), cut.points.end());
        std::reverse(cut.radius.begin(), cut.radius.end());
        Polyline ordered;
        for (std::size_t k = 0; k < cut.size(); ++k) ordered.append(cut.points[k], cut.radius[k]);
        cut = std::move(ordered);
    }
    line = std::move(cut);
    return whole - (line.size() > 0 ? line.abscissa.back() : 0.0);
}

Turn sharpest_turn(const Polyline& line) {
    Turn sharpest;
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
        const Vec3 before = normalized(line.points[i] - line.points[i - 1]);
        const Vec3 after = normalized(line.points[i + 1] - line.points[i]);
        if (const double cosine = dot(before, after); cosine < sharpest.cosine) sharpest = {cosine, line.points[i]};
    }
    return sharpest;
}

}  // namespace lumenline
