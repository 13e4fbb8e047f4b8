// Sections of tubes of known sections, and what is measured on them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/branches/section_cutter.h"
#include "tests/branches/shapes.h"
#include "tests/stages/implicit_shape.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

using std::numbers::pi;

std::vector<PlanePoint> ellipse(double a, double b, PlanePoint centre, int count) {
    std::vector<PlanePoint> loop;
    for (int k = 0; k < count; ++k)
        loop.push_back({centre.x + a * std::cos(2 * pi * k / count), centre.y + b * std::sin(2 * pi * k / count)});
    return loop;
}

TEST(Loop, EllipseHasItsMeasures) {
    const SectionMeasures m = measure_loop(ellipse(5, 3, {0.5, -0.25}, 720));
    EXPECT_NEAR(m.area, pi * 15, 1e-3);
    EXPECT_NEAR(m.perimeter, 25.5269989, 1e-3);
    EXPECT_NEAR(m.centroid.x, 0.5, 1e-9);
    EXPECT_NEAR(m.centroid.y, -0.25, 1e-9);
    EXPECT_NEAR(m.min_diameter, 6, 1e-3);
    EXPECT_NEAR(m.max_diameter, 10, 1e-3);
    EXPECT_NEAR(m.least_width, 6, 1e-3);
}

TEST(Loop, LeastWidthOfATriangleIsItsLeastHeight) {
    const SectionMeasures m = measure_loop({{0, 0}, {4, 0}, {0, 3}});
    EXPECT_NEAR(m.least_width, 2.4, 1e-12);
    EXPECT_NEAR(m.area, 6, 1e-12);
}

TEST(Loop, OnlyOneTurnCounterClockwiseSurrounds) {
    std::vector<PlanePoint> loop = ellipse(2, 1, {0, 0}, 12);
    EXPECT_TRUE(surrounds_origin(loop));
    EXPECT_FALSE(surrounds_origin({loop.rbegin(), loop.rend()})) << "a hole";
    EXPECT_FALSE(surrounds_origin(ellipse(2, 1, {3, 0}, 12)));
    EXPECT_FALSE(surrounds_origin({}));
    const std::vector<PlanePoint> once = loop;
    loop.insert(loop.end(), once.begin(), once.end());
    EXPECT_FALSE(surrounds_origin(loop)) << "twice around";
}

TEST(Sections, CutFromAnySeedIsThatOfTheSearch) {
    PhantomOptions options = test::capped_options(PhantomKind::kHairpin, 0.2, 24, 0);
    const Phantom phantom = make_phantom(options);
    const Surface surface = test::closed_surface(phantom);
    const SectionCutter cutter(surface);
    test::Random random(2);
    int walked = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const AxisFrame f = phantom.truth.frame(random.uniform(1, phantom.truth.total_length() - 1));
        const SectionPlane plane{f.origin, f.e1, f.e2, f.tangent};
        const SectionLoop all = cutter.search(plane);
        // The plane of a leg cuts the other leg too: only the leg that holds the point counts.
        EXPECT_NEAR(measure_loop(all.points).area / (pi * 25), 1, 0.03);  // 24 corners: 1.1 % less; jitter
        const SectionLoop near = cutter.cut(plane, SiteId(random.below(surface.site_count())));
        if (near.points.empty()) continue;  // it came to the other leg, or got stuck at a cap
        ++walked;
        EXPECT_NEAR(measure_loop(near.points).area, measure_loop(all.points).area, 1e-9);
        EXPECT_EQ(near.points.size(), all.points.size());
    }
    EXPECT_GT(walked, 60);
}

TEST(Sections, PlaneOutsideOfTheLumenHasNone) {
    const Phantom phantom = make_phantom(test::capped_options(PhantomKind::kCylinder, 0, 16, 30));
    const Surface surface = test::closed_surface(phantom);
    const SectionCutter cutter(surface);
    const AxisFrame f = phantom.truth.frame(15);
    EXPECT_TRUE(cutter.search({f.origin + 8 * f.e1, f.e1, f.e2, f.tangent}).points.empty());
    EXPECT_TRUE(cutter.cut({f.origin + 8 * f.e1, f.e1, f.e2, f.tangent}, SiteId(0)).points.empty());
}

