// One line after the other: trace back, relax, cut at the planes of the openings, check, append.
#include "engine/trace/trace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engine/core/text.h"
#include "engine/geometry/edge_update.h"
#include "engine/trace/path.h"
#include "engine/trace/polyline.h"
#include "engine/trace/verify.h"

namespace lumenline {

namespace {

constexpr double kMinStep = 1e-2;       // of the ball radius, between points of a path
constexpr double kUndersampled = 0.05;  // (R - clearance) / R

/// Arrival time at a target's anchor: the least over the vertices of the polygons that hold it.
double arrival_at(const ArrivalField& field, const Endpoint& target) {
    double least = std::numeric_limits<double>::infinity();
    for (const Seed& s : target.seeds) least = std::min(least, field.time[at(s.vertex)] + s.time);
    return least;
}

Polyline polyline_of(const VoronoiComplex& complex, const ComplexPath& path) {
    Polyline line;
    line.append(path.start, path.start_radius);
    for (const ComplexPoint& p : path.inner) line.append(position(complex, p), ball_radius(complex, p));
    line.append(path.end, path.end_radius);
    return line;
}

std::string describe(const Endpoints& endpoints, std::size_t i) {
    const Endpoint& e = endpoints[i];
    return std::string(role_name(e.role)) + " " + std::to_string(i) + " at " + short_text(e.point);
}

class Collector {
public:
    Collector(const Surface& surface, const VoronoiComplex& complex, const Endpoints& endpoints,
              const TraceOptions& options, StageContext& context)
        : complex_(complex), endpoints_(endpoints), options_(options), context_(context), verifier_(surface) {
        lines_.offsets.assign(1, 0);
        lines_.path.offsets.assign(1, 0);
    }

    void add(const ArrivalField& field, std::size_t target) {
        const Endpoint &from = endpoints_[at(field.source)], &to = endpoints_[target];
        std::optional<ComplexPath> path = trace_back(complex_, field.time, from, to);
        if (!path) {
            report_unreached(target);
            return;
        }
        thin_path(complex_, *path, kMinStep);
        if (options_.refine == Refinement::kPath) {
            relax_path(complex_, *path);
            thin_path(complex_, *path, kMinStep);
        }
        const Polyline whole = polyline_of(complex_, *path);
        Polyline line = whole;
        const double cut_front = from.opening.is_none() ? 0 : cut_at_plane(line, from.point, from.normal, true);
        if (!to.opening.is_none()) cut_at_plane(line, to.point, to.normal, false);
        if (line.size() < 2) {
            context_.error("line_vanished", "the line to " + describe(endpoints_, target) +
                                                " has no part between the planes of its two openings; it is left out");
            return;
        }
        const LineCheck check = verifier_.check(line);
        if (!check.inside) {
            context_.error("line_leaves_lumen", "the line to " + describe(endpoints_, target) +
                                                    " leaves the lumen at " + short_text(check.outside_at) +
                                                    "; it is left out");
            return;
        }
        if (check.ball_excess > 0)
            context_.error("ball_clearance",
                           "the line to " + describe(endpoints_, target) +
                               " has a ball that disagrees with its distance to the wall: its radii there are doubtful",
                           check.ball_excess, 0);
        largest_gap_ = std::max(largest_gap_, check.largest_gap);
        append(field.source, EndpointId(target), line, check.clearance, whole, cut_front);
    }

    void report_unreached(std::size_t target) {
        context_.error("target_unreached", "no front reached " + describe(endpoints_, target) +
                                               ": it has no connection to a source inside the lumen, and no line");
    }

    Centerlines finish() {
        if (lines_.line_count() == 0)
            throw StageError(Stage::kTrace, ErrorCode::kNoLineTraced,
                             "no centerline could be traced: " + context_.diagnostics().back().message);
        if (largest_gap_ > kUndersampled)
            context_.warn("undersampled",
                          "the surface is coarse for its narrowest parts: a ball reaches beyond the wall by " +
                              short_text(100 * largest_gap_, 3) + " % of its radius; radii there are overestimated",
                          largest_gap_, kUndersampled);
        return std::move(lines_);
    }

private:
    void append(EndpointId source, EndpointId target, const Polyline& line, const std::vector<double>& clearance,
                const Polyline& whole, double cut_front) {
        const auto extend = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
        extend(lines_.points, line.points);
        extend(lines_.ball_radius, line.radius);
        extend(lines_.radius, line.radius);
        extend(lines_.clearance, clearance);
        extend(lines_.abscissa, line.abscissa);
        lines_.offsets.push_back(static_cast<std::uint32_t>(lines_.points.size()));
        lines_.source.push_back(source);
        lines_.target.push_back(target);
        extend(lines_.path.points, whole.points);
        extend(lines_.path.ball_radius, whole.radius);
        extend(lines_.path.abscissa, whole.abscissa);
        for (const double s : whole.abscissa)
            lines_.path.line_abscissa.push_back(std::clamp(s - cut_front, 0.0, line.abscissa.back()));
        lines_.path.offsets.push_back(static_cast<std::uint32_t>(lines_.path.points.size()));
    }

    const VoronoiComplex& complex_;
    const Endpoints& endpoints_;
    const TraceOptions& options_;
    StageContext& context_;
    LineVerifier verifier_;
    Centerlines lines_;
    double largest_gap_ = 0;
};

}  // namespace

Centerlines trace_centerlines(const Surface& surface, const VoronoiComplex& complex, const Endpoints& endpoints,
                              std::span<const std::shared_ptr<const ArrivalField>> fields, const TraceOptions& options,
                              StageContext& context) {
    Collector collector(surface, complex, endpoints, options, context);
    for (std::size_t target = 0; target < endpoints.size(); ++target) {
        if (endpoints[target].role != EndpointRole::kOutlet) continue;
        context.check_cancelled();
        const ArrivalField* nearest = nullptr;
        double least = std::numeric_limits<double>::infinity();
        for (const auto& field : fields) {
            const double t = arrival_at(*field, endpoints[target]);
            if (!(t < std::numeric_limits<double>::infinity())) continue;
            if (options.pairs == Pairs::kAll) collector.add(*field, target);
            if (t < least) {
                least = t;
                nearest = field.get();
            }
        }
        if (nearest == nullptr)
            collector.report_unreached(target);
        else if (options.pairs == Pairs::kNearest)
            collector.add(*nearest, target);
    }
    return collector.finish();
}

}  // namespace lumenline
