// One line after the other: trace back, relax, cut at the planes of the openings, check, append.
#include "engine/trace/trace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engine/core/text.h"
#include "engine/geometry/edge_update.h"
#include "engine/trace/final_line.h"
#include "engine/trace/join.h"
#include "engine/trace/medial.h"
#include "engine/trace/path.h"
#include "engine/trace/polyline.h"
#include "engine/trace/verify.h"

namespace lumenline {

namespace {

constexpr double kMinStep = 1e-3;         // of the ball radius, between points of a path
constexpr double kUnreachedWall = 0.005;  // of the wall's sites
constexpr double kUndersampled = 0.05;    // (R - clearance) / R

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

/// Radius of the largest ball around x that holds no site.
double empty_ball_radius(const Surface& surface, Vec3 x) {
    double least2 = std::numeric_limits<double>::infinity();
    for (const Vec3& p : surface.points) least2 = std::min(least2, squared_norm(p - x));
    return std::sqrt(least2);
}

class Collector {
public:
    Collector(const Surface& surface, const VoronoiComplex& complex, const Endpoints& endpoints,
              const TraceOptions& options, StageContext& context)
        : complex_(complex), endpoints_(endpoints), options_(options), context_(context), verifier_(surface) {
        if (options.refine == Refinement::kMedial) refiner_.emplace(surface, verifier_.surface_distance());
        lines_.offsets.assign(1, 0);
        lines_.path.offsets.assign(1, 0);
    }

    void add(const ArrivalField& field, std::size_t target) {
        const Endpoint &from = endpoints_[at(field.source)], &to = endpoints_[target];
        const std::optional<ComplexPath> traced = trace_back(complex_, field.time, from, to);
        if (!traced) {
            report_unreached(target);
            return;
        }
        Candidate line = make_line(*traced, options_.refine, from, to);
        if (!line.check.inside && options_.refine != Refinement::kNone) {
            line = make_line(*traced, Refinement::kNone, from, to);
            if (line.check.inside)
                context_.note("line_not_relaxed", "the line to " + describe(endpoints_, target) +
                                                      " is kept as traced: relaxed, it would leave the lumen");
        }
        if (line.cut.size() < 2) {
            context_.error("line_vanished", "the line to " + describe(endpoints_, target) +
                                                " has no part between the planes of its two openings; it is left out");
            return;
        }
        if (!line.check.inside) {
            context_.error("line_leaves_lumen", "the line to " + describe(endpoints_, target) +
                                                    " leaves the lumen at " + short_text(line.check.outside_at) +
                                                    "; it is left out");
            return;
        }
        if (line.check.ball_excess > 0)
            context_.error("ball_clearance",
                           "the line to " + describe(endpoints_, target) +
                               " has a ball that disagrees with its distance to the wall: its radii there are doubtful",
                           line.check.ball_excess, 0);
        note_gaps(line);
        append(field.source, EndpointId(target), line, joined(final_line(line, from, to, target), from, to, target));
    }

    void report_unreached(std::size_t target) {
        context_.error("target_unreached", "no front reached " + describe(endpoints_, target) +
                                               ": it has no connection to a source inside the lumen, and no line");
    }

    Centerlines finish() {
        if (lines_.line_count() == 0)
            throw StageError(Stage::kTrace, ErrorCode::kNoLineTraced,
                             "no centerline could be traced: " + context_.diagnostics().back().message);
        if (gap_length_ > 0)
            context_.warn("undersampled",
                          "the surface is coarse for its narrowest parts: along " +
                              short_text(100 * gap_length_ / length_, 3) +
                              " % of the lines' length balls reach beyond the wall by more than " +
                              short_text(100 * kUndersampled, 3) + " % of their radius, at " + short_text(gap_at_) +
                              " by " + short_text(100 * largest_gap_, 3) + " %; radii there are overestimated",
                          largest_gap_, kUndersampled);
        return std::move(lines_);
    }

private:
    /// A line before it is accepted.
    struct Candidate {
        Polyline whole;                    ///< from anchor to anchor
        Polyline cut;                      ///< the part between the openings' planes
        double cut_front = 0;              ///< length cut off before it [length]
        std::vector<ComplexPoint> places;  ///< of the points of `whole`
        LineCheck check;
    };

    Candidate make_line(ComplexPath path, Refinement refine, const Endpoint& from, const Endpoint& to) {
        if (refine != Refinement::kNone) {
            thin_path(complex_, path, kMinStep);
            relax_path(complex_, path);
        }
        thin_path(complex_, path, kMinStep);
        Candidate line;
        line.whole = line.cut = polyline_of(complex_, path);
        line.places.assign(1, {});
        line.places.insert(line.places.end(), path.inner.begin(), path.inner.end());
        line.places.emplace_back();
        if (!from.opening.is_none()) line.cut_front = cut_at_plane(line.cut, from.point, from.normal, true);
        if (!to.opening.is_none()) cut_at_plane(line.cut, to.point, to.normal, false);
        if (line.cut.size() >= 2) {  // the points at the planes lie between points that need not share a polygon
            line.cut.radius.front() = empty_ball_radius(verifier_.surface(), line.cut.points.front());
            line.cut.radius.back() = empty_ball_radius(verifier_.surface(), line.cut.points.back());
        }
        line.check = verifier_.check(line.cut);
        return line;
    }

