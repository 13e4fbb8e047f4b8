// Tables 1 and 2 of Antiga et al. 2003: errors of the line in circular and elliptic cylinders of
// length 10 a. Errors in percent: position of the greatest radius, radius of the least, mean (sigma),
// weighted by arc length. The paper states neither jitter nor exclusion of ends; here the ends are
// open and extended, the meshes have 20 % tangential jitter, and both the whole line and the line
// without 1.2 a at the ends are shown.
//
// Bound: the reference below is the mean over three seeds for the same method (exact cost, dynamic
// programming, relaxation), ends excluded. Ours is the mean over five. A quarter more is allowed for
// differences in meshing, and twice the standard error of the difference of two such means, the
// spread over seeds being measured here: s sqrt(1/3 + 1/5).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "engine/phantom/accuracy.h"
#include "tests/stages/support.h"

namespace lumenline {
namespace {

constexpr int kSeeds = 5;

struct Row {
    const char* name;
    double b;  ///< least radius; the greatest is 5
    int points_around;
    const char* paper;
    double position, radius;  ///< reference [%]
};

const std::vector<Row> kRows{
    {"5/5, 40", 5, 40, " .01( .02)   .03( .06)", 0.004, 0.022},
    {"4/5, 40", 4, 40, " .24( .19)   .33( .04)", 0.26, 0.28},
    {"3/5, 40", 3, 40, " .84( .78)   .57( .04)", 0.32, 0.50},
    {"2/5, 40", 2, 40, "2.17(1.34)   .96( .17)", 0.48, 1.02},
    {"5/5, 30", 5, 30, " .02( .03)   .10( .15)", 0.008, 0.045},
    {"5/5, 20", 5, 20, " .02( .04)   .25( .35)", 0.029, 0.12},
    {"5/5, 10", 5, 10, " .44( .33)  1.38(1.20)", 0.30, 0.78},
    {"3/5, 30", 3, 30, " .74( .72)  1.01( .08)", 0.59, 0.87},
    {"3/5, 20", 3, 20, "2.88(1.95)  2.08( .19)", 1.13, 2.02},
    {"3/5, 10", 3, 10, "4.42(4.68)  7.48( .79)", 2.27, 8.3},
};

struct Spread {
    std::vector<double> values;

    [[nodiscard]] double mean() const {
        double sum = 0;
        for (const double v : values) sum += v;
        return sum / static_cast<double>(values.size());
    }
    [[nodiscard]] double deviation() const {
        double sum = 0;
        for (const double v : values) sum += (v - mean()) * (v - mean());
        return std::sqrt(sum / static_cast<double>(values.size() - 1));
    }
};

struct Errors {
    Spread position, position_sigma, radius, radius_sigma;

    void add(const LineError& e) {
        position.values.push_back(e.position_mean);
        position_sigma.values.push_back(e.position_sigma);
        radius.values.push_back(e.radius_mean);
        radius_sigma.values.push_back(e.radius_sigma);
    }
    [[nodiscard]] std::string text() const {
        char line[96];
        std::snprintf(line, sizeof line, "%6.3f(%6.3f) %6.3f(%6.3f)", position.mean(), position_sigma.mean(),
                      radius.mean(), radius_sigma.mean());
        return line;
    }
};

struct Measured {
    Errors whole, inner;
    Spread vertices, seconds;
};

Measured measure(const Row& row) {
    Measured measured;
    for (int seed = 1; seed <= kSeeds; ++seed) {
        PhantomOptions options;
        options.a = 5;
        options.b = row.b;
        options.length = 50;
        options.points_around = row.points_around;
        options.jitter = 0.2;
        options.seed = static_cast<std::uint64_t>(seed);
        options.rotate = true;
        const Phantom phantom = make_phantom(options);
        const ModelRecord record = test::run_pipeline(to_soup(phantom), test::from_start_to_end(phantom.truth));
        if (record.failure) {
            ADD_FAILURE() << row.name << ", seed " << seed << ": " << record.failure->sentence;
            continue;
        }
        const Centerlines& lines = *record.centerlines;
        EXPECT_EQ(lines.line_count(), 1U);
        measured.whole.add(line_error(phantom.truth, lines.points, lines.radius, 0, options.a, row.b));
        measured.inner.add(line_error(phantom.truth, lines.points, lines.radius, 1.2 * options.a, options.a, row.b));
        measured.vertices.values.push_back(static_cast<double>(phantom.points.size()));
        measured.seconds.values.push_back(record.facts.total_seconds);
    }
    return measured;
}

/// The reference with a quarter more, the noise of two means, and half a unit of its last digit.
double bound(double reference, const Spread& ours) {
    const double last_digit = reference < 0.1 ? 0.0005 : 0.005;
    return 1.25 * reference + 2 * ours.deviation() * std::sqrt(1.0 / 3 + 1.0 / kSeeds) + last_digit;
}

TEST(PaperTables, ErrorsOfCircularAndEllipticCylindersAreWithinTheReference) {
    std::printf("%-8s %8s %7s  %-24s %-30s %-30s\n", "b/a, pts", "vertices", "time/s", "paper: position, radius",
                "ours, whole line", "ours, ends excluded");
    for (const Row& row : kRows) {
        const Measured m = measure(row);
        if (m.inner.position.values.size() < 2) continue;
        std::printf("%-8s %8.0f %7.2f  %-24s %-30s %-30s\n", row.name, m.vertices.mean(), m.seconds.mean(), row.paper,
                    m.whole.text().c_str(), m.inner.text().c_str());
        EXPECT_LE(m.inner.position.mean(), bound(row.position, m.inner.position)) << row.name << ", position";
        EXPECT_LE(m.inner.radius.mean(), bound(row.radius, m.inner.radius)) << row.name << ", radius";
    }
}

}  // namespace
}  // namespace lumenline
