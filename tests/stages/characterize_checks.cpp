#include "tests/stages/characterize_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry/inside_test.h"
#include "engine/geometry/nearest_on_polygon.h"

namespace lumenline::test {

namespace {

/// Additions of lengths of the model's size round by this share of it.
constexpr double kRounding = 1e-12;

class Checker {
public:
    explicit Checker(const ModelRecord& record)
        : surface_(*record.surface),
          complex_(*record.complex),
          path_(record.centerlines->path),
          character_(*record.character) {}

    std::vector<std::string> run() {
        if (surface_.site_count() != character_.site_count()) return {"wrong number of sites"};
        for (std::size_t i = 0; i < surface_.site_count(); ++i) check_site(i);
        check_distances();
        return std::move(found_);
    }

private:
    void expect(bool holds, const char* what, std::size_t i) {
        if (!holds) found_.push_back(std::string(what) + " at " + std::to_string(i));
    }

    void check_site(std::size_t i) {
        const SurfaceCharacter& c = character_;
        const VoronoiVertexId pole = complex_.pole[i];
        const double time = pole.is_none() ? std::numeric_limits<double>::infinity() : c.centerline_distance[at(pole)];
        const bool reached = !c.centerline_id[i].is_none();
        expect(reached == std::isfinite(time), "reached without a time, or the reverse", i);
        for (const double value :
             {c.geodesic_distance[i], c.descent_length[i], c.euclidean_distance[i], c.normalized_tangency_deviation[i],
              c.geodesic_distance_refined[i], c.normalized_tangency_deviation_refined[i], c.abscissa[i],
              c.centerline_point[i].x, c.centerline_point[i].y, c.centerline_point[i].z})
            expect(std::isnan(value) != reached, "a value without a line, or the reverse", i);
        if (!reached || !std::isfinite(time)) return;
        const Vec3 p = surface_.points[i], foot = c.centerline_point[i];
        const double away = distance(p, complex_.vertices[at(pole)]), slack = kRounding * surface_.diagonal;
        expect(std::fabs(c.geodesic_distance[i] - away - time) <= slack, "D_g is not its definition", i);
        expect(std::fabs(c.euclidean_distance[i] - distance(p, foot)) <= slack, "D_e is not its definition", i);
        expect(c.euclidean_distance[i] <= away + c.descent_length[i] + slack, "D_e beyond the way", i);
        for (const double ntd : {c.normalized_tangency_deviation[i], c.normalized_tangency_deviation_refined[i]})
            expect(ntd >= 0 && ntd <= 1, "NTD out of 0 to 1", i);
        check_foot(i, foot);
    }

    void check_foot(std::size_t i, Vec3 foot) {
        const std::size_t line = at(character_.centerline_id[i]);
        double abscissa_error = std::numeric_limits<double>::infinity();
        for (std::size_t k = path_.offsets[line]; k + 1 < path_.offsets[line + 1]; ++k) {
            const double t = nearest_on_segment(path_.points[k], path_.points[k + 1], foot);
            const double d = distance(lerp(path_.points[k], path_.points[k + 1], t), foot);
            const double s = (1 - t) * path_.line_abscissa[k] + t * path_.line_abscissa[k + 1];
            if (d <= kRounding * surface_.diagonal)
                abscissa_error = std::min(abscissa_error, std::fabs(s - character_.abscissa[i]));
        }
        expect(std::isfinite(abscissa_error), "c(p) is not on its line", i);
        expect(abscissa_error <= 1e-6 * surface_.diagonal, "c(p) has another abscissa", i);
    }

    void check_distances() {
        for (std::size_t p = 0; p < complex_.polygon_count(); ++p) {
            const auto loop = complex_.polygon(PolygonId(p));
            for (std::size_t k = 0; k < loop.size(); ++k) {
                const std::size_t v = at(loop[k]), w = at(loop[k + 1 == loop.size() ? 0 : k + 1]);
                const double a = character_.centerline_distance[v], b = character_.centerline_distance[w];
                const double length = distance(complex_.vertices[v], complex_.vertices[w]);
                // The march takes no improvement below 1e-5 of the ball radius.
                const double slack = 1.001e-5 * std::max(complex_.ball_radius[v], complex_.ball_radius[w]);
                expect(a >= 0 && (std::isinf(a) ? std::isinf(b) : std::fabs(a - b) <= length + slack),
                       "T~ rises faster than the way", v);
            }
        }
    }

    const Surface& surface_;
    const VoronoiComplex& complex_;
    const PathLines& path_;
    const SurfaceCharacter& character_;
    std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> character_violations(const ModelRecord& record) { return Checker(record).run(); }

double share_beyond_geodesic(const SurfaceCharacter& c, double tolerance) {
    std::size_t beyond = 0, counted = 0;
    for (std::size_t i = 0; i < c.site_count(); ++i) {
        if (c.zone[i] != SiteZone::kWall || c.centerline_id[i].is_none()) continue;
        ++counted;
        beyond += c.euclidean_distance[i] > (1 + tolerance) * c.geodesic_distance[i] ? 1 : 0;
    }
    return static_cast<double>(beyond) / static_cast<double>(counted);
}

NaivePoint naive_nearest(const Centerlines& lines, Vec3 x) {
    NaivePoint best;
    for (std::size_t line = 0; line < lines.line_count(); ++line)
        for (std::size_t k = lines.path.offsets[line]; k + 1 < lines.path.offsets[line + 1]; ++k) {
            const Vec3 a = lines.path.points[k], b = lines.path.points[k + 1];
            const Vec3 y = lerp(a, b, nearest_on_segment(a, b, x));
            if (best.line.is_none() || distance(x, y) < distance(x, best.x)) best = {LineId(line), y};
        }
    return best;
}

bool leaves_lumen(const InsideTest& inside, Vec3 a, Vec3 b) {
    for (int k = 5; k < 100; ++k)
        if (!inside.inside(lerp(a, b, k / 100.0))) return true;
    return false;
}

}  // namespace lumenline::test
