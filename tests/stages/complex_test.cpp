// Complexes of jittered, structured and real surfaces against their definition, and on jittered ones
// polygon by polygon against a second construction. Every check is then seen to fail on a damaged
// complex.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "engine/condition/condition.h"
#include "engine/voronoi/voronoi.h"
#include "io/mesh/mesh_io.h"
#include "tests/stages/complex_checks.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

// Centres of flat cells keep eight digits in double precision (see circumcentre.h); coincident ones
// are merged within 1e-9.
constexpr double kTolerance = 1e-7;

PhantomOptions options_of(PhantomKind kind, double jitter, int points_around = 16) {
    PhantomOptions options;
    options.kind = kind;
    options.points_around = points_around;
    options.jitter = jitter;
    options.length = 25;
    options.arc = 2;
    options.leg_length = 10;
    options.bend_radius = kind == PhantomKind::kHairpin ? 8 : 20;
    options.caps = true;
    options.rotate = true;
    return options;
}

/// So few points around that many polygons lack a vertex inside: bare edges hold the axis together.
PhantomOptions thin_tube(double jitter) { return options_of(PhantomKind::kCylinder, jitter, 3); }

std::vector<PhantomOptions> shapes(double jitter) {
    std::vector<PhantomOptions> all;
    for (const PhantomKind kind : {PhantomKind::kCylinder, PhantomKind::kTorus, PhantomKind::kHelix,
                                   PhantomKind::kStenosis, PhantomKind::kHairpin})
        all.push_back(options_of(kind, jitter));
    all.push_back(options_of(PhantomKind::kCylinder, jitter));
    all.back().b = 3;
    all.push_back(thin_tube(jitter));
    return all;
}

std::string name_of(const PhantomOptions& options) {
    return std::string(phantom_name(options.kind)) + " b " + std::to_string(options.b) + ", " +
           std::to_string(options.points_around) + " around";
}

void expect_sound(const Surface& surface, const VoronoiComplex& complex, double tolerance, std::size_t stride = 1) {
    EXPECT_EQ(test::check_incidence(surface, complex), "");
    EXPECT_EQ(test::check_polygons(surface, complex, tolerance), "");
    EXPECT_EQ(test::check_balls(surface, complex, tolerance, stride), "");
    EXPECT_EQ(test::check_poles(surface, complex, tolerance), "");
    EXPECT_EQ(test::check_inside(surface, complex), "");
    EXPECT_EQ(test::check_edges(surface, complex), "");
}

TEST(Voronoi, JitteredPhantomsFitTheDefinition) {
    for (const PhantomOptions& options : shapes(0.2)) {
        SCOPED_TRACE(name_of(options));
        const Surface surface = test::closed_surface(make_phantom(options));
        expect_sound(surface, test::complex_of(surface), kTolerance);
    }
}

TEST(Voronoi, StructuredPhantomsFitTheDefinition) {
    for (const PhantomOptions& options : shapes(0)) {
        SCOPED_TRACE(name_of(options));
        const Surface surface = test::closed_surface(make_phantom(options));
        expect_sound(surface, test::complex_of(surface), kTolerance);
    }
}

TEST(Voronoi, PhantomsOfFloat32CoordinatesFitTheDefinition) {
    for (const double jitter : {0.0, 0.2})
        for (PhantomOptions options : shapes(jitter)) {
            options.float32 = true;
            SCOPED_TRACE(name_of(options));
            const Surface surface = test::closed_surface(make_phantom(options));
            expect_sound(surface, test::complex_of(surface), kTolerance);
        }
}

