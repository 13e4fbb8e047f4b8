#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "engine/phantom/phantom.h"
#include "engine/phantom/section.h"
#include "tests/phantom/shapes.h"

namespace lumenline {
namespace {

using std::numbers::pi;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

struct Topology {
    bool manifold = true;  // no directed edge twice
    std::size_t boundary_edges = 0;
    std::size_t boundary_loops = 0;
    long euler = 0;
    bool all_points_used = true;
};

Topology topology_of(const Phantom& phantom) {
    Topology topology;
    std::map<Edge, int> directed;
    std::vector<char> used(phantom.points.size(), 0);
    for (const auto& t : phantom.triangles) {
        for (int k = 0; k < 3; ++k) {
            used[t[k]] = 1;
            if (++directed[{t[k], t[(k + 1) % 3]}] > 1 || t[k] == t[(k + 1) % 3]) topology.manifold = false;
        }
    }
    std::map<std::uint32_t, std::uint32_t> next;
    std::size_t edges = 0;
    for (const auto& [edge, count] : directed) {
        const bool twin = directed.contains({edge.second, edge.first});
        if (!twin || edge.first < edge.second) ++edges;
        if (twin) continue;
        ++topology.boundary_edges;
        if (!next.emplace(edge.first, edge.second).second) topology.manifold = false;
    }
    while (!next.empty()) {
        ++topology.boundary_loops;
        for (auto at = next.begin(); at != next.end();) {
            const std::uint32_t to = at->second;
            next.erase(at);
            at = next.find(to);
        }
    }
    topology.euler = static_cast<long>(phantom.points.size() + phantom.triangles.size()) - static_cast<long>(edges);
    topology.all_points_used = std::all_of(used.begin(), used.end(), [](char u) { return u != 0; });
    return topology;
}

Vec3 area_vector(const Phantom& p, std::size_t triangle) {
    const auto& t = p.triangles[triangle];
    return 0.5 * cross(p.points[t[1]] - p.points[t[0]], p.points[t[2]] - p.points[t[0]]);
}

double area_of(const Phantom& p) {
    double area = 0;
    for (std::size_t t = 0; t < p.triangles.size(); ++t) area += norm(area_vector(p, t));
    return area;
}

double volume_of(const Phantom& p) {
    double volume = 0;
    for (std::size_t t = 0; t < p.triangles.size(); ++t) {
        volume += dot(p.points[p.triangles[t][0]] - p.points[0], area_vector(p, t)) / 3;
    }
    return volume;
}

// Of the analytic wall at a point on it.
Vec3 wall_normal(const PhantomTruth& truth, Vec3 x) {
    const double s = truth.abscissa_of(x);
    const AxisFrame f = truth.frame(s);
    const double cosine = dot(x - f.origin, f.e1) / distance(f.origin, truth.wall_point(s, 0).point);
    const double sine = dot(x - f.origin, f.e2) / distance(f.origin, truth.wall_point(s, pi / 2).point);
    return truth.wall_point(s, std::atan2(sine, cosine)).normal;
}

// Wall triangles that do not face the way the analytic wall does at their corners.
std::size_t folded_triangles(const Phantom& p) {
    std::vector<Vec3> normals;
    for (const Vec3& x : p.points) normals.push_back(wall_normal(p.truth, x));
    std::size_t folded = 0;
    for (std::size_t t = 0; t < p.triangles.size(); ++t) {
        Vec3 outward;
        for (const std::uint32_t v : p.triangles[t]) outward += normals[v];
        if (!(dot(area_vector(p, t), outward) > 0)) ++folded;
    }
    return folded;
}

TEST(PhantomMesh, EveryVertexLiesOnTheAnalyticWall) {
    for (auto [name, options] : test_shapes()) {
        for (const double jitter : {0.0, 0.2}) {
            options.jitter = jitter;
            const Phantom p = make_phantom(options);
            // Rounding of coordinates of the size of the extent, through a few operations.
            const double tolerance = 1e-12 * extent_of(p);
            for (const Vec3& x : p.points) ASSERT_NEAR(p.truth.signed_distance(x), 0, tolerance) << name;
        }
    }
}

TEST(PhantomMesh, OpenTubeIsAManifoldWithTwoLoops) {
    for (auto [name, options] : test_shapes()) {
        options.jitter = 0.2;
        const Phantom p = make_phantom(options);
        const Topology topology = topology_of(p);
        EXPECT_TRUE(topology.manifold) << name;
        EXPECT_TRUE(topology.all_points_used) << name;
        EXPECT_EQ(topology.boundary_loops, 2U) << name;
        EXPECT_EQ(topology.boundary_edges, 80U) << name;
        EXPECT_EQ(topology.euler, 0) << name;
    }
}

TEST(PhantomMesh, CappedTubeIsClosedAndASphere) {
    for (auto [name, options] : test_shapes()) {
        options.caps = true;
        const bool bent = options.kind != PhantomKind::kCylinder;
        for (const int around : {bent ? 8 : 3, 7, 40}) {
            options.points_around = around;
            options.jitter = around == 40 ? 0.2 : 0.0;
            const Topology topology = topology_of(make_phantom(options));
            EXPECT_TRUE(topology.manifold) << name;
            EXPECT_TRUE(topology.all_points_used) << name;
            EXPECT_EQ(topology.boundary_edges, 0U) << name;
            EXPECT_EQ(topology.euler, 2) << name;
        }
    }
}

TEST(PhantomMesh, TopologyCheckSeesAMissingTriangleAndAFlippedOne) {
    PhantomOptions options;
    options.caps = true;
    Phantom p = make_phantom(options);
    Phantom holed = p;
    holed.triangles.pop_back();
    EXPECT_EQ(topology_of(holed).boundary_edges, 3U);
    EXPECT_NE(topology_of(holed).euler, 2);
    std::swap(p.triangles[17][0], p.triangles[17][1]);
    EXPECT_FALSE(topology_of(p).manifold);
    p = make_phantom(PhantomOptions{});
    std::swap(p.triangles[17][0], p.triangles[17][1]);
    EXPECT_EQ(folded_triangles(p), 1U);
}

TEST(PhantomMesh, CapsLieInTheEndPlanesWithTrianglesOfTheWallsSize) {
    for (const PhantomKind kind : {PhantomKind::kCylinder, PhantomKind::kTorus, PhantomKind::kHelix}) {
        PhantomOptions options = shape_of(kind);
        const std::size_t wall_points = make_phantom(options).points.size();
        options.caps = true;
        const Phantom p = make_phantom(options);
        ASSERT_GT(p.points.size(), wall_points);
        const double length = p.truth.total_length();
        std::size_t on_start = 0;
        for (std::size_t i = wall_points; i < p.points.size(); ++i) {
            const bool at_start =
                distance(p.points[i], p.truth.position(0)) < distance(p.points[i], p.truth.position(length));
            const AxisFrame f = p.truth.frame(at_start ? 0 : length);
            EXPECT_NEAR(dot(p.points[i] - f.origin, f.tangent), 0, 1e-12 * extent_of(p));
            on_start += at_start ? 1 : 0;
        }
        EXPECT_EQ(2 * on_start, p.points.size() - wall_points);
        for (std::size_t i = 0; i < p.triangles.size(); ++i) {
            const auto& t = p.triangles[i];
            // Diagonals of the zipped quads and the fan in the middle reach above one edge.
            for (int k = 0; k < 3; ++k)
                EXPECT_LT(distance(p.points[t[k]], p.points[t[(k + 1) % 3]]), 1.6 * p.edge_length);
        }
    }
}

TEST(PhantomMesh, EveryWallTriangleFacesOutward) {
    for (auto [name, options] : test_shapes()) {
        for (const double jitter : {0.0, 0.1, 0.2}) {
            for (std::uint64_t seed = 1; seed <= 3; ++seed) {
                options.jitter = jitter;
                options.seed = seed;
                EXPECT_EQ(folded_triangles(make_phantom(options)), 0U) << name << " jitter " << jitter;
            }
        }
    }
}

TEST(PhantomMesh, MeshThatFoldsIsRejectedElseNoTriangleFacesInward) {
    int folded = 0, accepted = 0;
    PhantomOptions options;
    options.jitter = 0.4;
    options.length = 100;
    for (options.seed = 1; options.seed <= 60; ++options.seed) {
        try {
            EXPECT_EQ(folded_triangles(make_phantom(options)), 0U);
            ++accepted;
        } catch (const std::invalid_argument& error) {
            EXPECT_NE(std::string(error.what()).find("folds near"), std::string::npos) << error.what();
            ++folded;
        }
    }
    EXPECT_GT(accepted, 0);
    EXPECT_GT(folded, 0);
}

TEST(PhantomMesh, CapTrianglesFaceOutward) {
    for (const double jitter : {0.0, 0.2}) {
        for (const double b : {5.0, 2.0}) {
            for (std::uint64_t seed = 1; seed <= 5; ++seed) {
                PhantomOptions options;
                options.b = b;
                options.jitter = jitter;
                options.seed = seed;
                const std::size_t wall = make_phantom(options).triangles.size();
                options.caps = true;
                const Phantom p = make_phantom(options);
                for (std::size_t t = wall; t < p.triangles.size(); ++t) {
                    const Vec3 area = area_vector(p, t);
                    const double out = p.points[p.triangles[t][0]].z > 25 ? 1 : -1;
                    ASSERT_GT(out * area.z, 0) << "b " << b << " jitter " << jitter << " seed " << seed;
                }
            }
        }
    }
}

double wall_area(const PhantomOptions& o) {
    const double length = PhantomTruth(o).total_length();
    if (o.kind != PhantomKind::kStenosis) return EllipseArc(o.a, o.b).perimeter() * length;
    double area = 0;
    constexpr int kSlices = 20000;
    for (int i = 0; i < kSlices; ++i) {
        const double q = ((i + 0.5) / kSlices - 0.5) * o.length / o.stenosis_width;
        const double bump = o.a * o.severity * std::exp(-q * q);
        area += 2 * pi * (o.a - bump) * std::hypot(1, 2 * q * bump / o.stenosis_width) * o.length / kSlices;
    }
    return area;
}

double lumen_volume(const PhantomOptions& o) {
    if (o.kind != PhantomKind::kStenosis) return pi * o.a * o.b * PhantomTruth(o).total_length();
    const double root = std::sqrt(pi) * o.stenosis_width;  // integral of the bump over the whole line
    const double x = 0.5 * o.length / o.stenosis_width;
    return pi * o.a * o.a *
           (o.length - 2 * o.severity * root * std::erf(x) +
            o.severity * o.severity * root / std::sqrt(2) * std::erf(x * std::sqrt(2)));
}

TEST(PhantomMesh, AreaAndVolumeConvergeAtSecondOrder) {
    for (auto [name, options] : test_shapes()) {
        options.scale = 1;
        options.offset = {};
        std::vector<double> area_error;
        std::vector<double> volume_error;
        for (const int around : {40, 80, 160}) {
            options.points_around = around;
            options.caps = false;
            area_error.push_back(std::fabs(area_of(make_phantom(options)) / wall_area(options) - 1));
            options.caps = true;
            volume_error.push_back(std::fabs(volume_of(make_phantom(options)) / lumen_volume(options) - 1));
        }
        // Halving the edge divides the error by four, up to terms of higher order and the rounding
        // of the number of rows.
        for (const std::size_t i : {0U, 1U}) {
            EXPECT_NEAR(std::log2(area_error[i] / area_error[i + 1]), 2, 0.35) << name;
            EXPECT_NEAR(std::log2(volume_error[i] / volume_error[i + 1]), 2, 0.35) << name;
        }
        EXPECT_LT(volume_error[2], 1e-3) << name;
    }
}

TEST(PhantomMesh, RingsAreEquispacedAndStaggered) {
    PhantomOptions options;
    options.b = 3;
    const Phantom p = make_phantom(options);
    const EllipseArc arc(5, 3);
    EXPECT_NEAR(arc.perimeter(), 4 * 5 * std::comp_ellint_2(0.8), 1e-12 * arc.perimeter());
    EXPECT_NEAR(p.edge_length, arc.perimeter() / 40, 1e-14 * arc.perimeter());
    for (const double u : {0.0, 0.1, 0.25, 0.5, 0.77}) {
        // Arc from t = 0, by the incomplete integral from the other axis.
        const double arc_length = 5 * (std::comp_ellint_2(0.8) - std::ellint_2(0.8, pi / 2 - arc.parameter(u)));
        EXPECT_NEAR(arc_length, u * arc.perimeter(), 1e-11 * arc.perimeter());
    }
    const double spacing = p.points[40].z - p.points[0].z;
    EXPECT_NEAR(spacing / (p.edge_length * std::sqrt(0.75)), 1, 0.5 / 60);
    EXPECT_NEAR(p.points.back().z, 50, 1e-13 * 50);
    EXPECT_EQ(p.points[0].y, 0);
    EXPECT_NEAR(distance(p.points[0], p.points[40]), distance(p.points[1], p.points[40]), 0.01 * p.edge_length);
}

void expect_rejected(const PhantomOptions& options, const std::string& part) {
    try {
        make_phantom(options);
        ADD_FAILURE() << "accepted, expected: " << part;
    } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

TEST(PhantomMesh, ImpossibleMeshesAreRejectedWithTheReason) {
    const auto with = [](auto change) {
        PhantomOptions options;
        change(options);
        return options;
    };
    expect_rejected(with([](auto& o) { o.points_around = 2; }), "points around is 2");
    expect_rejected(with([](auto& o) { o.points_around = 2000000000; }), "32-bit");
    expect_rejected(with([](auto& o) { o.jitter = -0.1; }), "jitter");
    expect_rejected(with([](auto& o) { o.jitter = 0.41; }), "jitter");
    expect_rejected(with([](auto& o) { o.jitter = std::nan(""); }), "jitter");
    expect_rejected(with([](auto& o) { o.noise = -1; }), "noise");
    expect_rejected(with([](auto& o) { o.noise = 0.6; }), "noise");
    expect_rejected(with([](auto& o) { o.noise = 0.5, o.points_around = 6; }), "walls touch");
    expect_rejected(with([](auto& o) {
                        o.kind = PhantomKind::kHairpin;
                        o.bend_radius = 5.01;
                        o.noise = 0.1;
                    }),
                    "walls touch");
    // Two rows and a half become two, 0.75 of their usual distance apart.
    expect_rejected(with([](auto& o) { o.jitter = 0.4, o.length = 1.04; }), "rows of vertices meet");
}

}  // namespace
}  // namespace lumenline
