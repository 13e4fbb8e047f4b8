// Every check must reject a model that was damaged in just its respect.
#include "tests/examples/promises.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/cli/process.h"
#include "tests/examples/example_models.h"

namespace lumenline::examples {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// One good model with all its parts open to damage.
struct Open {
    explicit Open(const std::string& id = "elliptic_cylinder")
        : record(compute(id)),
          surface(*record.surface),
          complex(*record.complex),
          endpoints(*record.endpoints),
          lines(*record.centerlines),
          field(*record.fields.front()) {}

    ModelRecord record;
    Surface surface;
    VoronoiComplex complex;
    Endpoints endpoints;
    Centerlines lines;
    ArrivalField field;
};

TEST(Promises, SurfaceThatIsNotClosedIsSeen) {
    Open model;
    ASSERT_TRUE(check_surface(model.surface).empty());
    Surface damaged = model.surface;
    damaged.triangles.pop_back();
    EXPECT_FALSE(check_surface(damaged).empty());
    damaged = model.surface;
    std::swap(damaged.triangles[5][0], damaged.triangles[5][1]);
    EXPECT_FALSE(check_surface(damaged).empty());
    damaged = model.surface;
    std::swap(damaged.origin.front(), damaged.origin.back());
    EXPECT_FALSE(check_surface(damaged).empty());
}

TEST(Promises, WrongCountsAreSeen) {
    Open model;
    ASSERT_TRUE(check_counts(model.lines, model.endpoints).empty());
    Endpoints more = model.endpoints;
    more.push_back(more.back());
    EXPECT_FALSE(check_counts(model.lines, more).empty());
    Centerlines damaged = model.lines;
    damaged.radius.pop_back();
    EXPECT_FALSE(check_counts(damaged, model.endpoints).empty());
    damaged = model.lines;
    damaged.offsets.back() -= 1;
    EXPECT_FALSE(check_counts(damaged, model.endpoints).empty());
    damaged = model.lines;
    damaged.clearance[3] = kNaN;
    EXPECT_FALSE(check_counts(damaged, model.endpoints).empty());
    damaged = model.lines;
    std::swap(damaged.source, damaged.target);
    EXPECT_FALSE(check_counts(damaged, model.endpoints).empty());
}

TEST(Promises, WrongAbscissaIsSeen) {
    Open model;
    ASSERT_TRUE(check_abscissa(model.lines).empty());
    for (const double value : {-1.0, model.lines.abscissa[2], kNaN}) {
        Centerlines damaged = model.lines;
        damaged.abscissa[3] = value;
        EXPECT_FALSE(check_abscissa(damaged).empty()) << value;
    }
}

TEST(Promises, LineThatRunsBackwardsOrEndsElsewhereIsSeen) {
    for (const char* id : {"elliptic_cylinder", "gastric_vein"}) {  // openings, given points
        Open model(id);
        ASSERT_TRUE(check_ends(model.lines, model.endpoints, model.surface).empty());
        Centerlines damaged = model.lines;
        std::reverse(damaged.points.begin(), damaged.points.end());
        EXPECT_FALSE(check_ends(damaged, model.endpoints, model.surface).empty());
        damaged = model.lines;
        damaged.points.back() = damaged.points[damaged.points.size() - 2];
        EXPECT_FALSE(check_ends(damaged, model.endpoints, model.surface).empty());
    }
}

TEST(Promises, PointOutsideAndWrongBallsAreSeen) {
    Open model;
    ASSERT_TRUE(check_balls(model.lines, model.surface).empty());
    Centerlines damaged = model.lines;
    damaged.points[4] += {0, 20, 0};
    EXPECT_FALSE(check_balls(damaged, model.surface).empty());
    damaged = model.lines;
    damaged.clearance[4] *= 0.999;
    EXPECT_FALSE(check_balls(damaged, model.surface).empty());
    damaged = model.lines;
    damaged.ball_radius[4] = 0.999 * damaged.clearance[4];
    EXPECT_FALSE(check_balls(damaged, model.surface).empty());
    damaged = model.lines;
    damaged.ball_radius[4] *= 1.1;
    EXPECT_FALSE(check_balls(damaged, model.surface).empty());
}

TEST(Promises, WrongMapOfThePathIsSeen) {
    Open model;
    ASSERT_TRUE(check_paths(model.lines).empty());
    Centerlines damaged = model.lines;
    damaged.path.line_abscissa.back() *= 0.99;
    EXPECT_FALSE(check_paths(damaged).empty());
    damaged = model.lines;
    damaged.path.line_abscissa[damaged.path.points.size() / 2] = 0;
    EXPECT_FALSE(check_paths(damaged).empty());
    damaged = model.lines;
    damaged.path.abscissa[2] = damaged.path.abscissa[1];
    EXPECT_FALSE(check_paths(damaged).empty());
}

TEST(Promises, WrongTimesAreSeen) {
    Open model;
    ASSERT_TRUE(check_field(model.field, model.complex).empty());
    for (const double value : {-1.0, kNaN, std::numeric_limits<double>::infinity()}) {
        ArrivalField damaged = model.field;
        *std::find_if(damaged.time.begin(), damaged.time.end(), [](double t) { return std::isfinite(t); }) = value;
        EXPECT_FALSE(check_field(damaged, model.complex).empty()) << value;
    }
    ArrivalField damaged = model.field;
    damaged.residual = 1e-3;
    EXPECT_FALSE(check_field(damaged, model.complex).empty());
    damaged.residual = kNaN;
    EXPECT_FALSE(check_field(damaged, model.complex).empty());
    damaged = model.field;
    damaged.time.pop_back();
    EXPECT_FALSE(check_field(damaged, model.complex).empty());
}

TEST(Promises, MissingPolesAndUnreachedOnesAreSeen) {
    Open model;
    ASSERT_TRUE(check_poles(model.record).empty());
    VoronoiComplex damaged = model.complex;
    for (std::size_t s = 0; s < model.surface.site_count() / 50; ++s) damaged.pole[s] = {};
    model.record.complex = std::make_shared<const VoronoiComplex>(damaged);
    EXPECT_FALSE(check_poles(model.record).empty());
    model.record.complex = std::make_shared<const VoronoiComplex>(model.complex);
    ASSERT_TRUE(check_poles(model.record).empty());
    ArrivalField unreached = model.field;
    for (std::size_t v = 0; v < unreached.time.size(); v += 20)
        unreached.time[v] = std::numeric_limits<double>::infinity();
    model.record.fields = {std::make_shared<const ArrivalField>(unreached)};
    EXPECT_FALSE(check_poles(model.record).empty());
}

TEST(Promises, FailedModelIsSeen) {
    Open model;
    ASSERT_TRUE(check_model(model.record).empty());
    model.record.failure = Failure{Stage::kTrace, ErrorCode::kNoLineTraced, "no line"};
    EXPECT_EQ(check_model(model.record), Broken{"failed: no line"});
}

TEST(Promises, LineBesideTheAxisIsMeasured) {
    // A straight axis, a line 0.25 beside it with radii 0.5 too large: the errors are exactly that.
    AxisTruth truth;
    Centerlines lines;
    lines.offsets = {0, 11};
    for (int i = 0; i <= 10; ++i) {
        truth.abscissa.push_back(i);
        truth.points.push_back({0, 0, static_cast<double>(i)});
        truth.radius.push_back(2);
        lines.abscissa.push_back(i);
        lines.points.push_back({0.25, 0, static_cast<double>(i)});
        lines.radius.push_back(2.5);
    }
    const TruthErrors errors = compare_with_truth(lines, truth);
    EXPECT_DOUBLE_EQ(errors.mean_distance, 0.25);
    EXPECT_DOUBLE_EQ(errors.max_distance, 0.25);
    EXPECT_DOUBLE_EQ(errors.mean_radius, 0.5);
    EXPECT_DOUBLE_EQ(errors.max_radius, 0.5);
    EXPECT_DOUBLE_EQ(errors.length, 0);
}

TEST(Promises, FileThatIsNoTruthIsRefused) {
    EXPECT_THROW(read_truth(folder() / "participants.tsv"), std::runtime_error);
    EXPECT_THROW(read_truth(folder() / "absent.tsv"), std::runtime_error);
    const auto damaged = cli_test::fresh_folder() / "truth.tsv";
    cli_test::write_text(damaged, "abscissa\tx\ty\tz\tradius\n0\t0\t0\t0\t1\n1\t0\tx\t0\t1\n");
    EXPECT_THROW(read_truth(damaged), std::runtime_error);
}

}  // namespace
}  // namespace lumenline::examples