TEST(Voronoi, BallsTouchTheirSitesWhereFlatCellsOfSeveralCirclesHangTogether) {
    // Coordinates on a grid so coarse that many cells count as flat. If all that hang together took one centre, balls
    // would miss their sites by a fifth of an edge here, and by a whole radius on a coarse aorta in single precision.
    for (const unsigned seed : {1U, 2U, 4U}) {
        PhantomOptions options;
        options.kind = PhantomKind::kStenosis;
        options.points_around = 24;
        options.jitter = 0.2;
        options.seed = seed;
        StageContext context(Stage::kCondition);
        Surface surface = condition_surface(to_soup(make_phantom(options)), {}, context);
        surface.coordinate_rounding = 1e-5 * surface.diagonal;
        const double grid = 2 * surface.coordinate_rounding;
        for (Vec3& p : surface.points)
            for (int axis = 0; axis < 3; ++axis) p[axis] = grid * std::round(p[axis] / grid);
        const VoronoiComplex complex = test::complex_of(surface);
        double farthest = 0;
        for (std::size_t p = 0; p < complex.polygon_count(); ++p)
            for (const SiteId s : complex.polygon_sites[p])
                for (const VoronoiVertexId v : complex.polygon(PolygonId(p)))
                    if (!s.is_none())
                        farthest =
                            std::max(farthest, std::fabs(distance(complex.vertices[at(v)], surface.points[at(s)]) -
                                                         complex.ball_radius[at(v)]));
        EXPECT_LT(farthest, 0.1 * surface.median_edge);
    }
}

TEST(Voronoi, JitteredPhantomsAgreePolygonByPolygonWithASecondConstruction) {
    for (const PhantomOptions& options : shapes(0.2)) {
        SCOPED_TRACE(name_of(options));
        const Surface surface = test::closed_surface(make_phantom(options));
        const VoronoiComplex complex = test::complex_of(surface, 0);
        const test::ReferenceComplex reference = test::reference_complex(surface);
        EXPECT_EQ(test::compare_polygons(complex, reference, kTolerance), "");
        EXPECT_EQ(test::compare_poles(surface, complex, reference, kTolerance), "");
        EXPECT_FALSE(reference.polygons.empty());
    }
}

TEST(Voronoi, MergingDoesNotMovePolesOfStructuredPhantoms) {
    for (const PhantomOptions& options : shapes(0)) {
        SCOPED_TRACE(name_of(options));
        const Surface surface = test::closed_surface(make_phantom(options));
        const test::ReferenceComplex reference = test::reference_complex(surface);
        EXPECT_EQ(test::compare_poles(surface, test::complex_of(surface), reference, kTolerance), "");
    }
}

TEST(Voronoi, RealSurfacesFitTheDefinition) {
    std::vector<Surface> surfaces;
    const std::filesystem::path folder = LUMENLINE_SOURCE_DIR "/examples/liver";
    StageContext context(Stage::kCondition);
    if (std::filesystem::is_directory(folder))
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (entry.path().extension() == ".vtk")
                surfaces.push_back(condition_surface(read_surface(entry.path().string()), {}, context));
    if (surfaces.empty()) {  // a rough wall stands in
        PhantomOptions options = options_of(PhantomKind::kTorus, 0.2, 24);
        options.noise = 0.1;
        options.caps = false;
        surfaces.push_back(condition_surface(to_soup(make_phantom(options)), {}, context));
    }
    for (const Surface& surface : surfaces) {
        const VoronoiComplex complex = test::complex_of(surface);
        // Brute force over at most 2e8 pairs.
        const std::size_t stride = 1 + complex.vertex_count() * surface.site_count() / 200000000;
        expect_sound(surface, complex, kTolerance, stride);
    }
}

TEST(Voronoi, DuplicateSitesShareTheirPole) {
    Surface surface = test::closed_surface(make_phantom(options_of(PhantomKind::kTorus, 0.2)));
    const VoronoiComplex plain = test::complex_of(surface);
    const SiteId original = surface.triangles[100][0], copy(surface.site_count());
    surface.points.push_back(surface.points[at(original)]);
    surface.normals.push_back(surface.normals[at(original)]);
    surface.input_vertex.push_back(surface.input_vertex[at(original)]);
    surface.origin.push_back(SiteOrigin::kWall);
    surface.triangles[100][0] = copy;
    StageContext context(Stage::kVoronoi);
    const VoronoiComplex complex = build_voronoi(surface, {}, context);
    EXPECT_TRUE(test::has_finding(context.diagnostics(), "coincident_sites"));
    ASSERT_FALSE(complex.pole[at(original)].is_none());
    EXPECT_EQ(complex.pole[at(copy)], complex.pole[at(original)]);
    EXPECT_EQ(complex.vertex_count(), plain.vertex_count());
    EXPECT_EQ(complex.polygon_count(), plain.polygon_count());
    EXPECT_EQ(test::check_polygons(surface, complex, kTolerance), "");
}

