// One line after the other: trace back, relax, cut at the planes of the openings, check, append.
//
// A loop is relaxed as one path, from the source around it and back to the source or on to another one, and parted where the fronts met, so
// that both sides end in the same point. Refined, each side goes on around the loop for some radii and is cut at the
// plane where the other one is: so the point where they meet lies on the axis, and they pass into each other smoothly.
#include "engine/trace/trace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "engine/core/text.h"
#include "engine/geometry/edge_update.h"
#include "engine/trace/coverage.h"
#include "engine/trace/final_line.h"
#include "engine/trace/join.h"
#include "engine/trace/loops.h"
#include "engine/trace/medial.h"
#include "engine/trace/path.h"
#include "engine/trace/polyline.h"
#include "engine/trace/verify.h"

namespace lumenline {

namespace {

constexpr double kMinStep = 1e-3;       // of the ball radius, between points of a path
constexpr double kUndersampled = 0.05;  // (R - clearance) / R
constexpr double kBeyondMeeting = 3;    // of the ball radius: what a loop's side is refined with beyond its end

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
        const std::string name = describe(endpoints_, target);
        Candidate line = make_line(*traced, options_.refine, from, to);
        if (!line.check.inside && options_.refine != Refinement::kNone) {
            line = make_line(*traced, Refinement::kNone, from, to);
            if (line.check.inside) note_not_relaxed(name);
        }
        if (!is_usable(line, name)) return;
        note_gaps(line);
        append(field.source, EndpointId(target), {}, line, joined(final_line(line, from, to, name), from, to, name));
    }

    /// Adds the two lines of a loop.
    void add(const LoopPath& path) {
        const LoopId id(lines_.loops.size());
        lines_.loops.push_back(loop_of(complex_, path));
        if (options_.topology == Topology::kTree) return;
        const std::string name =
            "where loop " + std::to_string(at(id)) + " closes at " + short_text(lines_.loops.back().point);
        std::array<Candidate, 2> sides = make_sides(path, options_.refine);
        const auto both_inside = [&sides] { return sides[0].check.inside && sides[1].check.inside; };
        if (!both_inside() && options_.refine != Refinement::kNone) {
            sides = make_sides(path, Refinement::kNone);
            if (both_inside()) note_not_relaxed(name);
        }
        if (!is_usable(sides[0], name) || !is_usable(sides[1], name)) return;
        const std::array<FinalLine, 2> lines = final_sides(sides, path.sources, name);
        lines_.loops.back().point = lines[0].line.points.back();
        for (std::size_t i = 0; i < 2; ++i) {
            note_gaps(sides[i]);
            append(path.sources[i], {}, id, sides[i], joined(lines[i], endpoints_[at(path.sources[i])], {}, name));
        }
    }

    void report_unreached(std::size_t target) {
        context_.error("target_unreached", "no front reached " + describe(endpoints_, target) +
                                               ": it has no connection to a source inside the lumen, and no line; see whether the "
                                               "lumen is open between them");
    }

    bool is_inside(const ComplexPath& path) { return verifier_.check(polyline_of(complex_, path)).inside; }

