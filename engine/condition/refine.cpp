#include "engine/condition/refine.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "engine/condition/half_edges.h"
#include "engine/condition/vertex_normals.h"
#include "engine/condition/wall_radius.h"
#include "engine/core/text.h"
#include "engine/geometry/surface_distance.h"

// An empty ball of radius R rests on sites and bulges through the triangles between them: with c the clearance
// and rho the covering radius of a triangle, R^2 = c^2 + rho^2. So sampling is judged by rho against the local
// radius, and the share by which balls are too large follows; it is 5 % at about twelve edges around a round tube,
// 11 % at eight.
//
// The new point of an edge lies on the circular arc that leaves both ends at the angle of their tangent planes,
// which is exact on spheres and along the circles of tubes, at any coarseness; where the ends disagree, as along an S,
// the two bends cancel. On a boundary the point stays in the plane that the loop bends in, so that
// planar openings stay planar.

namespace lumenline {
namespace {

constexpr int kMostRounds = 3;
constexpr double kMostGap = 0.05;       // (R - clearance) / R that is let pass
constexpr double kMostBend = 1.05;      // radians from chord to tangent; more is an edge, not a curve
constexpr std::size_t kMostGrowth = 4;  // points added per point of before, at most
constexpr std::uint32_t kUnsplit = kDropped;

// rho / r at which a ball of radius R^2 = r^2 + rho^2 reaches beyond the wall by that share, r being the clearance.
const double kMostCover = std::sqrt(1 / ((1 - kMostGap) * (1 - kMostGap)) - 1);

// Way from the middle of the chord a b to the arc.
Vec3 bulge(Vec3 a, Vec3 b, Vec3 normal_a, Vec3 normal_b) {
    const double length = distance(a, b);
    if (!(length > 0)) return {};
    const Vec3 along = (1 / length) * (b - a);
    const auto bend = [](double sine) { return std::asin(std::clamp(sine, -1.0, 1.0)); };
    const double at_a = bend(-dot(normal_a, along)), at_b = bend(dot(normal_b, along));
    if (std::fabs(at_a) > kMostBend || std::fabs(at_b) > kMostBend) return {};
    const Vec3 mean = normal_a + normal_b;
    const Vec3 up = normalized(mean - dot(mean, along) * along);
    return (0.5 * length * std::tan(0.25 * (at_a + at_b))) * up;
}

struct Coarse {
    std::uint32_t triangle = 0;
    double radius = 0, cover = 0;
};

class Refiner {
public:
    Refiner(WallMesh& wall, WallTopology& topology) : wall_(wall), topology_(topology) {
        refined_.first_added = static_cast<std::uint32_t>(wall.points.size());
        active_.resize(wall.triangles.size());
        std::iota(active_.begin(), active_.end(), 0U);
    }

    void run(StageContext& context) {
        for (int round = 0; round < kMostRounds && !active_.empty(); ++round) {
            context.check_cancelled();
            if (!find_coarse(round == 0, context)) break;
            split();
        }
        if (coarse_triangles_ == 0) return;
        const std::size_t added = wall_.points.size() - refined_.first_added;
        const double gap = 1 - 1 / std::sqrt(1 + worst_ * worst_);
        context.note("undersampled_refined",
                     counted(coarse_triangles_, "triangle") + " large for the vessel, the worst at " +
                         short_text(worst_at_) + " with a covering radius of " + short_text(worst_, 3) +
                         " local radii, where balls would reach beyond the wall by " + short_text(100 * gap, 3) +
                         " % of their radius; " + counted(added, "site") + " added on the curved surface",
                     worst_, kMostCover);
    }

    Refined take() { return std::move(refined_); }

private:
    // Marks the edges to halve. @returns whether there are any
    bool find_coarse(bool first, StageContext& context) {
        pairs_ = pair_half_edges(wall_.triangles, wall_.points.size());
        split_at_.assign(3 * wall_.triangles.size(), kUnsplit);
        bool any = false;
        for (const Coarse& c : measure(WallRadius(wall_), context)) {
            any |= mark(c.triangle, c.radius);
            if (!first) continue;
            ++coarse_triangles_;
            if (c.cover > worst_ * c.radius) {
                worst_ = c.cover / c.radius;
                worst_at_ = wall_.points[wall_.triangles[c.triangle][0]];
            }
        }
        return any;
    }