TEST(Voronoi, FlatSurfaceIsRefused) {
    Surface surface = test::closed_surface(make_phantom(options_of(PhantomKind::kCylinder, 0)));
    for (Vec3& p : surface.points) p.z = 0;
    StageContext context(Stage::kVoronoi);
    try {
        build_voronoi(surface, {}, context);
        FAIL() << "a surface in a plane has no lumen";
    } catch (const StageError& error) {
        EXPECT_EQ(error.code(), ErrorCode::kNoLumen);
        EXPECT_EQ(error.stage(), Stage::kVoronoi);
    }
}

/// A sound complex to damage.
class DamagedComplex : public ::testing::Test {
protected:
    DamagedComplex()
        : phantom(make_phantom(options_of(PhantomKind::kTorus, 0.2))),
          surface(test::closed_surface(phantom)),
          complex(test::complex_of(surface, 0)),
          reference(test::reference_complex(surface)) {
        while (complex.polygon(PolygonId(polygon)).size() < 5) ++polygon;
        first = complex.polygon_offsets[polygon];
        vertex = at(complex.polygon_vertices[first]);
    }

    Phantom phantom;
    Surface surface;
    VoronoiComplex complex;
    test::ReferenceComplex reference;
    std::size_t polygon = 200;  ///< of five or more vertices
    std::size_t first = 0;      ///< position of its loop
    std::size_t vertex = 0;     ///< its first
};

TEST_F(DamagedComplex, IsSoundBefore) {
    expect_sound(surface, complex, kTolerance);
    EXPECT_EQ(test::compare_polygons(complex, reference, kTolerance), "");
    EXPECT_EQ(test::compare_poles(surface, complex, reference, kTolerance), "");
    EXPECT_EQ(test::count_components(complex), 1U);
}

TEST_F(DamagedComplex, MovedVertexIsNoticed) {
    complex.vertices[vertex] += 1e-5 * complex.ball_radius[vertex] * Vec3{0.6, 0, 0.8};
    EXPECT_NE(test::check_polygons(surface, complex, kTolerance), "");
    EXPECT_NE(test::compare_polygons(complex, reference, kTolerance), "");
}

TEST_F(DamagedComplex, VertexMovedOutOfThePlaneAloneIsNoticed) {
    // Away from the plane of the two sites, so that the convexity seen along the normal stays.
    const auto [s, t] = complex.polygon_sites[polygon];
    complex.vertices[vertex] +=
        1e-3 * complex.ball_radius[vertex] * normalized(surface.points[at(t)] - surface.points[at(s)]);
    EXPECT_NE(test::check_polygons(surface, complex, kTolerance), "");
}

TEST_F(DamagedComplex, LoopOutOfOrderIsNoticed) {
    std::swap(complex.polygon_vertices[first + 1], complex.polygon_vertices[first + 3]);
    EXPECT_EQ(test::check_incidence(surface, complex), "");
    EXPECT_NE(test::check_polygons(surface, complex, kTolerance).find("convex"), std::string::npos);
    EXPECT_NE(test::compare_polygons(complex, reference, kTolerance), "");
}

TEST_F(DamagedComplex, WrongRadiusIsNoticed) {
    complex.ball_radius[vertex] *= 1 + 1e-5;
    EXPECT_NE(test::check_polygons(surface, complex, kTolerance), "");
    EXPECT_NE(test::check_balls(surface, complex, kTolerance), "");
    complex.ball_radius[vertex] *= 1 - 2e-5;
    EXPECT_NE(test::check_balls(surface, complex, kTolerance), "");
}

TEST_F(DamagedComplex, WrongSiteOfAVertexIsNoticed) {
    complex.vertex_site[vertex] = SiteId((at(complex.vertex_site[vertex]) + 100) % surface.site_count());
    EXPECT_NE(test::check_balls(surface, complex, kTolerance), "");
}

