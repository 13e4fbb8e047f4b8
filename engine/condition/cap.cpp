#include "engine/condition/cap.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

// Points are inserted one by one in a fixed order, since CGAL's range insertion shuffles, and the
// triangles are sorted: the same polygon always gives the same cap. Lattice points closer to the
// polygon than 0.6 edges would make flat triangles along it and are left out.

namespace lumenline {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<bool, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::No_constraint_intersection_tag>;

constexpr double kLeastDepth = 0.6;    // of lattice points, in edges
constexpr double kDisplacement = 0.1;  // of lattice points, in edges
constexpr double kRowHeight = 0.86602540378443865;
constexpr double kMostLatticeRows = 4000;  // a cap of 1.6e7 points: beyond it the edge cannot be meant

std::vector<Kernel::Point_2> to_cgal(const std::vector<Vec2>& polygon) {
    std::vector<Kernel::Point_2> corners;
    for (const Vec2& p : polygon) corners.emplace_back(p.x, p.y);
    return corners;
}

// Each row looks only at the sides that come near it.
std::vector<Vec2> lattice_inside(const std::vector<Vec2>& polygon, double edge, std::uint32_t seed) {
    Vec2 low = polygon.front(), high = polygon.front();
    for (const Vec2& p : polygon) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    const double spacing = std::max({edge, (high.x - low.x) / kMostLatticeRows, (high.y - low.y) / kMostLatticeRows});
    const double reach = (kLeastDepth + kDisplacement) * spacing;
    const auto index = [](double x) { return static_cast<std::int32_t>(std::floor(x)); };
    const std::int32_t last_row = index(high.y / spacing / kRowHeight) + 1;
    std::vector<Vec2> inside;
    std::vector<Side> near;
    for (std::int32_t row = index(low.y / spacing / kRowHeight); row <= last_row; ++row) {
        const double y = spacing * row * kRowHeight, shift = row % 2 == 0 ? 0 : 0.5;
        near.clear();
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
            if (std::min(a.y, b.y) <= y + reach && std::max(a.y, b.y) >= y - reach) near.push_back({a, b});
        }
        for (std::int32_t i = index(low.x / spacing) - 1; i <= index(high.x / spacing) + 1; ++i) {
            const auto r = static_cast<std::uint32_t>(row), c = static_cast<std::uint32_t>(i);
            const Vec2 q{spacing * (i + shift + kDisplacement * wobble(2 * seed, r, c)),
                         y + spacing * kDisplacement * wobble(2 * seed + 1, r, c)};
            if (depth_among(near, q) > kLeastDepth * spacing) inside.push_back(q);
        }
    }
    return inside;
}

// Marks the faces outside of the constrained polygon, reached without crossing it.
void mark_outside(const Triangulation& triangulation) {
    for (const auto face : triangulation.all_face_handles()) face->info() = false;
    std::vector<Triangulation::Face_handle> stack{triangulation.infinite_face()};
    stack.front()->info() = true;
    while (!stack.empty()) {
        const auto face = stack.back();
        stack.pop_back();
        for (int k = 0; k < 3; ++k) {
            const auto neighbour = face->neighbor(k);
            if (face->is_constrained(k) || neighbour->info()) continue;
            neighbour->info() = true;
            stack.push_back(neighbour);
        }
    }
}

}  // namespace

bool is_simple_polygon(const std::vector<Vec2>& polygon) {
    const std::vector<Kernel::Point_2> corners = to_cgal(polygon);
    return corners.size() >= 3 && CGAL::is_simple_2(corners.begin(), corners.end(), Kernel()) &&
           CGAL::orientation_2(corners.begin(), corners.end(), Kernel()) == CGAL::COUNTERCLOCKWISE;
}

std::optional<PlanarCap> cap_polygon(const std::vector<Vec2>& polygon, double edge, std::uint32_t seed) {
    if (!is_simple_polygon(polygon)) return std::nullopt;
    PlanarCap cap;
    cap.interior = lattice_inside(polygon, edge, seed);
    Triangulation triangulation;
    std::vector<Triangulation::Vertex_handle> ring;
    std::uint32_t number = 0;
    for (const auto& p : to_cgal(polygon)) {
        ring.push_back(triangulation.insert(p, ring.empty() ? nullptr : ring.back()->face()));
        ring.back()->info() = number++;
    }
    for (std::size_t i = 0; i < ring.size(); ++i) triangulation.insert_constraint(ring[i], ring[(i + 1) % ring.size()]);
    Triangulation::Face_handle hint = ring.front()->face();
    for (const Vec2& q : cap.interior) {
        const auto v = triangulation.insert({q.x, q.y}, hint);
        v->info() = number++;
        hint = v->face();
    }
    mark_outside(triangulation);
    for (const auto face : triangulation.finite_face_handles()) {
        if (face->info()) continue;
        Corners t{face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        cap.triangles.push_back(t);
    }
    std::sort(cap.triangles.begin(), cap.triangles.end());
    return cap;
}

double interpolate_inside(const std::vector<Vec2>& polygon, const std::vector<double>& values, Vec2 q) {
    const std::size_t n = polygon.size();
    const auto half_tangent = [&](std::size_t i) {  // of the angle under which q sees side i
        const Vec2 a = polygon[i] - q, b = polygon[(i + 1) % n] - q;
        return cross(a, b) / (norm(a) * norm(b) + dot(a, b));
    };
    double weighted = 0, weights = 0, before = half_tangent(n - 1);
    for (std::size_t i = 0; i < n; ++i) {
        const double after = half_tangent(i);
        const double weight = (before + after) / norm(polygon[i] - q);
        weighted += weight * values[i];
        weights += weight;
        before = after;
    }
    return weighted / weights;
}

}  // namespace lumenline
