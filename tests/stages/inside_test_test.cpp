// CGAL's Side_of_triangle_mesh as the second opinion; cubes on a grid, whose rays run through
// vertices and edges, as the hard case with a known answer.
#include "engine/geometry/inside_test.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "tests/stages/support.h"

namespace lumenline {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Triangle = std::array<SiteId, 3>;

struct Body {
    std::vector<Vec3> points;
    std::vector<Triangle> triangles;
};

Mesh to_cgal(const Body& body) {
    Mesh mesh;
    for (const Vec3& p : body.points) mesh.add_vertex({p.x, p.y, p.z});
    for (const Triangle& t : body.triangles)
        mesh.add_face(Mesh::Vertex_index(t[0].value), Mesh::Vertex_index(t[1].value), Mesh::Vertex_index(t[2].value));
    return mesh;
}

Body torus_body(double scale = 1, Vec3 offset = {}) {
    PhantomOptions options;
    options.kind = PhantomKind::kTorus;
    options.points_around = 24;
    options.jitter = 0.2;
    options.caps = true;
    options.rotate = true;
    options.scale = scale;
    options.offset = offset;
    const Surface surface = test::closed_surface(make_phantom(options));
    return {surface.points, surface.triangles};
}

/// The cube [low, low + 1]^3 with n x n squares of two triangles a side, outward.
Body cube(Vec3 low, int n) {
    Body body;
    std::map<std::tuple<int, int, int>, std::size_t> number;
    const auto vertex = [&](std::array<int, 3> g) {
        const auto [place, is_new] = number.try_emplace({g[0], g[1], g[2]}, body.points.size());
        if (is_new) body.points.push_back(low + Vec3{g[0] / double(n), g[1] / double(n), g[2] / double(n)});
        return SiteId(place->second);
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {0, n})
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const auto corner = [&](int di, int dj) {
                        std::array<int, 3> g{};
                        g[static_cast<std::size_t>(axis)] = side;
                        g[static_cast<std::size_t>((axis + 1) % 3)] = i + di;
                        g[static_cast<std::size_t>((axis + 2) % 3)] = j + dj;
                        return vertex(g);
                    };
                    Triangle s{corner(0, 0), corner(1, 0), corner(1, 1)}, t{corner(0, 0), corner(1, 1), corner(0, 1)};
                    if (side == 0) {
                        std::swap(s[1], s[2]);
                        std::swap(t[1], t[2]);
                    }
                    body.triangles.push_back(s);
                    body.triangles.push_back(t);
                }
    return body;
}

Body together(const Body& a, const Body& b) {
    Body both = a;
    both.points.insert(both.points.end(), b.points.begin(), b.points.end());
    for (Triangle t : b.triangles) {
        for (SiteId& s : t) s = SiteId(at(s) + a.points.size());
        both.triangles.push_back(t);
    }
    return both;
}

std::pair<Vec3, Vec3> bounds(const Body& body) {
    Vec3 low = body.points[0], high = low;
    for (const Vec3& p : body.points)
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    return {low, high};
}

void expect_agreement_with_cgal(const Body& body, int count, std::uint64_t seed) {
    const Mesh mesh = to_cgal(body);
    const CGAL::Side_of_triangle_mesh<Mesh, Kernel> side(mesh);
    const InsideTest test(body.points, body.triangles);
    const auto [low, high] = bounds(body);
    const Vec3 margin = 0.1 * (high - low);
    test::Random random(seed);
    int inside = 0;
    for (int i = 0; i < count; ++i) {
        const Vec3 p = random.in_box(low - margin, high + margin);
        const auto verdict = side({p.x, p.y, p.z});
        if (verdict == CGAL::ON_BOUNDARY) continue;
        ASSERT_EQ(test.inside(p), verdict == CGAL::ON_BOUNDED_SIDE) << p.x << " " << p.y << " " << p.z;
        if (i % 16 == 0) {
            ASSERT_EQ(inside_surface(body.points, body.triangles, p), test.inside(p));
        }
        inside += verdict == CGAL::ON_BOUNDED_SIDE;
    }
    EXPECT_GT(inside, count / 100);
}

TEST(InsideTest, AgreesWithCgalOnATorusArc) { expect_agreement_with_cgal(torus_body(), 20000, 11); }

TEST(InsideTest, AgreesWithCgalOnASmallTorusArcFarAway) {
    expect_agreement_with_cgal(torus_body(1e-3, {20, -30, 50}), 5000, 12);
}

TEST(InsideTest, AgreesWithCgalOnATetrahedron) {
    const Body body{{{0, 0, 0}, {1, 0.1, 0}, {0.2, 1.3, 0.1}, {0.3, 0.2, 0.9}},
                    {{SiteId(0), SiteId(2), SiteId(1)},
                     {SiteId(0), SiteId(1), SiteId(3)},
                     {SiteId(1), SiteId(2), SiteId(3)},
                     {SiteId(2), SiteId(0), SiteId(3)}}};
    expect_agreement_with_cgal(body, 20000, 13);
}

TEST(InsideTest, RaysThroughVerticesAndEdgesOfAGridAreCountedOnce) {
    constexpr int kSquares = 4;
    const Body body = cube({0, 0, 0}, kSquares);
    const InsideTest test(body.points, body.triangles);
    // Eighths: every second one is a vertex or an edge of each face, and all lie on diagonals or edges.
    for (int i = -2; i <= 10; ++i)
        for (int j = -2; j <= 10; ++j)
            for (int k = -2; k <= 10; ++k) {
                const auto on_face = [](int n) { return n == 0 || n == 8; };
                const auto within = [](int n) { return n > 0 && n < 8; };
                const bool in_closed = i >= 0 && i <= 8 && j >= 0 && j <= 8 && k >= 0 && k <= 8;
                if (in_closed && (on_face(i) || on_face(j) || on_face(k))) continue;  // on the surface: either way
                for (const bool inside : {test.inside({i / 8.0, j / 8.0, k / 8.0}),
                                          inside_surface(body.points, body.triangles, {i / 8.0, j / 8.0, k / 8.0})})
                    EXPECT_EQ(inside, within(i) && within(j) && within(k)) << i << " " << j << " " << k;
            }
}

