#include "engine/condition/collision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

// The extension is the prism over the loop's projection between two heights. A triangle that reaches
// between them is sampled at the margin by which the prism is taken wider than it is: nothing passes
// between the samples. The margin is less than an edge, for the legs of a hairpin may be that close
// all along without harm. The lower height lies above the loop by a quarter of an edge, which leaves
// out the wall beside it.

namespace lumenline {
namespace {

constexpr double kClearOfLoop = 0.25;  // lower end of the prism above the loop, in edges
constexpr double kMargin = 0.4;        // around the prism, in edges
constexpr int kMostSamples = 256;      // along a triangle's side; longer triangles are sampled more coarsely

class Prism {
public:
    Prism(const OpeningPlan& plan, double length)
        : plan_(plan),
          margin_(kMargin * plan.edge),
          low_(plan.highest + kClearOfLoop * plan.edge),
          high_(plan.highest + length + plan.edge),
          reach_(margin_),
          sides_(sides_of(plan.outline)) {
        for (const Vec2& q : plan.outline) reach_ = std::max(reach_, norm(q) + margin_);
    }

    [[nodiscard]] double height(Vec3 p) const { return plan_.frame.height(p); }

    [[nodiscard]] bool spans(double a, double b, double c) const {
        return std::max({a, b, c}) > low_ && std::min({a, b, c}) < high_;
    }

    [[nodiscard]] bool meets(const std::array<Vec3, 3>& t) const {
        const std::array<Vec2, 3> q{plan_.frame.project(t[0]), plan_.frame.project(t[1]), plan_.frame.project(t[2])};
        if (std::min({q[0].x, q[1].x, q[2].x}) > reach_ || std::max({q[0].x, q[1].x, q[2].x}) < -reach_ ||
            std::min({q[0].y, q[1].y, q[2].y}) > reach_ || std::max({q[0].y, q[1].y, q[2].y}) < -reach_)
            return false;
        const double longest = std::max({distance(t[0], t[1]), distance(t[1], t[2]), distance(t[2], t[0])});
        const double wanted = std::ceil(longest / margin_);
        const int n = wanted < kMostSamples ? std::max(1, static_cast<int>(wanted)) : kMostSamples;
        const std::array<double, 3> h{height(t[0]), height(t[1]), height(t[2])};
        if (n == 1 && contains((1.0 / 3) * (q[0] + q[1] + q[2]), (h[0] + h[1] + h[2]) / 3)) return true;
        for (int i = 0; i <= n; ++i) {
            for (int j = 0; i + j <= n; ++j) {
                const double s = static_cast<double>(i) / n, r = static_cast<double>(j) / n;
                if (contains((1 - s - r) * q[0] + s * q[1] + r * q[2], (1 - s - r) * h[0] + s * h[1] + r * h[2]))
                    return true;
            }
        }
        return false;
    }

private:
    [[nodiscard]] bool contains(Vec2 q, double h) const {
        return h > low_ && h < high_ && norm(q) < reach_ && depth_among(sides_, q) > -margin_;
    }

    const OpeningPlan& plan_;
    double margin_, low_, high_, reach_;
    std::vector<Side> sides_;
};

}  // namespace

Obstacles::Obstacles(const WallMesh& wall, const std::vector<OpeningPlan>& plans) : wall_(&wall) {
    for (const OpeningPlan& plan : plans)
        for (std::size_t i = 0; i < plan.corners.size(); ++i)
            added_.push_back(
                {plan.frame.origin, plan.corners[i], plan.corners[(i + 1) % plan.corners.size()], plan.seed});
}

void Obstacles::add(const OpeningPlan& plan, const Patch& patch) {
    const auto point = [&](std::uint32_t v) {
        return v < plan.corners.size() ? plan.corners[v] : patch.points[v - plan.corners.size()];
    };
    for (const Corners& t : patch.triangles) added_.push_back({point(t[0]), point(t[1]), point(t[2]), plan.seed});
}

bool Obstacles::in_the_way(const OpeningPlan& plan, double length) const {
    const Prism prism(plan, length);
    std::vector<double> heights(wall_->points.size());
    for (std::size_t v = 0; v < heights.size(); ++v) heights[v] = prism.height(wall_->points[v]);
    for (const Corners& t : wall_->triangles)
        if (prism.spans(heights[t[0]], heights[t[1]], heights[t[2]]) &&
            prism.meets({wall_->points[t[0]], wall_->points[t[1]], wall_->points[t[2]]}))
            return true;
    return std::any_of(added_.begin(), added_.end(), [&](const Triangle& t) {
        return t.opening != plan.seed && prism.spans(prism.height(t.a), prism.height(t.b), prism.height(t.c)) &&
               prism.meets({t.a, t.b, t.c});
    });
}

}  // namespace lumenline
