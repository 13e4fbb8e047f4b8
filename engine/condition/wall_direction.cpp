#include "engine/condition/wall_direction.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/geometry/heap.h"

// The normals of a straight tube are across its axis, wherever it was cut: the axis is the eigenvector of the least
// eigenvalue of the sum of their squares. Triangles count by their area, and less the farther they are from the loop
// along edges, for a vessel may bend. The two other eigenvalues of a round tube are half of the whole each.

namespace lumenline {
namespace {

constexpr double kDefinite = 0.15;  // least eigenvalue per second; of a cone, twice its slope squared

class Strips {
public:
    explicit Strips(const WallMesh& wall)
        : wall_(wall),
          first_(wall.points.size() + 1, 0),
          triangles_(3 * wall.triangles.size()),
          way_(wall.points.size(), std::numeric_limits<double>::infinity()) {
        for (const Corners& t : wall.triangles)
            for (const std::uint32_t v : t) ++first_[v + 1];
        for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        for (std::uint32_t t = 0; t < wall.triangles.size(); ++t)
            for (const std::uint32_t v : wall.triangles[t]) triangles_[next[v]++] = t;
        heap_.reset(wall.points.size());
    }

    Vec3 direction_at(const Loop& loop) {
        const Vec3 doubled = doubled_area(wall_, loop);
        const double reach = std::sqrt(norm(doubled) / 2 / std::numbers::pi);
        const std::vector<std::uint32_t> strip = vertices_within(loop, reach);
        Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
        for (const std::uint32_t v : strip)
            for (std::uint32_t k = first_[v]; k < first_[v + 1]; ++k)
                if (wall_.triangles[triangles_[k]][0] == v) add_normal(wall_.triangles[triangles_[k]], reach, squares);
        for (const std::uint32_t v : strip) way_[v] = std::numeric_limits<double>::infinity();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(squares);
        if (!(solver.eigenvalues()[0] < kDefinite * solver.eigenvalues()[1])) return {};
        const Eigen::Vector3d least = solver.eigenvectors().col(0);
        const Vec3 direction = normalized({least[0], least[1], least[2]});
        return dot(direction, doubled) < 0 ? -direction : direction;
    }

private:
    // Vertices whose way from the loop along edges is shorter than `reach`.
    std::vector<std::uint32_t> vertices_within(const Loop& loop, double reach) {
        const auto key = [this](std::uint32_t v) { return way_[v]; };
        for (const std::uint32_t v : loop) {
            way_[v] = 0;
            heap_.push_or_decrease(v, key);
        }
        std::vector<std::uint32_t> found;
        while (!heap_.empty()) {
            const std::uint32_t v = heap_.pop(key);
            found.push_back(v);
            for (std::uint32_t k = first_[v]; k < first_[v + 1]; ++k)
                for (const std::uint32_t w : wall_.triangles[triangles_[k]]) {
                    const double way = way_[v] + distance(wall_.points[v], wall_.points[w]);
                    if (!(way < std::min(reach, way_[w]))) continue;
                    way_[w] = way;
                    heap_.push_or_decrease(w, key);
                }
        }
        return found;
    }

    void add_normal(const Corners& t, double reach, Eigen::Matrix3d& squares) const {
        const double share = 1 - (way_[t[0]] + way_[t[1]] + way_[t[2]]) / (3 * reach);
        if (!(share > 0)) return;
        const Vec3 a = wall_.points[t[0]], doubled = cross(wall_.points[t[1]] - a, wall_.points[t[2]] - a);
        const Vec3 unit = normalized(doubled);
        const Eigen::Vector3d n(unit.x, unit.y, unit.z);
        squares += share * norm(doubled) * n * n.transpose();
    }

    const WallMesh& wall_;
    std::vector<std::uint32_t> first_, triangles_;  // of each vertex
    std::vector<double> way_;                       // from the loop, infinite beyond reach
    IndexedHeap heap_;
};

}  // namespace

Vec3 doubled_area(const WallMesh& wall, const Loop& loop) {
    const Vec3 start = wall.points[loop.front()];
    Vec3 doubled;
    for (std::size_t k = 0; k < loop.size(); ++k)
        doubled += cross(wall.points[loop[k]] - start, wall.points[loop[(k + 1) % loop.size()]] - start);
    return doubled;
}

std::vector<Vec3> wall_directions(const WallMesh& wall, const std::vector<Loop>& loops) {
    std::vector<Vec3> directions;
    if (loops.empty()) return directions;
    Strips strips(wall);
    for (const Loop& loop : loops) directions.push_back(strips.direction_at(loop));
    return directions;
}

}  // namespace lumenline
