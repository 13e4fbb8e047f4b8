// Winding number along an axis-parallel ray. Triangles are binned by their projection along the
// ray into a plane grid of about as many cells as triangles, so that a query meets only the few
// triangles of one cell. The point is moved symbolically by (eps, eps^2) in the plane: where an
// orientation vanishes, the sign of its derivative decides, hence no edge or vertex of the
// projection ever contains the point, and neighbouring triangles agree on who does.
#include "engine/geometry/inside_test.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumenline {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

int sign(double x) { return (x > 0) - (x < 0); }

/// Orientation of (a, b, p + (eps, eps^2)) in the plane of axes u, v; 0 only when a and b project
/// to one point.
int perturbed_orientation(Vec3 a, Vec3 b, Vec3 p, int u, int v) {
    const auto exact =
        CGAL::orientation(Kernel::Point_2(a[u], a[v]), Kernel::Point_2(b[u], b[v]), Kernel::Point_2(p[u], p[v]));
    if (exact != CGAL::COLLINEAR) return exact == CGAL::LEFT_TURN ? 1 : -1;
    if (a[v] != b[v]) return a[v] > b[v] ? 1 : -1;
    return sign(b[u] - a[u]);
}

/// What the triangle abc adds to the winding number of p by its crossing with the ray from p along +w.
int crossing(Vec3 a, Vec3 b, Vec3 c, Vec3 p, int u, int v) {
    const int ab = perturbed_orientation(a, b, p, u, v);
    if (ab == 0 || perturbed_orientation(b, c, p, u, v) != ab || perturbed_orientation(c, a, p, u, v) != ab) return 0;
    const auto point = [](Vec3 q) { return Kernel::Point_3(q.x, q.y, q.z); };
    const auto side = CGAL::orientation(point(a), point(b), point(c), point(p));
    // Seen along +w the triangle is counter-clockwise (ab > 0) when its outward normal points along +w.
    // p is on the negative side of an outward triangle above it: the ray leaves the surface there.
    if (ab > 0) return side == CGAL::NEGATIVE ? 1 : 0;
    return side == CGAL::POSITIVE ? -1 : 0;
}

float rounded_down(double x) { return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity()); }
float rounded_up(double x) { return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity()); }

}  // namespace

InsideTest::InsideTest(std::span<const Vec3> points, std::span<const std::array<SiteId, 3>> triangles)
    : points_(points), triangles_(triangles) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    low_ = {kInfinity, kInfinity, kInfinity};
    high_ = -low_;
    for (const auto& t : triangles_)
        for (const SiteId s : t)
            for (int axis = 0; axis < 3; ++axis) {
                low_[axis] = std::min(low_[axis], points_[at(s)][axis]);
                high_[axis] = std::max(high_[axis], points_[at(s)][axis]);
            }
    const Vec3 size = high_ - low_;
    w_ = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
    u_ = (w_ + 1) % 3;
    v_ = (w_ + 2) % 3;

    const double area = size[u_] * size[v_];
    const double width = area > 0 ? std::sqrt(area / static_cast<double>(triangles_.size())) : 0;
    const std::array<int, 2> axes{u_, v_};
    for (int k = 0; k < 2; ++k) {
        const double extent = size[axes[static_cast<std::size_t>(k)]];
        const auto wanted = width > 0 ? std::ceil(extent / width) : 1.0;
        const auto count = static_cast<std::size_t>(std::clamp(wanted, 1.0, 4096.0));
        cells_[static_cast<std::size_t>(k)] = count;
        inverse_width_[static_cast<std::size_t>(k)] = extent > 0 ? static_cast<double>(count) / extent : 0;
    }

    std::vector<Extent> extents(triangles_.size());
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        Extent& e = extents[i];
        e.triangle = static_cast<std::uint32_t>(i);
        const std::array<int, 3> order{u_, v_, w_};
        for (int k = 0; k < 3; ++k) {
            const auto [a, b, c] = std::array{points_[at(triangles_[i][0])][order[static_cast<std::size_t>(k)]],
                                              points_[at(triangles_[i][1])][order[static_cast<std::size_t>(k)]],
                                              points_[at(triangles_[i][2])][order[static_cast<std::size_t>(k)]]};
            e.low[k] = rounded_down(std::min({a, b, c}));
            e.high[k] = rounded_up(std::max({a, b, c}));
        }
    }
    auto for_each_cell = [&](const Extent& e, auto&& visit) {
        const std::size_t u1 = cell(e.high[0], 0), v1 = cell(e.high[1], 1);
        for (std::size_t v = cell(e.low[1], 1); v <= v1; ++v)
            for (std::size_t u = cell(e.low[0], 0); u <= u1; ++u) visit(v * cells_[0] + u);
    };
    offsets_.assign(cells_[0] * cells_[1] + 1, 0);
    for (const Extent& e : extents) for_each_cell(e, [&](std::size_t c) { ++offsets_[c + 1]; });
    for (std::size_t c = 0; c + 1 < offsets_.size(); ++c) offsets_[c + 1] += offsets_[c];
    entries_.resize(offsets_.back());
    std::vector<std::uint32_t> next(offsets_.begin(), offsets_.end() - 1);
    for (const Extent& e : extents) for_each_cell(e, [&](std::size_t c) { entries_[next[c]++] = e; });
}

std::size_t InsideTest::cell(double value, int direction) const {
    const auto k = static_cast<std::size_t>(direction);
    const double position = (value - low_[direction == 0 ? u_ : v_]) * inverse_width_[k];
    return position > 0 ? std::min(static_cast<std::size_t>(position), cells_[k] - 1) : 0;
}

bool InsideTest::inside(Vec3 p) const {
    for (int axis = 0; axis < 3; ++axis)
        if (!(p[axis] >= low_[axis] && p[axis] <= high_[axis])) return false;
    const std::size_t c = cell(p[v_], 1) * cells_[0] + cell(p[u_], 0);
    int winding = 0;
    for (std::size_t k = offsets_[c]; k < offsets_[c + 1]; ++k) {
        const Extent& e = entries_[k];
        if (p[u_] < e.low[0] || p[u_] > e.high[0] || p[v_] < e.low[1] || p[v_] > e.high[1] || p[w_] > e.high[2])
            continue;
        const auto& t = triangles_[e.triangle];
        winding += crossing(points_[at(t[0])], points_[at(t[1])], points_[at(t[2])], p, u_, v_);
    }
    return winding > 0;
}

bool inside_surface(std::span<const Vec3> points, std::span<const std::array<SiteId, 3>> triangles, Vec3 p) {
    int winding = 0;
    for (const auto& t : triangles) {
        const Vec3 a = points[at(t[0])], b = points[at(t[1])], c = points[at(t[2])];
        const auto beside = [&](int axis) {
            return std::min({a[axis], b[axis], c[axis]}) > p[axis] || std::max({a[axis], b[axis], c[axis]}) < p[axis];
        };
        if (!beside(0) && !beside(1) && std::max({a.z, b.z, c.z}) >= p.z) winding += crossing(a, b, c, p, 0, 1);
    }
    return winding > 0;
}

}  // namespace lumenline
