// Triangles are filled by their edge functions over the cells of their bounding box; a cell belongs to a triangle when
// its centre lies inside or on an edge, and the depth decides between neighbours that share one.

#include "io/export/raster.h"

#include <algorithm>
#include <cmath>

namespace lumenline {

namespace {

/// Cells whose centres lie between two places, clipped to the canvas; empty where first > last.
struct Range {
    long first, last;
};
Range cells_between(double low, double high, std::size_t size) {
    const double limit = static_cast<double>(size);
    return {static_cast<long>(std::ceil(std::clamp(low, 0.0, limit) - 0.5)),
            static_cast<long>(std::floor(std::clamp(high, 0.0, limit) - 0.5))};
}

bool is_finite(Vec3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace

void Canvas::draw(const std::array<Corner, 3>& triangle) {
    const auto& [a, b, c] = triangle;
    if (!is_finite(a.place) || !is_finite(b.place) || !is_finite(c.place)) return;
    const auto side = [](Vec3 from, Vec3 to, double x, double y) {
        return (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x);
    };
    const double area = side(a.place, b.place, c.place.x, c.place.y);
    if (area == 0) return;
    const auto [x_low, x_high] = std::minmax({a.place.x, b.place.x, c.place.x});
    const auto [y_low, y_high] = std::minmax({a.place.y, b.place.y, c.place.y});
    const Range columns = cells_between(x_low, x_high, size_), rows = cells_between(y_low, y_high, size_);
    for (long row = rows.first; row <= rows.last; ++row)
        for (long column = columns.first; column <= columns.last; ++column) {
            const double x = static_cast<double>(column) + 0.5, y = static_cast<double>(row) + 0.5;
            const double u = side(b.place, c.place, x, y) / area, v = side(c.place, a.place, x, y) / area;
            const double w = 1 - u - v;
            if (u < 0 || v < 0 || w < 0) continue;
            Cell& cell = cells_[static_cast<std::size_t>(row) * size_ + static_cast<std::size_t>(column)];
            const auto depth = static_cast<float>(u * a.place.z + v * b.place.z + w * c.place.z);
            if (cell.covered && depth <= cell.depth) continue;
            cell.depth = depth;
            cell.covered = true;
            cell.hue = static_cast<float>(u * a.hue + v * b.hue + w * c.hue);
            cell.light = static_cast<float>(u * a.light + v * b.light + w * c.light);
        }
}

void Canvas::stroke(Vec3 a, Vec3 b, double radius) {
    if (!is_finite(a) || !is_finite(b)) return;
    const Range columns = cells_between(std::min(a.x, b.x) - radius, std::max(a.x, b.x) + radius, size_);
    const Range rows = cells_between(std::min(a.y, b.y) - radius, std::max(a.y, b.y) + radius, size_);
    const double dx = b.x - a.x, dy = b.y - a.y, length = dx * dx + dy * dy;
    for (long row = rows.first; row <= rows.last; ++row)
        for (long column = columns.first; column <= columns.last; ++column) {
            const double x = static_cast<double>(column) + 0.5 - a.x, y = static_cast<double>(row) + 0.5 - a.y;
            const double t = length > 0 ? std::clamp((x * dx + y * dy) / length, 0.0, 1.0) : 0;
            if (std::hypot(x - t * dx, y - t * dy) > radius) continue;
            cells_[static_cast<std::size_t>(row) * size_ + static_cast<std::size_t>(column)].line = true;
        }
}

}  // namespace lumenline