    /// Sums up where balls reach beyond the wall.
    void note_gaps(const Candidate& line) {
        for (std::size_t i = 1; i < line.cut.size(); ++i) {
            const double step = line.cut.abscissa[i] - line.cut.abscissa[i - 1];
            const double gap = 1 - line.check.clearance[i] / line.cut.radius[i];
            length_ += step;
            if (gap > kUndersampled) gap_length_ += step;
            if (gap > largest_gap_) {
                largest_gap_ = gap;
                gap_at_ = line.cut.points[i];
            }
        }
    }

    FinalLine final_line(const Candidate& line, const Endpoint& from, const Endpoint& to, std::size_t target) {
        if (refiner_) {
            std::string why;
            if (auto refined = refine_line(line.whole, from, to, *refiner_, verifier_, why)) return *std::move(refined);
            context_.note("line_not_refined", "the line to " + describe(endpoints_, target) +
                                                  " is kept on the Voronoi polygons: refined, it would " + why);
        }
        return unrefined_line(line.whole, line.cut, line.cut_front, line.check);
    }

    FinalLine joined(FinalLine line, const Endpoint& from, const Endpoint& to, std::size_t target) {
        if (options_.join == Join::kAxis) return line;
        const bool refined = !std::isnan(line.position_error.front());
        if (auto bent = join_centres(line, from, to, refined ? &*refiner_ : nullptr, verifier_))
            return *std::move(bent);
        context_.note("line_not_joined", "the line to " + describe(endpoints_, target) +
                                             " ends on its axis: bent to the centres of its openings, it would leave "
                                             "the lumen or turn sharply");
        return line;
    }

    void append(EndpointId source, EndpointId target, const Candidate& line, const FinalLine& final) {
        const auto extend = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
        extend(lines_.points, final.line.points);
        extend(lines_.ball_radius, final.ball_radius);
        extend(lines_.radius, final.line.radius);
        extend(lines_.clearance, final.clearance);
        extend(lines_.radius_error, final.radius_error);
        extend(lines_.position_error, final.position_error);
        extend(lines_.abscissa, final.line.abscissa);
        lines_.offsets.push_back(static_cast<std::uint32_t>(lines_.points.size()));
        lines_.source.push_back(source);
        lines_.target.push_back(target);
        extend(lines_.path.points, line.whole.points);
        extend(lines_.path.ball_radius, line.whole.radius);
        extend(lines_.path.abscissa, line.whole.abscissa);
        extend(lines_.path.places, line.places);
        extend(lines_.path.line_abscissa, final.path_to_line);
        lines_.path.offsets.push_back(static_cast<std::uint32_t>(lines_.path.points.size()));
    }

    const VoronoiComplex& complex_;
    const Endpoints& endpoints_;
    const TraceOptions& options_;
    StageContext& context_;
    LineVerifier verifier_;
    std::optional<MedialRefiner> refiner_;  // of the lines, where that is asked for
    Centerlines lines_;
    double length_ = 0, gap_length_ = 0, largest_gap_ = 0;
    Vec3 gap_at_;
};

/// Says where the lumen was not reached from any source: vessels that hang on it by no Voronoi edge,
/// or components without an inlet.
void report_unreached_wall(const Surface& surface, const VoronoiComplex& complex,
                           std::span<const std::shared_ptr<const ArrivalField>> fields, StageContext& context) {
    std::size_t wall = 0, unreached = 0;
    Vec3 place;
    for (std::size_t i = 0; i < surface.site_count(); ++i) {
        if (surface.origin[i] != SiteOrigin::kWall) continue;
        ++wall;
        const VoronoiVertexId pole = complex.pole[i];
        const auto reaches = [&](const auto& f) { return f->time[at(pole)] < std::numeric_limits<double>::infinity(); };
        if (!pole.is_none() && std::any_of(fields.begin(), fields.end(), reaches)) continue;
        if (unreached++ == 0) place = surface.points[i];
    }
    const double share = wall > 0 ? static_cast<double>(unreached) / static_cast<double>(wall) : 0;
    if (share > kUnreachedWall)
        context.warn("wall_unreached",
                     short_text(100 * share, 3) + " % of the wall, the first of it at " + short_text(place) +
                         ", belongs to parts of the lumen that no front reached from an inlet: they have no lines",
                     share, kUnreachedWall);
}

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
    report_unreached_wall(surface, complex, fields, context);
    return collector.finish();
}

}  // namespace lumenline
