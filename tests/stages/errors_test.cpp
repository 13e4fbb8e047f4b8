// The estimated errors of refined lines against the true ones.
#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <string>

#include "tests/stages/support.h"

namespace lumenline {
namespace {

struct Row {
    PhantomKind kind;
    double b;
    int points_around;
    double noise;
};

/// Sums over the points of all lines of a row, without a quarter of the greatest radius at the openings.
struct Tally {
    double error = 0, estimate = 0, covered = 0, count = 0;

    void add(double e, double bound) {
        error += e;
        estimate += bound;
        covered += e <= bound ? 1 : 0;
        ++count;
    }
    [[nodiscard]] double coverage() const { return covered / count; }
    [[nodiscard]] double ratio() const { return estimate / error; }
};

struct Measured {
    Tally position, radius;
};

// Seeds that no factor was chosen on.
Measured measure(const Row& row, std::uint64_t first_seed, std::uint64_t seeds) {
    Measured measured;
    for (std::uint64_t seed = first_seed; seed < first_seed + seeds; ++seed) {
        PhantomOptions options;
        options.kind = row.kind;
        options.b = row.b;
        options.points_around = row.points_around;
        options.noise = row.noise;
        options.jitter = 0.2;
        options.rotate = true;
        options.seed = seed;
        const Phantom phantom = make_phantom(options);
        const PhantomTruth& truth = phantom.truth;
        PipelineOptions pipeline = test::from_start_to_end(truth);
        pipeline.characterize = false;
        const ModelRecord record = test::run_pipeline(to_soup(phantom), pipeline);
        EXPECT_FALSE(record.failure.has_value());
        if (record.failure) continue;
        const Centerlines& lines = *record.centerlines;
        const double end = 0.25 * truth.max_section_radius();
        for (std::size_t i = 0; i < lines.points.size(); ++i) {
            const double s = truth.abscissa_of(lines.points[i]);
            if (s < end || s > truth.total_length() - end) continue;
            measured.position.add(distance(lines.points[i], truth.position(s)), lines.position_error[i]);
            measured.radius.add(std::fabs(lines.radius[i] - truth.inscribed_radius(s)), lines.radius_error[i]);
        }
    }
    return measured;
}

void expect_cover(const Tally& tally, double least, double most) {
    EXPECT_GE(tally.coverage(), least);
    EXPECT_LE(tally.ratio(), most);
}

void check(std::initializer_list<Row> rows, double least, double most) {
    double coverage = 0, ratio = 0;
    for (const Row& row : rows) {
        SCOPED_TRACE(std::string(phantom_name(row.kind)) + ", b " + std::to_string(row.b) + ", points around " +
                     std::to_string(row.points_around) + ", noise " + std::to_string(row.noise));
        const Measured measured = measure(row, 11, 2);
        for (const Tally* tally : {&measured.position, &measured.radius}) {
            expect_cover(*tally, least, most);
            coverage += tally->coverage() / 2;
            ratio += tally->ratio() / 2;
        }
    }
    EXPECT_GE(coverage / static_cast<double>(rows.size()), 0.9);
    EXPECT_LE(ratio / static_cast<double>(rows.size()), 3);
}

// Single rows scatter with their few seeds and lines: nine tenths and thrice are met by them together.
TEST(MedialErrors, EstimatesOfNoisyRoundSectionsCoverTheErrors) {
    const PhantomKind round = PhantomKind::kCylinder;
    check({{round, 5, 20, 0.01},
           {round, 5, 20, 0.05},
           {round, 5, 20, 0.1},
           {PhantomKind::kTorus, 5, 20, 0.05},
           {PhantomKind::kStenosis, 5, 20, 0.05},
           {PhantomKind::kStenosis, 5, 40, 0.05}},
          0.9, 3);
}

TEST(MedialErrors, EstimatesOfWhatQuadricsCannotFollowCoverTheErrors) {
    check({{PhantomKind::kTorus, 5, 20, 0},
           {PhantomKind::kTorus, 5, 40, 0},
           {PhantomKind::kHelix, 5, 20, 0},
           {PhantomKind::kHairpin, 5, 20, 0},
           {PhantomKind::kStenosis, 5, 20, 0},
           {PhantomKind::kStenosis, 5, 40, 0}},
          0.8, 3.6);
}

// On flat sections errors are as long as the line's tension reaches: two lines hold few independent ones, and what
// they cover scatters from seed to seed.
TEST(MedialErrors, EstimatesOfNoisyFlatSectionsCoverTheErrors) {
    const PhantomKind flat = PhantomKind::kCylinder;
    check({{flat, 4, 20, 0.01},
           {flat, 4, 20, 0.1},
           {flat, 3, 20, 0.01},
           {flat, 3, 20, 0.05},
           {flat, 2, 20, 0.01},
           {flat, 2, 20, 0.05}},
          0.7, 4);
}

}  // namespace
}  // namespace lumenline
