// A front fills the whole lumen, and lines lead to outlets alone: a vessel that ends blind beside openings, or whose
// flat cap was left on, has arrival times and no line. Its poles are far from all lines, in radii of the larger of pole
// and line: within aneurysms, beside wide vessels and around bends they are near.
#include "engine/trace/coverage.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "engine/core/text.h"

namespace lumenline {

namespace {

constexpr double kUncovered = 0.005;  // of the wall's sites
constexpr double kFarFromLine = 8;    // radii; poles of a giant aneurysm are up to seven from the vessel's line
constexpr std::size_t kGrain = 4096;  // sites

struct Ball {
    Vec3 centre;
    double radius = 0;
};

/// Points of the lines at most about a radius apart, by ascending x.
std::vector<Ball> balls_along(const Centerlines& lines) {
    std::vector<Ball> balls;
    for (std::size_t line = 0; line < lines.line_count(); ++line) {
        double next = 0;
        for (std::size_t i = lines.offsets[line]; i < lines.offsets[line + 1]; ++i) {
            if (lines.abscissa[i] < next && i + 1 < lines.offsets[line + 1]) continue;
            balls.push_back({lines.points[i], lines.radius[i]});
            next = lines.abscissa[i] + lines.radius[i];
        }
    }
    std::stable_sort(balls.begin(), balls.end(), [](const Ball& a, const Ball& b) { return a.centre.x < b.centre.x; });
    return balls;
}

/// Distance from a ball of the complex to the lines in radii of the larger ball.
double radii_from_lines(const std::vector<Ball>& balls, Vec3 x, double radius) {
    const Ball* nearest = nullptr;
    double least = std::numeric_limits<double>::infinity();
    const auto may_be_near = [&](const Ball& ball) {
        const double across = ball.centre.x - x.x;
        if (across * across >= least) return false;
        if (const double d = squared_norm(ball.centre - x); d < least) {
            least = d;
            nearest = &ball;
        }
        return true;
    };
    const auto middle = std::lower_bound(balls.begin(), balls.end(), x.x,
                                         [](const Ball& ball, double at) { return ball.centre.x < at; });
    for (auto above = middle; above != balls.end() && may_be_near(*above); ++above) {
    }
    for (auto below = middle; below != balls.begin() && may_be_near(*std::prev(below)); --below) {
    }
    return distance(nearest->centre, x) / std::max(radius, nearest->radius);
}

void report_idle_inlets(const Endpoints& endpoints, const Centerlines& lines, StageContext& context) {
    for (std::size_t i = 0; i < endpoints.size(); ++i) {
        if (endpoints[i].role != EndpointRole::kInlet) continue;
        if (std::find(lines.source.begin(), lines.source.end(), EndpointId(i)) != lines.source.end()) continue;
        context.warn("inlet_without_line",
                     "no line begins at inlet " + std::to_string(i) + " at " + short_text(endpoints[i].point) +
                         ", because the outlets are nearer to another inlet or out of reach: make it an outlet if its "
                         "vessel is to have a line, or ask for `topology: network`");
    }
}

/// What of the wall's sites is left out in some way.
struct Share {
    std::size_t count = 0;
    Vec3 place;  // of the first

    void add(Vec3 p) {
        if (count++ == 0) place = p;
    }
};

std::string share_text(double share, const Share& part) {
    return short_text(100 * share, 3) + " % of the wall, the first of it at " + short_text(part.place);
}

}  // namespace

void report_coverage(const Surface& surface, const VoronoiComplex& complex, const Endpoints& endpoints,
                     std::span<const std::shared_ptr<const ArrivalField>> fields, const Centerlines& lines,
                     StageContext& context) {
    const std::vector<Ball> balls = balls_along(lines);
    if (!balls.empty()) report_idle_inlets(endpoints, lines, context);
    enum class Reach : char { kLine, kFront, kNone };
    std::vector<Reach> reach(surface.site_count(), Reach::kLine);
    context.parallel_for(reach.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (surface.origin[i] != SiteOrigin::kWall) continue;
            const VoronoiVertexId pole = complex.pole[i];
            const auto reaches = [&](const auto& f) {
                return f->time[at(pole)] < std::numeric_limits<double>::infinity();
            };
            if (pole.is_none() || std::none_of(fields.begin(), fields.end(), reaches))
                reach[i] = Reach::kNone;
            else if (!balls.empty() &&
                     radii_from_lines(balls, complex.vertices[at(pole)], complex.ball_radius[at(pole)]) > kFarFromLine)
                reach[i] = Reach::kFront;
        }
    });
    Share unreached, far;
    for (std::size_t i = 0; i < reach.size(); ++i) {
        if (reach[i] == Reach::kNone) unreached.add(surface.points[i]);
        if (reach[i] == Reach::kFront) far.add(surface.points[i]);
    }
    const auto wall = static_cast<double>(std::count(surface.origin.begin(), surface.origin.end(), SiteOrigin::kWall));
    const auto share_of = [wall](const Share& part) { return wall > 0 ? static_cast<double>(part.count) / wall : 0; };
    if (const double share = share_of(unreached); share > kUncovered)
        context.warn(
            "wall_unreached",
            share_text(share, unreached) +
                ", belongs to parts of the lumen that no front reached and that have no lines: give them an inlet",
            share, kUncovered);
    if (const double share = share_of(far); share > kUncovered)
        context.warn("wall_without_line",
                     share_text(share, far) + ", is more than " + short_text(kFarFromLine) +
                         " radii away from every line: where a vessel ends there, blind or in a flat cap, state "
                         "`mode: [boundaries, caps, tips]` or give its end as an outlet",
                     share, kUncovered);
}

}  // namespace lumenline
