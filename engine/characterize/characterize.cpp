// Symbols of the paper: T~ = centerline_distance (eq. 6), D_g = geodesic_distance (eq. 7), c(p) = centerline_point,
// D_e = euclidean_distance, NTD = normalized_tangency_deviation (eq. 8).
// Every polygon that a path crosses or touches gives its vertices their exact distance to the path: snapping the path
// to vertices would spoil T~ by half a polygon everywhere.
#include "engine/characterize/characterize.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/characterize/descent.h"
#include "engine/characterize/medial_ball.h"
#include "engine/characterize/path_pieces.h"
#include "engine/characterize/statistics.h"
#include "engine/core/text.h"
#include "engine/geometry/polygon_march.h"

namespace lumenline {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
/// Sites of a range, and the most ranges: each has a table of the sites of its own.
constexpr std::size_t kGrain = 8192, kMostRanges = 32;

std::vector<double> march_from_paths(const VoronoiComplex& complex, const PathPieces& pieces, MarchWorkspace& work,
                                     const StageContext& context) {
    PolygonMarch<UnitMetric> march(complex, work);
    for (const PolygonId p : pieces.polygons())
        for (const VoronoiVertexId v : complex.polygon(p))
            march.seed(v, pieces.least_distance(p, complex.vertices[at(v)]), p);
    march.run(context);
    return work.time;
}

class Characterization {
public:
    Characterization(const Surface& surface, const VoronoiComplex& complex, const Endpoints& endpoints,
                     const Centerlines& lines, StageContext& context)
        : surface_(surface),
          complex_(complex),
          endpoints_(endpoints),
          lines_(lines),
          context_(context),
          pieces_(surface, complex, endpoints, lines) {}

    SurfaceCharacter run() {
        const std::size_t n = surface_.site_count();
        result_.centerline_distance = march_from_paths(complex_, pieces_, work_, context_);
        for (auto* values : {&result_.geodesic_distance, &result_.descent_length, &result_.euclidean_distance,
                             &result_.normalized_tangency_deviation, &result_.geodesic_distance_refined,
                             &result_.normalized_tangency_deviation_refined, &result_.abscissa})
            values->assign(n, kNaN);
        result_.centerline_point.assign(n, {kNaN, kNaN, kNaN});
        result_.centerline_id.assign(n, {});
        result_.zone.resize(n);
        const SiteSurroundings around(surface_, complex_);
        Descent descent(complex_, pieces_, lines_.path, work_);
        const std::size_t grain = std::max(kGrain, n / kMostRanges + 1);
        std::vector<std::size_t> not_refined(n / grain + 1, 0);
        context_.parallel_for(n, grain, [&](std::size_t begin, std::size_t end) {
            MedialBalls balls(surface_, complex_, around);
            for (std::size_t i = begin; i < end; ++i)
                if (!character_of(i, balls, descent)) ++not_refined[begin / grain];
        });
        result_.not_refined = std::accumulate(not_refined.begin(), not_refined.end(), std::size_t{0});
        summarize_wall(surface_, result_);
        result_.jumps = count_jumps(surface_, complex_, result_);
        report();
        return std::move(result_);
    }

private:
    /// @returns false where a site of the wall keeps the values of the paper's pole for want of a better ball
    bool character_of(std::size_t i, MedialBalls& balls, Descent& descent) {
        result_.zone[i] = surface_.origin[i] == SiteOrigin::kWall ? SiteZone::kWall : SiteZone::kAdded;
        const VoronoiVertexId pole = complex_.pole[i];
        if (pole.is_none()) return true;
        const DescentEnd end = descent.from(pole);
        if (!end.reached()) return true;
        place(i, pole, end);
        const BallCentre centre = result_.zone[i] == SiteZone::kAdded ? BallCentre() : balls.at_site(SiteId(i));
        return refine(i, centre, descent) || result_.zone[i] != SiteZone::kWall;
    }