TEST(InsideTest, SidesOfEveryThinnestAxisAreCorrect) {
    // The ray follows the axis in which the body is thinnest: make each axis that one in turn.
    for (int axis = 0; axis < 3; ++axis) {
        Body body = cube({0, 0, 0}, 3);
        for (Vec3& p : body.points) p[axis] *= 0.25;
        const InsideTest test(body.points, body.triangles);
        for (int i = 0; i <= 6; ++i)
            for (int j = 0; j <= 6; ++j) {
                Vec3 p;
                p[(axis + 1) % 3] = (i + 0.5) / 6 - 1.0 / 12;
                p[(axis + 2) % 3] = (j + 0.5) / 6 - 1.0 / 12;
                const bool beside = i == 0 || i == 6 || j == 0 || j == 6;  // on the faces of the other axes
                if (beside) continue;
                for (const double h : {-0.01, 0.01, 0.125, 0.24, 0.26}) {
                    p[axis] = h;
                    EXPECT_EQ(test.inside(p), h > 0 && h < 0.25) << "axis " << axis << " height " << h;
                }
            }
    }
}

TEST(InsideTest, PointsBesideASurfacePointAreTold) {
    // A distance of a few roundings from a face: the predicates are exact.
    const Body body = torus_body();
    const InsideTest test(body.points, body.triangles);
    for (std::size_t i = 0; i < body.triangles.size(); i += 7) {
        const Triangle& t = body.triangles[i];
        const Vec3 a = body.points[at(t[0])], b = body.points[at(t[1])], c = body.points[at(t[2])];
        const Vec3 n = normalized(cross(b - a, c - a)), middle = 1.0 / 3 * (a + b + c);
        EXPECT_TRUE(test.inside(middle - 1e-12 * n));  // coordinates of about 30 have a spacing of 4e-15
        EXPECT_FALSE(test.inside(middle + 1e-12 * n));
    }
}

TEST(InsideTest, PointsOutsideTheBoxOrNotFiniteAreOutside) {
    const Body body = cube({0, 0, 0}, 2);
    const InsideTest test(body.points, body.triangles);
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double nan = std::nan("");
    for (int axis = 0; axis < 3; ++axis)
        for (const double far : {-1e300, -0.5, 1.5, 1e300, kInfinity, -kInfinity, nan}) {
            Vec3 p{0.5, 0.5, 0.5};
            p[axis] = far;
            EXPECT_FALSE(test.inside(p)) << "axis " << axis << ": " << far;
        }
    EXPECT_TRUE(test.inside({0.5, 0.5, 0.5}));
}

TEST(InsideTest, OverlappingBodiesAreTheirUnion) {
    const Body body = together(cube({0, 0, 0}, 3), cube({0.5, 0.25, 0.125}, 4));
    const InsideTest test(body.points, body.triangles);
    EXPECT_TRUE(test.inside({0.1, 0.1, 0.1}));
    EXPECT_TRUE(test.inside({0.75, 0.5, 0.5})) << "in both";
    EXPECT_TRUE(test.inside({1.4, 1.2, 1.1}));
    EXPECT_FALSE(test.inside({1.4, 0.1, 0.1}));
    EXPECT_FALSE(test.inside({0.1, 1.2, 1.1}));
    test::Random random(14);
    for (int i = 0; i < 5000; ++i) {
        const Vec3 p = random.in_box({-0.2, -0.2, -0.2}, {1.7, 1.5, 1.3});
        const auto in_cube = [&p](Vec3 low) {
            const Vec3 q = p - low;
            return q.x > 0 && q.x < 1 && q.y > 0 && q.y < 1 && q.z > 0 && q.z < 1;
        };
        EXPECT_EQ(test.inside(p), in_cube({0, 0, 0}) || in_cube({0.5, 0.25, 0.125}));
    }
}

TEST(InsideTest, ReversedBodyHasNoInside) {
    Body body = cube({0, 0, 0}, 2);
    for (Triangle& t : body.triangles) std::swap(t[0], t[1]);
    const InsideTest test(body.points, body.triangles);
    EXPECT_FALSE(test.inside({0.5, 0.5, 0.5}));
    EXPECT_FALSE(test.inside({2, 0.5, 0.5}));
}

TEST(InsideTest, VerdictsDoNotDependOnScaleOrPlace) {
    const Body body = torus_body();
    const InsideTest test(body.points, body.triangles);
    const auto [low, high] = bounds(body);
    for (const double scale : {0x1p-40, 0x1p30})  // powers of two: the very same body
        for (const Vec3 offset : {Vec3{}, Vec3{1000, -2000, 500}}) {
            Body moved = body;
            for (Vec3& p : moved.points) p = scale * (p + offset);
            const InsideTest moved_test(moved.points, moved.triangles);
            test::Random random(15);
            for (int i = 0; i < 3000; ++i) {
                const Vec3 p = random.in_box(low, high);
                // The move rounds by 2e-13: no random point is that close to the wall.
                EXPECT_EQ(moved_test.inside(scale * (p + offset)), test.inside(p));
            }
        }
}

}  // namespace
}  // namespace lumenline
