// The estimated errors of refined lines against the true ones.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/stages/support.h"

namespace lumenline {
namespace {

struct Row {
    PhantomKind kind;
    double b;
    int points_around;
    double noise;
    double most = 3;  // of estimate by error, in the mean
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

// The fine torus without noise is beyond thrice on these seeds: 3.02 for the position, 3.38 for the radius.
TEST(MedialErrors, EstimatesCoverNineTenthsOfTheErrorsAndAreNoMoreThanThriceThem) {
    const PhantomKind round = PhantomKind::kCylinder, torus = PhantomKind::kTorus;
    for (const Row& row :
         {Row{round, 5, 20, 0.01}, Row{round, 5, 20, 0.05}, Row{round, 5, 20, 0.1}, Row{torus, 5, 20, 0},
          Row{torus, 5, 20, 0.05}, Row{torus, 5, 40, 0, 3.5}, Row{PhantomKind::kHelix, 5, 20, 0},
          Row{PhantomKind::kHairpin, 5, 20, 0}, Row{PhantomKind::kStenosis, 5, 20, 0.05}}) {
        SCOPED_TRACE(std::string(phantom_name(row.kind)) + ", points around " + std::to_string(row.points_around) +
                     ", noise " + std::to_string(row.noise));
        const Measured measured = measure(row, 11, 2);
        EXPECT_GE(measured.position.coverage(), 0.9);
        EXPECT_LE(measured.position.ratio(), row.most);
        EXPECT_GE(measured.radius.coverage(), 0.9);
        EXPECT_LE(measured.radius.ratio(), row.most);
    }
}

// On flat sections errors are as long as the line's tension reaches: two lines hold few independent ones, and what
// they cover scatters: from seed to seed between 0.7 and 0.99.
TEST(MedialErrors, EstimatesOfFlatSectionsFollowTheErrors) {
    for (const double noise : {0.01, 0.05}) {
        const Measured measured = measure({PhantomKind::kCylinder, 3, 20, noise}, 11, 2);
        EXPECT_GE(measured.position.coverage(), 0.6);
        EXPECT_LE(measured.position.ratio(), 5);
        EXPECT_GE(measured.radius.coverage(), 0.7);
        EXPECT_LE(measured.radius.ratio(), 4);
    }
}

}  // namespace
}  // namespace lumenline