    // Active triangles with a covering radius of more than `kMostCover` local radii.
    std::vector<Coarse> measure(const WallRadius& radius, StageContext& context) const {
        std::vector<Coarse> all(active_.size());
        context.parallel_for(active_.size(), 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const Corners& t = wall_.triangles[active_[i]];
                const double cover = covering_radius(wall_.points[t[0]], wall_.points[t[1]], wall_.points[t[2]]);
                const double enough = cover / kMostCover;
                if (!(enough > 0) || !std::isfinite(enough)) continue;
                if (const double r = radius.at(active_[i], enough); r < enough) all[i] = {active_[i], r, cover};
            }
        });
        std::erase_if(all, [](const Coarse& c) { return c.radius == 0; });
        return all;
    }

    // Marks the sides of triangle t that are longer than those of the equilateral triangle that would do.
    bool mark(std::uint32_t t, double radius) {
        const double enough = std::sqrt(3) * kMostCover * radius;
        bool any = false;
        for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
            const Vec3 a = wall_.points[start_of(wall_.triangles, h)];
            const Vec3 b = wall_.points[start_of(wall_.triangles, next_half_edge(h))];
            if (distance(a, b) <= enough) continue;
            any = true;
            split_at_[h] = 0;
            if (pairs_.opposite[h] != kNoHalfEdge) split_at_[pairs_.opposite[h]] = 0;
        }
        return any;
    }

    void split() {
        place_points();
        update_loops();
        std::vector<Corners> triangles;
        std::vector<std::uint32_t> next_active;
        triangles.reserve(wall_.triangles.size());
        std::vector<Corners> children;
        for (std::uint32_t t = 0; t < wall_.triangles.size(); ++t) {
            children.clear();
            divide(t, children);
            if (children.size() > 1)
                for (std::size_t k = 0; k < children.size(); ++k)
                    next_active.push_back(static_cast<std::uint32_t>(triangles.size() + k));
            triangles.insert(triangles.end(), children.begin(), children.end());
        }
        wall_.triangles = std::move(triangles);
        active_ = std::move(next_active);
    }

    // One point per marked edge, in the order of half-edges.
    void place_points() {
        const std::vector<Vec3> normals = vertex_normals(wall_.points, wall_.triangles, 0).normals;
        const std::size_t most = (kMostGrowth + 1) * std::size_t{refined_.first_added};
        for (std::uint32_t h = 0; h < split_at_.size(); ++h) {
            if (split_at_[h] != 0) continue;
            const std::uint32_t opposite = pairs_.opposite[h];
            const auto number = static_cast<std::uint32_t>(wall_.points.size());
            const bool place = number < most;
            split_at_[h] = place ? number : kUnsplit;
            if (opposite != kNoHalfEdge) split_at_[opposite] = split_at_[h];
            if (!place) continue;
            const std::uint32_t a = start_of(wall_.triangles, h), b = start_of(wall_.triangles, next_half_edge(h));
            const Vec3 middle = lerp(wall_.points[a], wall_.points[b], 0.5);
            Vec3 shift = bulge(wall_.points[a], wall_.points[b], normals[a], normals[b]);
            if (opposite == kNoHalfEdge) shift = within_loop(a, b, shift);
            refined_.ends.push_back({a, b});
            refined_.shift.push_back(shift);
            wall_.points.push_back(middle + shift);
            wall_.input_vertex.push_back(kDropped);
            topology_.component.push_back(topology_.component[a]);
        }
    }

    // The part of `shift` in the plane in which the boundary bends at its edge a b; all of it where it is straight.
    [[nodiscard]] Vec3 within_loop(std::uint32_t a, std::uint32_t b, Vec3 shift) const {
        for (const Loop& loop : topology_.loops) {
            const std::size_t n = loop.size();
            for (std::size_t i = 0; i < n; ++i) {
                const std::uint32_t p = loop[i], q = loop[(i + 1) % n];
                if (!(p == b && q == a) && !(p == a && q == b)) continue;
                const Vec3 side = wall_.points[q] - wall_.points[p];
                const Vec3 plane = cross(wall_.points[p] - wall_.points[loop[(i + n - 1) % n]], side) +
                                   cross(side, wall_.points[loop[(i + 2) % n]] - wall_.points[q]);
                const Vec3 binormal = normalized(plane);
                return shift - dot(shift, binormal) * binormal;
            }
        }
        return shift;
    }

    void update_loops() {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> added;  // start of a loop's side -> point on it
        for (std::uint32_t h = 0; h < split_at_.size(); ++h)
            if (split_at_[h] != kUnsplit && pairs_.opposite[h] == kNoHalfEdge)
                added.emplace_back(start_of(wall_.triangles, next_half_edge(h)), split_at_[h]);
        std::sort(added.begin(), added.end());
        for (Loop& loop : topology_.loops) {
            Loop longer;
            for (const std::uint32_t v : loop) {
                longer.push_back(v);
                const auto side = std::lower_bound(added.begin(), added.end(), std::pair{v, 0U});
                if (side != added.end() && side->first == v) longer.push_back(side->second);
            }
            loop = std::move(longer);
        }
    }

    // Triangles that replace triangle t, the first in its place in the order.
    void divide(std::uint32_t t, std::vector<Corners>& children) const {
        const Corners& c = wall_.triangles[t];
        std::uint32_t marked = 0, first = 0, unmarked = 0;
        for (std::uint32_t k = 0; k < 3; ++k) {
            if (split_at_[3 * t + k] == kUnsplit) {
                unmarked = k;
            } else {
                ++marked;
                first = k;
            }
        }
        const auto corner = [&](std::uint32_t k) { return c[k % 3]; };
        const auto middle = [&](std::uint32_t k) { return split_at_[3 * t + k % 3]; };
        if (marked == 0) {
            children.push_back(c);
        } else if (marked == 1) {
            children.push_back({corner(first), middle(first), corner(first + 2)});
            children.push_back({middle(first), corner(first + 1), corner(first + 2)});
        } else if (marked == 2) {
            // Side `unmarked` from a to b stays; p on side b c, q on side c a.
            const std::uint32_t a = corner(unmarked), b = corner(unmarked + 1), apex = corner(unmarked + 2);
            const std::uint32_t p = middle(unmarked + 1), q = middle(unmarked + 2);
            children.push_back({p, apex, q});
            if (distance(wall_.points[a], wall_.points[p]) <= distance(wall_.points[b], wall_.points[q])) {
                children.push_back({a, b, p});
                children.push_back({a, p, q});
            } else {
                children.push_back({a, b, q});
                children.push_back({b, p, q});
            }
        } else {
            children.push_back({corner(0), middle(0), middle(2)});
            children.push_back({middle(0), corner(1), middle(1)});
            children.push_back({middle(2), middle(1), corner(2)});
            children.push_back({middle(0), middle(1), middle(2)});
        }
    }

    WallMesh& wall_;
    WallTopology& topology_;
    Refined refined_;
    std::vector<std::uint32_t> active_;  // triangles that may still be too large
    HalfEdgePairs pairs_;
    std::vector<std::uint32_t> split_at_;  // per half-edge: point on it; 0 = marked, kUnsplit = stays
    std::size_t coarse_triangles_ = 0;
    double worst_ = 0;
    Vec3 worst_at_;
};

}  // namespace

bool flatten_points(WallMesh& wall, Refined& refined, std::vector<char> flat) {
    bool changed = false;
    for (std::size_t i = refined.ends.size(); i-- > 0;) {
        if (!flat[refined.first_added + i]) continue;
        changed |= refined.shift[i] != Vec3{};
        refined.shift[i] = {};
        for (const std::uint32_t end : refined.ends[i]) flat[end] = 1;
    }
    for (std::size_t i = 0; changed && i < refined.ends.size(); ++i)
        wall.points[refined.first_added + i] =
            lerp(wall.points[refined.ends[i][0]], wall.points[refined.ends[i][1]], 0.5) + refined.shift[i];
    return changed;
}

Refined refine_undersampled(WallMesh& wall, WallTopology& topology, StageContext& context) {
    Refiner refiner(wall, topology);
    refiner.run(context);
    return refiner.take();
}

}  // namespace lumenline
