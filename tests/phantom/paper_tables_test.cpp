// The measuring of the paper's tables, with lines that are known in advance.
#include "engine/phantom/paper_tables.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>

namespace lumenline {
namespace {

/// The axis, moved aside by `shift` and with a radius too large by `excess`.
LineMaker axis_with(double shift, double excess) {
    return [=](const Phantom& phantom) {
        PhantomLine line;
        for (int k = 0; k <= 400; ++k) {
            const double s = phantom.truth.total_length() * k / 400;
            const AxisFrame f = phantom.truth.frame(s);
            line.points.push_back(f.origin + shift * f.e1);
            line.radius.push_back(phantom.truth.inscribed_radius(s) + excess);
        }
        line.seconds = 0.25;
        return line;
    };
}

TEST(PaperRows, AreThoseOfBothTables) {
    std::set<std::string_view> names;
    int first = 0, second = 0;
    for (const PaperRow& row : paper_rows()) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        first += row.in_table_1 ? 1 : 0;
        second += row.in_table_2 ? 1 : 0;
        EXPECT_EQ(row.in_table_2, row.paper_seconds.has_value()) << row.name;
        EXPECT_EQ(row.in_table_2, row.paper_vertices.has_value()) << row.name;
    }
    for (const NoiseRow& row : noise_rows()) EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_EQ(first, 4);
    EXPECT_EQ(second, 8);
}

TEST(PaperRows, ErrorsAreInPercentOfGreatestAndLeastRadius) {
    for (const PaperRow& row : paper_rows()) {
        if (row.points_around > 10) continue;
        const RowFigures figures = measure(row, 3, axis_with(0.05, -0.02 * row.b));
        EXPECT_EQ(figures.vertices.size(), 3U);
        EXPECT_NEAR(figures.whole.mean().position, 1, 1e-9);
        EXPECT_NEAR(figures.inner.mean().radius, 2, 1e-9);
        EXPECT_NEAR(figures.growth.mean(), 0, 1e-9);
        EXPECT_NEAR(figures.seconds.mean(), 0.25, 1e-15);
        // As many as the paper's cylinder of the same density has, within a few rings.
        EXPECT_NEAR(figures.vertices.mean(), *row.paper_vertices, 0.1 * *row.paper_vertices) << row.name;
    }
}

TEST(NoiseRows, LongerLinesAreSeen) {
    const NoiseRow& torus = noise_rows().back();
    ASSERT_EQ(torus.kind, PhantomKind::kTorus);
    // On the outer side of a bend of radius 20: a hundredth of that aside is a hundredth longer.
    const double growth = measure(torus, 1, axis_with(0.2, 0)).growth.mean();
    EXPECT_NEAR(std::fabs(growth), 1, 0.01);
}

TEST(Spread, MeanAndDeviationOfOneValue) {
    Spread spread;
    spread.add(3);
    EXPECT_EQ(spread.deviation(), 0);
    spread.add(5);
    EXPECT_EQ(spread.mean(), 4);
    EXPECT_DOUBLE_EQ(spread.deviation(), std::sqrt(2));
}

TEST(EllipseCharacter, TwoTermsMeetTheFormOfTheEccentricity) {
    for (const double b : {1.0, 3.0, 4.9})
        for (double t = 0; t < 6.3; t += 0.1) {
            const double a = 5, e2 = 1 - b * b / (a * a), c = std::fabs(std::cos(t));
            const EllipseCharacter at = ellipse_character(a, b, t);
            EXPECT_NEAR(at.normalized_tangency_deviation, e2 * c / (e2 * c + std::sqrt((1 - e2) * (1 - e2 * c * c))),
                        1e-14);
            // The foot of the normal on the major axis, and from there to the wall.
            const double foot = (a * a - b * b) / a * std::cos(t);
            EXPECT_NEAR(at.geodesic_distance, std::fabs(foot) + std::hypot(a * std::cos(t) - foot, b * std::sin(t)),
                        1e-13);
        }
    EXPECT_EQ(ellipse_character(5, 5, 1).normalized_tangency_deviation, 0);
}

/// A record whose sites are the phantom's vertices, with the closed form, D_g too large by `excess`.
ModelRecord record_with(const Phantom& phantom, double excess) {
    auto surface = std::make_shared<Surface>();
    auto character = std::make_shared<SurfaceCharacter>();
    surface->points = phantom.points;
    surface->origin.assign(phantom.points.size(), SiteOrigin::kWall);
    for (const Vec3& x : phantom.points) {
        const AxisFrame f = phantom.truth.frame(phantom.truth.abscissa_of(x));
        const Vec3 d = x - f.origin;
        const EllipseCharacter truth = ellipse_character(5, 3, std::atan2(dot(d, f.e2) / 3, dot(d, f.e1) / 5));
        character->geodesic_distance.push_back(truth.geodesic_distance + excess);
        character->geodesic_distance_refined.push_back(truth.geodesic_distance);
        character->normalized_tangency_deviation.push_back(truth.normalized_tangency_deviation);
        character->normalized_tangency_deviation_refined.push_back(truth.normalized_tangency_deviation - 0.01);
    }
    ModelRecord record;
    record.surface = surface;
    record.character = character;
    return record;
}

TEST(CharacterRows, ErrorsOfBothPolesAreSeenApart) {
    const CharacterFigures f =
        measure(character_rows().front(), 2, [](const Phantom& phantom) { return record_with(phantom, 0.05); });
    EXPECT_GT(f.sites, 0U);
    EXPECT_EQ(f.unreached, 0U);
    EXPECT_NEAR(f.pole.distance_mean, 1, 1e-9);
    EXPECT_NEAR(f.pole.distance_max, 1, 1e-9);
    EXPECT_NEAR(f.pole.deviation_max, 0, 1e-12);
    EXPECT_NEAR(f.refined.distance_max, 0, 1e-9);
    EXPECT_NEAR(f.refined.deviation_mean, 0.01, 1e-12);
}

TEST(PaperRows, LineThatFailsIsNotSkipped) {
    EXPECT_THROW(
        measure(paper_rows().back(), 1, [](const Phantom&) -> PhantomLine { throw std::runtime_error("no line"); }),
        std::runtime_error);
}

}  // namespace
}  // namespace lumenline
