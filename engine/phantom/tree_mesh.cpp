// Mesh of the tree. CGAL's Mesh_3 wants a volume with labels and its sharp edges: the circles of the
// openings, which it covers with protecting balls, so that they come out as edge loops. The facets in
// the planes of the openings are the caps. Points are set on every branch beforehand, since a thin
// branch that no ray has hit would be missed. Refinement stops at the wall: no criterion on cells.
// Mesh_3 finds the wall by bisection; Newton's method then moves vertices onto it to rounding.
#include "engine/phantom/tree.h"

#define CGAL_MESH_3_NO_DEPRECATED_SURFACE_INDEX
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_domain_with_polyline_features_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/make_mesh_3.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>

#include "engine/phantom/mesh_soup.h"

namespace lumenline {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Domain = CGAL::Mesh_domain_with_polyline_features_3<CGAL::Labeled_mesh_domain_3<Kernel>>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
using Point = Kernel::Point_3;
using std::numbers::pi;

constexpr int kFewestAround = 8;

Vec3 vector(const Point& p) { return {p.x(), p.y(), p.z()}; }
Point point(Vec3 p) { return {p.x, p.y, p.z}; }

/// The circle in which the plane of an open end cuts the wall.
struct Rim {
    Vec3 centre, outward;
    double radius = 0;
};

std::vector<Rim> rims_of(const TreeTruth& truth) {
    std::vector<Rim> rims;
    for (const TreeBranch& b : truth.branches()) {
        const double slope = (b.start_radius - b.end_radius) / b.length();
        const double widening = 1 / std::sqrt(1 - slope * slope);  // of a ball to its cone
        if (b.open_start) rims.push_back({b.start, -b.direction(), widening * b.start_radius});
        if (b.open_end) rims.push_back({b.end, b.direction(), widening * b.end_radius});
    }
    return rims;
}

/// Edges are `share` of the local radius.
struct Sizing {
    using FT = double;
    const TreeTruth* truth;
    double share;
    double smallest;  // radius of the thinnest branch, for where there is none

    double operator()(const Point& p, int, const Domain::Index&) const {
        const double radius = truth->field(vector(p)).radius;
        return share * (radius > 0 ? radius : smallest);
    }
};

class Mesher {
public:
    Mesher(const TreeTruth& truth, const TreeOptions& options)
        : truth_(truth), rims_(rims_of(truth)), edge_(2 * pi / options.points_around), caps_(options.caps) {}

    void build() {
        const double thinnest =
            std::min_element(truth_.branches().begin(), truth_.branches().end(), [](const auto& a, const auto& b) {
                return a.end_radius < b.end_radius;
            })->end_radius;
        Domain domain = make_domain(thinnest);
        const Criteria criteria(CGAL::parameters::edge_size = Sizing{&truth_, edge_, thinnest},
                                CGAL::parameters::facet_angle = 25,
                                CGAL::parameters::facet_size = Sizing{&truth_, kBoundShare * edge_, thinnest});
        Complex complex;
        CGAL::Mesh_3::internal::init_c3t3_with_features(complex, domain, criteria);
        seed_branches(complex, domain);
        CGAL::refine_mesh_3(complex, domain, criteria, CGAL::parameters::no_perturb(), CGAL::parameters::no_exude(),
                            CGAL::parameters::manifold());
        collect(complex);
    }

    std::vector<Vec3> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;

private:
    // Bound on circumradii by the edge wanted: refinement then leaves edges of that mean length, as measured.
    static constexpr double kBoundShare = 0.7;

    [[nodiscard]] Domain make_domain(double thinnest) const {
        Vec3 low = truth_.branches().front().start, high = low;
        for (const TreeBranch& b : truth_.branches())
            for (int axis = 0; axis < 3; ++axis) {
                low[axis] = std::min({low[axis], b.start[axis], b.end[axis]});
                high[axis] = std::max({high[axis], b.start[axis], b.end[axis]});
            }
        const double reach = 0.5 * distance(low, high) + 4 * truth_.branches().front().start_radius;
        const TreeTruth* truth = &truth_;
        Domain domain = Domain::create_implicit_mesh_domain(
            [truth](const Point& p) { return truth->inside(vector(p)) ? -1.0 : 1.0; },
            Kernel::Sphere_3(point(lerp(low, high, 0.5)), reach * reach),
            CGAL::parameters::relative_error_bound = 1e-4 * thinnest / reach);
        std::vector<std::vector<Point>> circles;
        for (const Rim& rim : rims_) {
            constexpr int kPieces = 720;
            const Vec3 u = any_perpendicular(rim.outward), v = cross(rim.outward, u);
            std::vector<Point>& circle = circles.emplace_back();
            for (int k = 0; k < kPieces; ++k) {
                const double angle = 2 * pi * k / kPieces;
                circle.push_back(point(rim.centre + rim.radius * (std::cos(angle) * u + std::sin(angle) * v)));
            }
            circle.push_back(circle.front());
        }
        domain.add_features(circles.begin(), circles.end());
        return domain;
    }