    void report() {
        const auto [sheet, meet, other] = result_.jumps;
        if (result_.unreached > 0)
            context_.note("sites_unreached",
                          counted(result_.unreached, "site") + " of " + std::to_string(result_.wall_sites) +
                              " of the wall have no path to a centerline, and no distances",
                          static_cast<double>(result_.unreached));
        if (sheet + meet + other > 0)
            context_.note("correspondence_jumps",
                          counted(sheet + meet + other, "edge") +
                              " of the wall along which the distance or the point of the centerline jumps: " +
                              std::to_string(sheet) + " where the pole changes sheet, " + std::to_string(meet) +
                              " where branches meet, " + std::to_string(other) + " others",
                          static_cast<double>(sheet + meet + other));
    }

    void place(std::size_t i, VoronoiVertexId pole, const DescentEnd& end) {
        const Vec3 p = surface_.points[i];
        const double first = distance(p, complex_.vertices[at(pole)]);
        const double second = result_.centerline_distance[at(pole)];
        // Where the trace dropped points, the path's chord is a little off the complex: the descent ends on the path.
        const std::size_t k = end.foot.point;
        const Vec3 foot = lerp(lines_.path.points[k], lines_.path.points[k + 1], end.foot.share);
        result_.geodesic_distance[i] = first + second;
        result_.descent_length[i] = end.length + distance(end.foot.x, foot);
        result_.euclidean_distance[i] = distance(foot, p);
        result_.normalized_tangency_deviation[i] = second / (first + second);
        result_.centerline_point[i] = foot;
        result_.centerline_id[i] = end.foot.line;
        result_.abscissa[i] = along(lines_.path.line_abscissa, end.foot);
        if (result_.zone[i] == SiteZone::kWall && in_end_zone(end.foot)) result_.zone[i] = SiteZone::kEndZone;
    }

    bool refine(std::size_t i, const BallCentre& centre, const Descent& descent) {
        const double first = centre.found() ? distance(surface_.points[i], centre.x) : 0;
        const double second = centre.found() ? descent.distance_at(centre.polygon, centre.x, first) : kNaN;
        if (!(second < std::numeric_limits<double>::infinity())) {
            result_.geodesic_distance_refined[i] = result_.geodesic_distance[i];
            result_.normalized_tangency_deviation_refined[i] = result_.normalized_tangency_deviation[i];
            return false;
        }
        result_.geodesic_distance_refined[i] = first + second;
        result_.normalized_tangency_deviation_refined[i] = second / (first + second);
        return true;
    }

    static double along(const std::vector<double>& values, const PathFoot& foot) {
        const double from = values[foot.point], to = values[foot.point + 1];
        return from + foot.share * (to - from);
    }

    /// Within the last radius, along the path, of a given point.
    [[nodiscard]] bool in_end_zone(const PathFoot& foot) const {
        const std::size_t line = at(foot.line);
        const double s = along(lines_.path.abscissa, foot);
        const double length = lines_.path.abscissa[lines_.path.offsets[line + 1] - 1];
        const auto within = [&](EndpointId id, double away) {
            if (id.is_none()) return false;
            const Endpoint& e = endpoints_[at(id)];
            return e.opening.is_none() && away <= e.anchor_radius;
        };
        return within(lines_.source[line], s) || within(lines_.target[line], length - s);
    }

    const Surface& surface_;
    const VoronoiComplex& complex_;
    const Endpoints& endpoints_;
    const Centerlines& lines_;
    StageContext& context_;
    PathPieces pieces_;
    MarchWorkspace work_;
    SurfaceCharacter result_;
};

}  // namespace

SurfaceCharacter characterize_surface(const Surface& surface, const VoronoiComplex& complex, const Endpoints& endpoints,
                                      const Centerlines& centerlines, StageContext& context) {
    return Characterization(surface, complex, endpoints, centerlines, context).run();
}

}  // namespace lumenline