TEST_F(DamagedComplex, VertexOutsideIsNoticed) {
    complex.vertices[vertex] = surface.points[0] + 0.01 * surface.median_edge * surface.normals[0];
    EXPECT_NE(test::check_inside(surface, complex), "");
}

TEST_F(DamagedComplex, EdgeThroughTheWallIsNoticed) {
    // The ends of a torus arc are inside, the straight way between them is not.
    VoronoiVertexId first_vertex(0), last(0);
    for (std::size_t v = 0; v < complex.vertex_count(); ++v) {
        const auto along = [&](VoronoiVertexId w) { return phantom.truth.abscissa_of(complex.vertices[at(w)]); };
        if (along(VoronoiVertexId(v)) < along(first_vertex)) first_vertex = VoronoiVertexId(v);
        if (along(VoronoiVertexId(v)) > along(last)) last = VoronoiVertexId(v);
    }
    complex.polygon_vertices[first] = first_vertex;
    complex.polygon_vertices[first + 1] = last;
    EXPECT_NE(test::check_edges(surface, complex), "");
}

TEST_F(DamagedComplex, WrongPoleIsNoticed) {
    // The nearest instead of the farthest vertex around some site.
    const SiteId site = complex.polygon_sites[polygon][0];
    for (const VoronoiVertexId v : complex.polygon(PolygonId(polygon)))
        if (complex.ball_radius[at(v)] < 0.99 * complex.ball_radius[at(complex.pole[at(site)])])
            complex.pole[at(site)] = v;
    EXPECT_NE(test::compare_poles(surface, complex, reference, kTolerance), "");
    complex.pole[at(site)] = VoronoiVertexId();
    EXPECT_NE(test::compare_poles(surface, complex, reference, kTolerance), "");
    EXPECT_NE(test::check_poles(surface, complex, kTolerance), "");
}

TEST_F(DamagedComplex, BrokenIncidenceIsNoticed) {
    VoronoiComplex broken = complex;
    std::swap(broken.vertex_polygons[broken.vertex_offsets[vertex]],
              broken.vertex_polygons[broken.vertex_offsets[vertex] + 1]);
    EXPECT_NE(test::check_incidence(surface, broken), "") << "unsorted";
    broken = complex;
    broken.vertex_polygons[broken.vertex_offsets[vertex]] = PolygonId(complex.polygon_count() - 1);
    EXPECT_NE(test::check_incidence(surface, broken), "") << "another polygon";
    broken = complex;
    broken.polygon_vertices[first] = broken.polygon_vertices[first + 1];
    EXPECT_NE(test::check_incidence(surface, broken), "") << "one vertex twice";
    broken = complex;
    broken.polygon_sites[polygon][1] = SiteId();
    EXPECT_NE(test::check_incidence(surface, broken), "") << "half the sites";
    broken = complex;
    broken.pole.pop_back();
    EXPECT_NE(test::check_incidence(surface, broken), "") << "a pole short";
}

TEST_F(DamagedComplex, MissingOrDoubledPolygonIsNoticed) {
    VoronoiComplex broken = complex;
    broken.polygon_sites[polygon] = broken.polygon_sites[polygon + 1];
    EXPECT_NE(test::compare_polygons(broken, reference, kTolerance), "");
    reference.polygons.pop_back();
    EXPECT_NE(test::compare_polygons(complex, reference, kTolerance), "");
}

TEST_F(DamagedComplex, MissingBareEdgeIsNoticed) {
    surface = test::closed_surface(make_phantom(thin_tube(0.2)));
    complex = test::complex_of(surface, 0);
    reference = test::reference_complex(surface);
    ASSERT_EQ(test::compare_polygons(complex, reference, kTolerance), "");
    ASSERT_FALSE(reference.bare_edges.empty());
    reference.bare_edges.back()[0] += 1e-3 * surface.median_edge * Vec3{1, 0, 0};
    EXPECT_NE(test::compare_polygons(complex, reference, kTolerance), "");
    reference.bare_edges.pop_back();
    EXPECT_NE(test::compare_polygons(complex, reference, kTolerance), "");
}

}  // namespace
}  // namespace lumenline