    /// A few vertices around the clear part of every branch.
    void seed_branches(Complex& complex, const Domain& domain) const {
        constexpr int kAround = 6;
        const auto weighted = complex.triangulation().geom_traits().construct_weighted_point_3_object();
        for (const TreeBranch& b : truth_.branches()) {
            const Vec3 e = b.direction(), u = any_perpendicular(e), v = cross(e, u);
            int row = 0;
            for (double s = b.clear_from + b.radius(b.clear_from); s < b.clear_to - b.radius(b.clear_to);
                 s += b.radius(s), ++row)
                for (int k = 0; k < kAround; ++k) {
                    const double angle = 2 * pi * (k + 0.5 * (row % 2)) / kAround;
                    const Vec3 x = b.position(s) + b.radius(s) * (std::cos(angle) * u + std::sin(angle) * v);
                    const auto vertex = complex.triangulation().insert(weighted(point(truth_.projected(x))));
                    if (vertex == Complex::Vertex_handle()) continue;
                    complex.set_dimension(vertex, 2);
                    complex.set_index(vertex, domain.index_from_surface_patch_index({0, 1}));
                }
        }
    }

    /// Rim on whose plane, within its disk, all three points lie; else the number of rims.
    [[nodiscard]] std::size_t cap_of(const std::array<Vec3, 3>& corners) const {
        return static_cast<std::size_t>(
            std::find_if(rims_.begin(), rims_.end(),
                         [&](const Rim& rim) {
                             return std::all_of(corners.begin(), corners.end(), [&](Vec3 x) {
                                 return std::fabs(dot(x - rim.centre, rim.outward)) < 0.01 * edge_ * rim.radius &&
                                        distance(x, rim.centre) < 1.01 * rim.radius;
                             });
                         }) -
            rims_.begin());
    }

    void collect(const Complex& complex) {
        std::map<Complex::Vertex_handle, std::uint32_t> number;
        for (auto facet = complex.facets_in_complex_begin(); facet != complex.facets_in_complex_end(); ++facet) {
            auto [cell, opposite] = *facet;
            if (complex.is_in_complex(cell)) std::tie(cell, opposite) = complex.triangulation().mirror_facet(*facet);
            std::array<Complex::Vertex_handle, 3> corners;
            for (int k = 0; k < 3; ++k)
                corners[static_cast<std::size_t>(k)] =
                    cell->vertex(CGAL::Triangulation_utils_3::vertex_triple_index(opposite, k));
            const std::size_t cap = cap_of({vector(corners[0]->point().point()), vector(corners[1]->point().point()),
                                            vector(corners[2]->point().point())});
            if (cap < rims_.size() && !caps_) continue;
            std::array<std::uint32_t, 3> triangle{};
            for (std::size_t k = 0; k < 3; ++k) {
                const auto [entry, added] = number.emplace(corners[k], static_cast<std::uint32_t>(points.size()));
                if (added) points.push_back(settled(corners[k], cap));
                triangle[k] = entry->second;
            }
            triangles.push_back(triangle);
        }
    }

    /// Where a vertex belongs: on a rim, in a cap's plane, or on the wall.
    [[nodiscard]] Vec3 settled(Complex::Vertex_handle vertex, std::size_t cap) const {
        const Vec3 x = vector(vertex->point().point());
        if (vertex->in_dimension() < 2) {
            const Rim& rim = *std::min_element(rims_.begin(), rims_.end(), [&](const Rim& a, const Rim& b) {
                return distance(x, a.centre) < distance(x, b.centre);
            });
            const Vec3 aside = x - rim.centre - dot(x - rim.centre, rim.outward) * rim.outward;
            return rim.centre + rim.radius * normalized(aside);
        }
        if (cap < rims_.size()) return x - dot(x - rims_[cap].centre, rims_[cap].outward) * rims_[cap].outward;
        return truth_.projected(x);
    }

    const TreeTruth& truth_;
    std::vector<Rim> rims_;
    double edge_;
    bool caps_;
};

}  // namespace

TreePhantom make_tree(const TreeOptions& options) {
    if (options.points_around < kFewestAround) {
        throw std::invalid_argument("impossible tree: points around are " + std::to_string(options.points_around) +
                                    ", must be at least " + std::to_string(kFewestAround));
    }
    TreePhantom tree{{}, {}, TreeTruth(options)};
    TreeOptions unplaced = options;
    unplaced.scale = 1;
    unplaced.offset = {};
    const TreeTruth truth(unplaced);
    Mesher mesher(truth, unplaced);
    mesher.build();
    tree.points = std::move(mesher.points);
    for (Vec3& p : tree.points) p = options.offset + options.scale * p;
    tree.triangles = std::move(mesher.triangles);
    return tree;
}

TriangleSoup to_soup(const TreePhantom& tree) { return mesh_soup(tree.points, tree.triangles, 0x1p-53); }

}  // namespace lumenline