/// The whole pipeline on a tube with open ends.
ModelRecord tube_model(const PhantomOptions& options) {
    const Phantom phantom = make_phantom(options);
    ModelRecord record = test::run_pipeline(to_soup(phantom), test::from_start_to_end(phantom.truth));
    EXPECT_TRUE(record.branches) << (record.failure ? record.failure->sentence : "");
    return record;
}

TEST(Sections, EllipticTubeHasItsMeasures) {
    PhantomOptions options;
    options.b = 3;
    options.jitter = 0.2;
    options.rotate = true;
    const ModelRecord record = tube_model(options);
    const SectionTable& t = record.branches->sections;
    EXPECT_GT(t.rows(), 20U);
    for (std::size_t k = 0; k < t.rows(); ++k) {
        // Of 40 corners and more: areas are up to .5 % smaller, chords up to the sagitta of an edge, .3 % of a.
        EXPECT_NEAR(t.area[k] / (pi * 15), 1, 0.006);
        EXPECT_NEAR(t.perimeter[k] / 25.527, 1, 0.005);
        EXPECT_NEAR(t.min_diameter[k], 6, 0.03);
        EXPECT_NEAR(t.max_diameter[k], 10, 0.08);
        EXPECT_NEAR(t.min_projection[k], 6, 0.03);
        EXPECT_NEAR(t.min_projection[k], t.inscribed_diameter[k], 0.03) << "the paper's figure 3";
        EXPECT_NEAR(t.circularity[k], 4 * pi * pi * 15 / (25.527 * 25.527), 0.01);
        EXPECT_LT(t.centroid_offset[k], 0.02);
        EXPECT_EQ(t.closed[k], 1);
    }
}

TEST(Sections, ThoseThatRunOnThroughTheParentAreNotClosed) {
    // A narrow branch that leaves a wide tube at 45 degrees: a plane across its mouth cuts the tube along an ellipse.
    const double narrow = 0.4;
    const Vec3 end{5, 0, 5};
    const auto shape = [&](Vec3 x) {
        return std::min(test::straight_tube(x, {0, 0, -9}, {0, 0, 9}, 1), test::straight_tube(x, {}, end, narrow));
    };
    PipelineOptions options;
    options.endpoints.inlets = {{0, 0, -3}};
    options.endpoints.outlets = {{0, 0, 4.6}, {4, 0, 4}};
    const ModelRecord record =
        test::run_pipeline(test::polygonized(shape, {-1.4, -1.3, -3}, {4, 1.3, 4.6}, 0.16), options);
    ASSERT_TRUE(record.branches);
    const Branches& found = *record.branches;
    ASSERT_EQ(found.graph.branch_count(), 3U);
    const std::size_t side = found.table.radius[1].mean < 0.5 ? 1 : 2;
    const SectionTable& t = found.sections;
    std::size_t of_the_parent = 0;
    for (std::size_t k = 0; k < t.rows(); ++k) {
        if (t.branch[k] != BranchId(side) || t.area[k] < 4 * pi * narrow * narrow) continue;
        EXPECT_EQ(t.closed[k], 0);
        ++of_the_parent;
    }
    EXPECT_GT(of_the_parent, 0U);
    const Distribution& area = found.table.area[side];
    EXPECT_GT(area.min / (pi * narrow * narrow), 0.95) << "of 16 corners, moved by up to a seventh of the step";
    EXPECT_LT(area.max / (pi * narrow * narrow), 1.05);
}

