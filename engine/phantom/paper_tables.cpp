// Figures of the paper as printed there. It states neither jitter nor what it leaves out at the ends;
// structured meshes are exact by symmetry and prove little, hence the jitter here.
#include "engine/phantom/paper_tables.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lumenline {
namespace {

constexpr double kA = 5;
constexpr double kAtOpenings = 0.25, kAtEnds = 1.2;  // of the greatest radius

constexpr std::array<PaperRow, 10> kRows{{
    {"5/5-40", true, true, 5, 40, {.01, .02, .03, .06}, 2975, 12.34},
    {"4/5-40", true, false, 4, 40, {.24, .19, .33, .04}, {}, {}},
    {"3/5-40", true, true, 3, 40, {.84, .78, .57, .04}, 3628, 6.20},
    {"2/5-40", true, false, 2, 40, {2.17, 1.34, .96, .17}, {}, {}},
    {"5/5-30", false, true, 5, 30, {.02, .03, .10, .15}, 1693, 5.86},
    {"5/5-20", false, true, 5, 20, {.02, .04, .25, .35}, 757, 1.97},
    {"5/5-10", false, true, 5, 10, {.44, .33, 1.38, 1.20}, 198, 0.31},
    {"3/5-30", false, true, 3, 30, {.74, .72, 1.01, .08}, 2073, 3.18},
    {"3/5-20", false, true, 3, 20, {2.88, 1.95, 2.08, .19}, 934, 1.21},
    {"3/5-10", false, true, 3, 10, {4.42, 4.68, 7.48, .79}, 239, 0.26},
}};

constexpr std::array<NoiseRow, 12> kNoiseRows{{
    {"5/5-40-0%", PhantomKind::kCylinder, 5, 0},
    {"5/5-40-1%", PhantomKind::kCylinder, 5, 0.01},
    {"5/5-40-5%", PhantomKind::kCylinder, 5, 0.05},
    {"5/5-40-10%", PhantomKind::kCylinder, 5, 0.1},
    {"3/5-40-0%", PhantomKind::kCylinder, 3, 0},
    {"3/5-40-1%", PhantomKind::kCylinder, 3, 0.01},
    {"3/5-40-5%", PhantomKind::kCylinder, 3, 0.05},
    {"3/5-40-10%", PhantomKind::kCylinder, 3, 0.1},
    {"torus-40-0%", PhantomKind::kTorus, 5, 0},
    {"torus-40-1%", PhantomKind::kTorus, 5, 0.01},
    {"torus-40-5%", PhantomKind::kTorus, 5, 0.05},
    {"torus-40-10%", PhantomKind::kTorus, 5, 0.1},
}};

constexpr std::array<CharacterRow, 4> kCharacterRows{{
    {"ntd-20", 20},
    {"ntd-40", 40},
    {"ntd-80", 80},
    {"ntd-160", 160},
}};

RowFigures measure(PhantomOptions options, int seeds, const LineMaker& make_line) {
    options.a = kA;
    options.jitter = 0.2;
    options.rotate = true;
    RowFigures figures;
    for (int seed = 1; seed <= seeds; ++seed) {
        options.seed = static_cast<std::uint64_t>(seed);
        const Phantom phantom = make_phantom(options);
        const PhantomLine line = make_line(phantom);
        figures.whole.add(line_error(phantom.truth, line.points, line.radius, kAtOpenings * kA, kA, options.b));
        figures.inner.add(line_error(phantom.truth, line.points, line.radius, kAtEnds * kA, kA, options.b));
        figures.vertices.add(static_cast<double>(phantom.points.size()));
        figures.seconds.add(line.seconds);
        double length = 0;
        for (std::size_t i = 1; i < line.points.size(); ++i) length += distance(line.points[i - 1], line.points[i]);
        figures.growth.add(100 * (length / phantom.truth.total_length() - 1));
    }
    return figures;
}

}  // namespace

