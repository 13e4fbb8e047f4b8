#include "tests/stages/implicit_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace lumenline::test {

namespace {

class Polygonizer {
public:
    Polygonizer(Implicit f, Vec3 low, Vec3 high, double step) : f_(std::move(f)), low_(low), step_(step) {
        for (int axis = 0; axis < 3; ++axis) count_[axis] = static_cast<int>((high[axis] - low[axis]) / step) + 1;
    }

    TriangleSoup run() {
        static constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
        for (int k = 0; k + 1 < count_[2]; ++k)
            for (int j = 0; j + 1 < count_[1]; ++j)
                for (int i = 0; i + 1 < count_[0]; ++i)
                    for (const auto& order : kOrders) {
                        std::array<std::array<int, 3>, 4> corners;
                        corners.fill({i, j, k});
                        for (int c = 0; c < 3; ++c)
                            for (int later = c + 1; later < 4; ++later) ++corners[later][order[c]];
                        add_tetrahedron(corners);
                    }
        return std::move(soup_);
    }

private:
    using Corner = std::array<int, 3>;

    [[nodiscard]] Vec3 place(const Corner& c) const {
        // Sheared a little, so that no symmetry of the shape is one of the grid.
        const double x = c[0], y = c[1] + 0.013 * c[2], z = c[2] + 0.017 * c[0];
        return low_ + step_ * Vec3{x, y, z};
    }

    std::uint32_t vertex(const Corner& inside, const Corner& outside) {
        const auto [entry, is_new] =
            vertices_.emplace(std::pair{std::min(inside, outside), std::max(inside, outside)}, soup_.points.size());
        if (is_new) {
            const Vec3 a = place(inside), b = place(outside);
            const double fa = f_(a), fb = f_(b);
            soup_.points.push_back(lerp(a, b, std::clamp(fa / (fa - fb), 0.15, 0.85)));  // no needles
        }
        return static_cast<std::uint32_t>(entry->second);
    }

    void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, Vec3 inside) {
        const Vec3 p = soup_.points[a];
        if (dot(cross(soup_.points[b] - p, soup_.points[c] - p), inside - p) > 0) std::swap(b, c);
        soup_.triangles.push_back({a, b, c});
    }

    void add_tetrahedron(const std::array<Corner, 4>& corners) {
        std::vector<Corner> in, out;
        for (const Corner& c : corners) (f_(place(c)) < 0 ? in : out).push_back(c);
        if (in.empty() || out.empty()) return;
        if (in.size() == 2) {
            const std::uint32_t a = vertex(in[0], out[0]), b = vertex(in[0], out[1]), c = vertex(in[1], out[1]),
                                d = vertex(in[1], out[0]);
            add_triangle(a, b, c, place(in[0]));
            add_triangle(a, c, d, place(in[1]));
            return;
        }
        const bool one = in.size() == 1;
        std::vector<std::uint32_t> corner;
        for (const Corner& c : one ? out : in) corner.push_back(one ? vertex(in[0], c) : vertex(c, out[0]));
        add_triangle(corner[0], corner[1], corner[2], place(in[0]));
    }

    Implicit f_;
    Vec3 low_;
    double step_;
    int count_[3] = {};
    std::map<std::pair<Corner, Corner>, std::size_t> vertices_;
    TriangleSoup soup_;
};

}  // namespace

double tube_around_ring(Vec3 x, Vec3 centre, double ring, double tube) {
    const Vec3 d = x - centre;
    return std::hypot(std::hypot(d.x, d.y) - ring, d.z) - tube;
}

double straight_tube(Vec3 x, Vec3 a, Vec3 b, double tube) {
    const double t = std::clamp(dot(x - a, b - a) / squared_norm(b - a), 0.0, 1.0);
    return distance(x, lerp(a, b, t)) - tube;
}

TriangleSoup polygonized(const Implicit& shape, Vec3 low, Vec3 high, double step) {
    return Polygonizer(shape, low, high, step).run();
}

}  // namespace lumenline::test