TEST(Calibre, StenosisHasItsDegreeAndPlace) {
    for (const double severity : {0.3, 0.5, 0.7}) {
        PhantomOptions options;
        options.kind = PhantomKind::kStenosis;
        options.severity = severity;
        options.jitter = 0.2;
        options.rotate = true;
        const ModelRecord record = tube_model(options);
        const StenosisTable& t = record.branches->stenoses;
        ASSERT_EQ(t.abscissa.size(), 1U);
        EXPECT_NEAR(t.nascet_diameter[0], severity, 0.01);
        EXPECT_NEAR(t.ecst_diameter[0], severity, 0.01);
        const double area = 1 - (1 - severity) * (1 - severity);
        EXPECT_NEAR(t.nascet_area[0], area, 0.02);
        EXPECT_NEAR(t.ecst_area[0], area, 0.02);
        EXPECT_NEAR(t.abscissa[0], 25, 0.25 * 5) << "within one step of the axis";
        // Half of exp(-(z/w)^2) is passed at w sqrt(ln 2); inscribed balls reach a little farther than the profile.
        EXPECT_NEAR(t.length[0] / (2 * 5 * std::sqrt(std::log(2.0))), 1, 0.25);
    }
}

TEST(Calibre, DilationIsSeenAndAPlainTubeHasNone) {
    test::PlainLine line;
    for (int k = 0; k <= 240; ++k) {
        const double s = 0.25 * k;
        line.points.push_back({s, 0, 0});
        line.radius.push_back(2 - 0.01 * s + 0.8 * std::exp(-std::pow((s - 30) / 4, 2)));
    }
    line.target = 1;
    const Branches found = test::branches_of({line});
    EXPECT_NEAR(found.table.taper[0], -0.01, 1e-4);
    EXPECT_NEAR(found.dilations.abscissa[0], 30, 0.5);
    EXPECT_NEAR(found.dilations.ratio[0], 1 + 0.8 / 1.7, 0.01);
    for (double& r : line.radius) r = 2;
    const Branches plain = test::branches_of({line});
    EXPECT_EQ(plain.dilations.ratio[0], 1);
    EXPECT_TRUE(std::isnan(plain.dilations.length[0])) << "no widening has no length";
    EXPECT_EQ(plain.stenoses.ecst_diameter[0], 0);
}

TEST(SurfaceCoordinates, TubeIsMappedToItsAxisAndAngle) {
    PhantomOptions options;
    options.jitter = 0.2;
    options.rotate = true;
    const Phantom phantom = make_phantom(options);
    const ModelRecord record = tube_model(options);
    const SurfaceBranches& sites = record.branches->surface;
    const BranchTable& t = record.branches->table;
    double twist = 0;
    bool first = true;
    for (std::size_t i = 0; i < sites.branch.size(); ++i) {
        if (record.surface->origin[i] != SiteOrigin::kWall) continue;
        ASSERT_EQ(sites.branch[i], BranchId(0));
        const double s = phantom.truth.abscissa_of(record.surface->points[i]);
        // c(p) is where the descent ends, up to an edge (.785) from the foot of the perpendicular.
        EXPECT_NEAR(sites.longitudinal[i], s, 0.8);
        EXPECT_NEAR(sites.relative[i], s / 50, 0.8 / 50);
        const AxisFrame f = phantom.truth.frame(s);
        const Vec3 away = record.surface->points[i] - f.origin;
        const double angle = std::atan2(dot(away, f.e2), dot(away, f.e1));
        if (first) twist = sites.angle[i] - angle;
        first = false;
        EXPECT_NEAR(std::remainder(sites.angle[i] - angle - twist, 2 * pi), 0, 0.02);
    }
    EXPECT_NEAR(t.wall_area[0] / (2 * pi * 5 * 50), 1, 0.005);
    EXPECT_NEAR(t.volume[0] / (pi * 25 * 50), 1, 0.01);  // 40 corners: .4 % less
    const PatchTable& p = record.branches->patches;
    ASSERT_EQ(p.branch.size(), 120U);
    double area = 0;
    for (std::size_t k = 0; k < p.branch.size(); ++k) {
        EXPECT_NEAR(p.distance[k], 5, 0.05);
        area += p.area[k];
    }
    EXPECT_NEAR(area / t.wall_area[0], 1, 1e-9);
}

}  // namespace
}  // namespace lumenline