std::span<const PaperRow> paper_rows() { return kRows; }
std::span<const NoiseRow> noise_rows() { return kNoiseRows; }
std::span<const CharacterRow> character_rows() { return kCharacterRows; }

double Spread::mean() const {
    double sum = 0;
    for (const double v : values_) sum += v;
    return sum / static_cast<double>(values_.size());
}

double Spread::deviation() const {
    if (values_.size() < 2) return 0;
    double sum = 0;
    for (const double v : values_) sum += (v - mean()) * (v - mean());
    return std::sqrt(sum / static_cast<double>(values_.size() - 1));
}

void ErrorSpread::add(const LineError& error) {
    position.add(error.position_mean);
    position_sigma.add(error.position_sigma);
    radius.add(error.radius_mean);
    radius_sigma.add(error.radius_sigma);
}

ErrorFigures ErrorSpread::mean() const {
    return {position.mean(), position_sigma.mean(), radius.mean(), radius_sigma.mean()};
}

RowFigures measure(const PaperRow& row, int seeds, const LineMaker& make_line) {
    PhantomOptions options;
    options.b = row.b;
    options.length = 10 * kA;
    options.points_around = row.points_around;
    return measure(options, seeds, make_line);
}

RowFigures measure(const NoiseRow& row, int seeds, const LineMaker& make_line) {
    PhantomOptions options;
    options.kind = row.kind;
    options.b = row.b;
    options.noise = row.noise;
    return measure(options, seeds, make_line);
}

EllipseCharacter ellipse_character(double a, double b, double t) {
    const double along = (a * a - b * b) / a * std::fabs(std::cos(t));
    const double ball = b / a * std::hypot(a * std::sin(t), b * std::cos(t));
    return {along + ball, along / (along + ball)};
}

CharacterFigures measure(const CharacterRow& row, int seeds, const RecordMaker& make_record) {
    PhantomOptions options;
    options.a = kA;
    options.b = 3;
    options.length = 6 * kA;
    options.points_around = row.points_around;
    options.jitter = 0.2;
    options.rotate = true;
    CharacterFigures figures;
    const auto add = [&](CharacterErrors& errors, double distance, double deviation, const EllipseCharacter& truth) {
        const double d = 100 * std::fabs(distance - truth.geodesic_distance) / kA;
        const double n = std::fabs(deviation - truth.normalized_tangency_deviation);
        errors.distance_mean += d;
        errors.deviation_mean += n;
        errors.distance_max = std::max(errors.distance_max, d);
        errors.deviation_max = std::max(errors.deviation_max, n);
    };
    for (int seed = 1; seed <= seeds; ++seed) {
        options.seed = static_cast<std::uint64_t>(seed);
        const Phantom phantom = make_phantom(options);
        const ModelRecord record = make_record(phantom);
        const SurfaceCharacter& found = *record.character;
        for (std::size_t i = 0; i < found.site_count(); ++i) {
            const Vec3 x = record.surface->points[i];
            const double s = phantom.truth.abscissa_of(x);
            if (record.surface->origin[i] != SiteOrigin::kWall || s < kAtEnds * kA ||
                s > phantom.truth.total_length() - kAtEnds * kA)
                continue;
            if (std::isnan(found.geodesic_distance[i])) {
                ++figures.unreached;
                continue;
            }
            const AxisFrame f = phantom.truth.frame(s);
            const double t = std::atan2(dot(x - f.origin, f.e2) / options.b, dot(x - f.origin, f.e1) / options.a);
            const EllipseCharacter truth = ellipse_character(options.a, options.b, t);
            ++figures.sites;
            add(figures.pole, found.geodesic_distance[i], found.normalized_tangency_deviation[i], truth);
            add(figures.refined, found.geodesic_distance_refined[i], found.normalized_tangency_deviation_refined[i],
                truth);
        }
    }
    for (CharacterErrors* errors : {&figures.pole, &figures.refined}) {
        errors->distance_mean /= static_cast<double>(figures.sites);
        errors->deviation_mean /= static_cast<double>(figures.sites);
    }
    return figures;
}

}  // namespace lumenline