    [[nodiscard]] const Centerlines& lines() const { return lines_; }

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
                              " by " + short_text(100 * largest_gap_, 3) + " %; radii there are overestimated: make the surface finer",
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
        Polyline onward;                   ///< of a loop's side: the other side, from where they meet
        LineCheck check;
    };

    void note_not_relaxed(const std::string& name) {
        context_.note("line_not_relaxed",
                      "the line to " + name + " is kept as traced: relaxed, it would leave the lumen");
    }

    /// Reports what makes a line unusable or doubtful.
    bool is_usable(const Candidate& line, const std::string& name) {
        if (line.cut.size() < 2) {
            context_.error("line_vanished", "the line to " + name +
                                                " has no part between the planes of its two openings and is left out; see "
                                                "whether they are the ends of one vessel");
            return false;
        }
        if (!line.check.inside) {
            context_.error("line_leaves_lumen", "the line to " + name + " leaves the lumen at " +
                                                    short_text(line.check.outside_at) +
                                                    " and is left out; look for walls that cross there");
            return false;
        }
        if (line.check.ball_excess > 0)
            context_.error("ball_clearance",
                           "the line to " + name +
                               " has a ball that disagrees with its distance to the wall: its radii are doubtful; "
                               "report it with the model",
                           line.check.ball_excess, 0);
        return true;
    }

    void smooth(ComplexPath& path, Refinement refine) const {
        if (refine != Refinement::kNone) {
            thin_path(complex_, path, kMinStep);
            relax_path(complex_, path);
        }
        thin_path(complex_, path, kMinStep);
    }

    Candidate make_line(ComplexPath path, Refinement refine, const Endpoint& from, const Endpoint& to) {
        smooth(path, refine);
        return make_candidate(path, stop_at(from), stop_at(to));
    }

    Candidate make_candidate(const ComplexPath& path, const LineStop& from, const LineStop& to) {
        Candidate line;
        line.whole = line.cut = polyline_of(complex_, path);
        line.places.assign(1, {});
        line.places.insert(line.places.end(), path.inner.begin(), path.inner.end());
        line.places.emplace_back();
        if (from.cut) line.cut_front = cut_at_plane(line.cut, from.point, from.normal, true);
        if (to.cut) cut_at_plane(line.cut, to.point, to.normal, false);
        if (line.cut.size() >= 2) {  // the points at the planes lie between points that need not share a polygon
            line.cut.radius.front() = verifier_.empty_ball_radius(line.cut.points.front());
            line.cut.radius.back() = verifier_.empty_ball_radius(line.cut.points.back());
        }
        line.check = verifier_.check(line.cut);
        return line;
    }

    /// The two sides of a loop, each from its source to where they meet.
    std::array<Candidate, 2> make_sides(const LoopPath& loop, Refinement refine) {
        ComplexPath around = loop.path;
        smooth(around, refine);
        const Vec3 meeting = complex_.vertices[at(loop.meeting)];
        const auto nearer = [&](const ComplexPoint& a, const ComplexPoint& b) {
            return distance(position(complex_, a), meeting) < distance(position(complex_, b), meeting);
        };
        std::array<Candidate, 2> sides;
        for (std::size_t i = 0; i < 2; ++i) {
            Candidate& side = sides[i];
            const auto middle = std::min_element(around.inner.begin(), around.inner.end(), nearer);
            ComplexPath path{around.start,
                             position(complex_, *middle),
                             around.start_radius,
                             ball_radius(complex_, *middle),
                             {around.inner.begin(), middle}};
            side = make_candidate(path, stop_at(endpoints_[at(loop.sources[i])]), {});
            side.places.back() = *middle;
            ComplexPath onward{
                path.end, around.end, path.end_radius, around.end_radius, {middle + 1, around.inner.end()}};
            side.onward = polyline_of(complex_, onward);
            std::reverse(around.inner.begin(), around.inner.end());
            std::swap(around.start, around.end);
        }
        return sides;
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

    FinalLine final_line(const Candidate& line, const Endpoint& from, const Endpoint& to, const std::string& name) {
        if (refiner_) {
            std::string why;
            if (auto refined = refine_line(line.whole, stop_at(from), stop_at(to), *refiner_, verifier_, why))
                return *std::move(refined);
            note_not_refined(name, why);
        }
        return unrefined_line(line.whole, line.cut, line.cut_front, line.check);
    }

    FinalLine joined(FinalLine line, const Endpoint& from, const Endpoint& to, const std::string& name) {
        if (options_.join == Join::kAxis) return line;
        const bool refined = !std::isnan(line.position_error.front());
        if (auto bent = join_centres(line, from, to, refined ? &*refiner_ : nullptr, verifier_))
            return *std::move(bent);
        context_.note("line_not_joined", "the line to " + name +
                                             " ends on its axis: bent to the centres of its openings, it would leave "
                                             "the lumen or turn sharply");
        return line;
    }

    void note_not_refined(const std::string& name, const std::string& why) {
        context_.note("line_not_refined",
                      "the line to " + name + " is kept on the Voronoi polygons: refined, it would " + why);
    }

    /// Both sides of a loop, refined if both can be.
    std::array<FinalLine, 2> final_sides(const std::array<Candidate, 2>& sides,
                                         const std::array<EndpointId, 2>& sources, const std::string& name) {
        if (refiner_) {
            std::string why;
            auto first = refine_side(sides[0], endpoints_[at(sources[0])], why);
            auto second = first ? refine_side(sides[1], endpoints_[at(sources[1])], why) : std::nullopt;
            if (second) {
                if (auto met = end_together(*first, *second, *refiner_, verifier_))
                    return {*std::move(first), *std::move(met)};
                why = "not meet the other side of its loop";
            }
            note_not_refined(name, why);
        }
        const auto unrefined = [](const Candidate& side) {
            return unrefined_line(side.whole, side.cut, side.cut_front, side.check);
        };
        return {unrefined(sides[0]), unrefined(sides[1])};
    }

    std::optional<FinalLine> refine_side(const Candidate& side, const Endpoint& from, std::string& why) {
        Polyline path = side.whole;
        const Vec3 meeting = path.points.back();
        const double radius = path.radius.back(), length = side.onward.abscissa.back();
        const auto within = [&](const Polyline& line, std::size_t i, double away) {
            return line.abscissa[i] < std::min(away, 0.5 * length);
        };
        std::size_t behind = path.size() - 1;
        while (behind > 0 && path.abscissa.back() - path.abscissa[behind] < radius) --behind;
        std::size_t ahead = 1;
        while (ahead + 1 < side.onward.size() && within(side.onward, ahead, radius)) ++ahead;
        const Vec3 direction = normalized(side.onward.points[ahead] - path.points[behind]);
        for (std::size_t i = 1; i < side.onward.size() && within(side.onward, i, kBeyondMeeting * radius); ++i)
            path.append(side.onward.points[i], side.onward.radius[i]);
        const LineStop stop{meeting, direction, true, false, direction};
        auto line = refine_line(path, stop_at(from), stop, *refiner_, verifier_, why);
        if (!line) return line;
        line->path_to_line.resize(side.whole.size());
        line->path_to_line.back() = line->line.abscissa.back();
        return line;
    }

    void append(EndpointId source, EndpointId target, LoopId loop, const Candidate& line, const FinalLine& final) {
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
        lines_.loop.push_back(loop);
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
    const bool network = options.topology == Topology::kNetwork;
    if (surface.genus > 0 || (network && fields.size() > 1)) {
        const auto inside = [&](const ComplexPath& path) { return collector.is_inside(path); };
        const LoopSearch found = find_loops(complex, endpoints, fields, network ? Fronts::kOfAll : Fronts::kOfOneSource,
                                            inside, context);
        for (const LoopPath& loop : found.paths) collector.add(loop);
        report_loops(surface, collector.lines().loops, found.between_sources, network, context);
    }
    report_coverage(surface, complex, endpoints, fields, collector.lines(), context);
    return collector.finish();
}

}  // namespace lumenline
