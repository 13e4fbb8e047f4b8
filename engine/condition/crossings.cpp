#include "engine/condition/crossings.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

// CGAL's box intersection proposes pairs, its exact predicates decide. Nearly all pairs are
// neighbours, which a plane of one of the two separates but for what they share; a test with a
// bound on its rounding error settles those and leaves few to the predicates, so that this takes
// half as long as CGAL's own self_intersections and needs no mesh structure.

namespace lumenline {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Box =
    CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t, CGAL::Box_intersection_d::ID_FROM_BOX_ADDRESS>;

// Relative rounding error of a determinant of three differences is below 12 units of 2^-53.
constexpr double kRounding = 1e-14;
constexpr std::ptrdiff_t kCutoff = 500;  // of the box intersection; fastest between 300 and 1000

struct LimitReached {};

Kernel::Point_3 to_cgal(Vec3 p) { return {p.x, p.y, p.z}; }

struct Plane {
    Vec3 normal;       ///< twice the area vector of the triangle
    double scale = 0;  ///< bounds the products of which the normal is made
};

class Crossings {
public:
    Crossings(const std::vector<Vec3>& points, const std::vector<Corners>& triangles)
        : points_(points), triangles_(triangles), planes_(triangles.size()) {
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            const Vec3 u = point(triangles[t][1]) - point(triangles[t][0]);
            const Vec3 v = point(triangles[t][2]) - point(triangles[t][0]);
            planes_[t] = {cross(u, v), norm(u) * norm(v)};
        }
    }

    [[nodiscard]] bool is_degenerate(std::uint32_t t) const {
        const Corners& c = triangles_[t];
        return norm(planes_[t].normal) <= kRounding * planes_[t].scale &&
               CGAL::collinear(to_cgal(point(c[0])), to_cgal(point(c[1])), to_cgal(point(c[2])));
    }

    [[nodiscard]] bool cross_each_other(std::uint32_t s, std::uint32_t t) const {
        Corners a = triangles_[s], b = triangles_[t];
        const std::size_t shared = move_shared_first(a, b);
        if (shared == 3) return true;
        if (separates(s, a[0], b, shared) || separates(t, b[0], a, shared)) return false;
        if (shared == 0) return CGAL::do_intersect(triangle(a), triangle(b));
        if (shared == 1)
            return CGAL::do_intersect(triangle(a), segment(b[1], b[2])) ||
                   CGAL::do_intersect(triangle(b), segment(a[1], a[2]));
        // Two triangles on an edge meet elsewhere only when folded flat onto each other.
        const auto p = to_cgal(point(a[0])), q = to_cgal(point(a[1]));
        const auto r = to_cgal(point(a[2])), o = to_cgal(point(b[2]));
        return CGAL::coplanar(p, q, r, o) && CGAL::coplanar_orientation(p, q, r, o) == CGAL::POSITIVE;
    }

private:
    [[nodiscard]] Vec3 point(std::uint32_t v) const { return points_[v]; }
    [[nodiscard]] Kernel::Triangle_3 triangle(const Corners& c) const {
        return {to_cgal(point(c[0])), to_cgal(point(c[1])), to_cgal(point(c[2]))};
    }
    [[nodiscard]] Kernel::Segment_3 segment(std::uint32_t a, std::uint32_t b) const {
        return {to_cgal(point(a)), to_cgal(point(b))};
    }

    static std::size_t move_shared_first(Corners& a, Corners& b) {
        std::size_t shared = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto match = std::find(b.begin() + static_cast<std::ptrdiff_t>(shared), b.end(), a[i]);
            if (match == b.end()) continue;
            std::iter_swap(b.begin() + static_cast<std::ptrdiff_t>(shared), match);
            std::swap(a[shared++], a[i]);
        }
        return shared;
    }

    // Whether all corners of `other` that are not shared lie strictly on one side of triangle t,
    // of which `origin` is a corner.
    [[nodiscard]] bool separates(std::uint32_t t, std::uint32_t origin, const Corners& other,
                                 std::size_t shared) const {
        bool above = true, below = true;
        for (std::size_t k = shared; k < 3; ++k) {
            const Vec3 d = point(other[k]) - point(origin);
            const double side = dot(planes_[t].normal, d);
            const double bound = kRounding * planes_[t].scale * (std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z));
            above = above && side > bound;
            below = below && side < -bound;
        }
        return above || below;
    }

    const std::vector<Vec3>& points_;
    const std::vector<Corners>& triangles_;
    std::vector<Plane> planes_;
};

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> crossing_triangles(const std::vector<Vec3>& points,
                                                                        const std::vector<Corners>& triangles,
                                                                        std::size_t limit) {
    const Crossings crossings(points, triangles);
    std::vector<Box> boxes;
    boxes.reserve(triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        if (crossings.is_degenerate(t)) continue;
        const Corners& c = triangles[t];
        boxes.emplace_back(to_cgal(points[c[0]]).bbox() + to_cgal(points[c[1]]).bbox() + to_cgal(points[c[2]]).bbox(),
                           t);
    }
    std::vector<const Box*> pointers;
    pointers.reserve(boxes.size());
    for (const Box& box : boxes) pointers.push_back(&box);

    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    const auto visit = [&](const Box* a, const Box* b) {
        if (!crossings.cross_each_other(a->info(), b->info())) return;
        pairs.push_back(std::minmax(a->info(), b->info()));
        if (pairs.size() == limit) throw LimitReached();
    };
    try {
        CGAL::box_self_intersection_d<CGAL::Sequential_tag>(pointers.begin(), pointers.end(), visit, kCutoff);
    } catch (const LimitReached&) {
        // The pairs found so far are the answer.
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

}  // namespace lumenline
