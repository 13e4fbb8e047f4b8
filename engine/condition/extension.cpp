#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/condition/cap.h"
#include "engine/condition/opening_plan.h"

// Rings are sampled anew from a smooth curve through the projected loop, each with its own phase and
// small displacements along the surface: rings that repeat the loop would put thousands of sites on
// common spheres, which slows the Delaunay several times. A ring keeps the share of the way from the
// loop to the end plane constant, so the wall of the extension is parallel to the normal whatever
// the shape of the loop, and the last ring is planar.

namespace lumenline {
namespace {

constexpr double kGoldenShare = 0.61803398874989485;  // phase from ring to ring, in sides
constexpr double kDisplacement = 0.1;                 // of ring points along the curve and the axis, in sides
constexpr double kRowHeight = 0.86602540378443865;    // of an equilateral triangle
constexpr std::size_t kFewestRingPoints = 6;
constexpr std::size_t kEnoughRingPoints = 12;  // a ring has at least so many, or as many as the loop

// Points around the opening, ascending along the curve within one turn, and their numbers.
struct Ring {
    std::vector<double> places;
    std::vector<std::uint32_t> numbers;
};

// Band of triangles between two rings, always advancing on the side whose new edge is the shorter
// along the curve.
void zip_rings(const Ring& lower, const Ring& upper, double turn, std::vector<Corners>& triangles) {
    const std::size_t n = lower.places.size(), m = upper.places.size();
    const auto unrolled = [turn](const Ring& ring, std::size_t i) {
        return ring.places[i % ring.places.size()] + turn * static_cast<double>(i / ring.places.size());
    };
    // The upper ring starts where it is nearest to the lower ring's start, possibly one turn back.
    const double start = lower.places.front() + turn;
    std::size_t first = 0;
    for (std::size_t j = 0; j <= 2 * m; ++j)
        if (std::fabs(unrolled(upper, j) - start) < std::fabs(unrolled(upper, first) - start)) first = j;
    for (std::size_t i = 0, j = first; i < n || j < first + m;) {
        const std::uint32_t a = lower.numbers[i % n], b = upper.numbers[j % m];
        const double a_gap = std::fabs(unrolled(lower, i + 1) + turn - unrolled(upper, j));
        const double b_gap = std::fabs(unrolled(upper, j + 1) - unrolled(lower, i) - turn);
        if (j == first + m || (i < n && a_gap <= b_gap))
            triangles.push_back({a, lower.numbers[++i % n], b});
        else
            triangles.push_back({a, upper.numbers[++j % m], b});
    }
}

// Rings and cap along one curve.
std::optional<Patch> extend_along(const OpeningPlan& plan, const ClosedCurve& curve, double length) {
    const double turn = curve.length(), end = plan.highest + length;
    const std::size_t fewest = std::clamp(plan.corners.size(), kFewestRingPoints, kEnoughRingPoints);
    const auto sides = std::max(fewest, static_cast<std::size_t>(std::lround(turn / plan.edge)));
    const auto rows = std::max(1L, std::lround(end / (kRowHeight * plan.edge)));
    const double side = turn / static_cast<double>(sides);

    Patch patch;
    Ring below{{curve.starts().begin(), curve.starts().end() - 1}, std::vector<std::uint32_t>(plan.corners.size())};
    std::iota(below.numbers.begin(), below.numbers.end(), 0U);
    auto number = static_cast<std::uint32_t>(plan.corners.size());
    std::vector<Vec2> outline;
    for (std::uint32_t row = 1; row <= static_cast<std::uint32_t>(rows); ++row) {
        Ring ring;
        const bool last = row == static_cast<std::uint32_t>(rows);
        const double turns = kGoldenShare * row, phase = turns - std::floor(turns) + kDisplacement;
        for (std::uint32_t i = 0; i < sides; ++i) {
            ring.places.push_back(side * (i + phase + kDisplacement * wobble(3 * plan.seed, row, i)));
            ring.numbers.push_back(number++);
            const ClosedCurve::Sample sample = curve.at(ring.places.back());
            const double shift = last ? 0 : kDisplacement * wobble(3 * plan.seed + 1, row, i);
            const double share = last ? 1 : (row + shift) / static_cast<double>(rows);
            patch.points.push_back(plan.frame.lift(sample.point, sample.height + share * (end - sample.height)));
            if (last) outline.push_back(sample.point);
        }
        zip_rings(below, ring, turn, patch.triangles);
        below = std::move(ring);
    }
    const auto cap = cap_polygon(outline, side, plan.seed);
    if (!cap) return std::nullopt;
    patch.extension_points = patch.points.size();
    const auto ring_start = static_cast<std::uint32_t>(plan.corners.size() + patch.points.size() - sides);
    for (const Vec2& q : cap->interior) patch.points.push_back(plan.frame.lift(q, end));
    for (const Corners& t : cap->triangles)
        patch.triangles.push_back({ring_start + t[0], ring_start + t[1], ring_start + t[2]});
    return patch;
}

}  // namespace

std::optional<Patch> extend_opening(const OpeningPlan& plan, double length) {
    for (const bool smooth : {true, false})
        if (auto patch = extend_along(plan, ClosedCurve(plan.outline, plan.heights, smooth), length)) return patch;
    return std::nullopt;
}

std::optional<Patch> cap_opening(const OpeningPlan& plan) {
    const auto cap = cap_polygon(plan.outline, plan.edge, plan.seed);
    if (!cap) return std::nullopt;
    Patch patch;
    for (const Vec2& q : cap->interior)
        patch.points.push_back(plan.frame.lift(q, interpolate_inside(plan.outline, plan.heights, q)));
    patch.triangles = cap->triangles;
    return patch;
}

}  // namespace lumenline
