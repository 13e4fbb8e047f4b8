// The refined line is cut at the planes after refinement, so that it reaches them along the axis; what belongs to
// its points is carried by arc length from the whole line to the part that is left.
#include "engine/trace/final_line.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/text.h"

namespace lumenline {

namespace {

// Of the cost: what its sampling at other nodes may change, and the part of the wall's noise that nodes rest within.
constexpr double kCostRounding = 1e-6, kCostNoise = 0.02;
constexpr double kStray = 1.0;  // of the path's ball radius

}  // namespace

double Graph::operator()(double at) const {
    const auto above = std::upper_bound(x_.begin(), x_.end(), at);
    if (above == x_.begin()) return y_.front();
    if (above == x_.end()) return y_.back();
    const auto i = static_cast<std::size_t>(above - x_.begin());
    return std::lerp(y_[i - 1], y_[i], (at - x_[i - 1]) / (x_[i] - x_[i - 1]));
}

LineStop stop_at(const Endpoint& endpoint) {
    const bool opening = !endpoint.opening.is_none();
    return {endpoint.point, endpoint.normal, opening, opening, endpoint.axis};
}

FinalLine unrefined_line(const Polyline& whole, const Polyline& cut, double cut_front, const LineCheck& check) {
    FinalLine final;
    final.line = cut;
    final.ball_radius = cut.radius;
    final.clearance = check.clearance;
    for (std::size_t i = 0; i < cut.size(); ++i)
        final.radius_error.push_back(std::max(cut.radius[i] - check.clearance[i], 0.0));
    final.position_error.assign(cut.size(), std::numeric_limits<double>::quiet_NaN());
    for (const double s : whole.abscissa)
        final.path_to_line.push_back(std::clamp(s - cut_front, 0.0, cut.abscissa.back()));
    return final;
}

std::optional<FinalLine> refine_line(const Polyline& path, const LineStop& from, const LineStop& to,
                                     MedialRefiner& refiner, LineVerifier& verifier, std::string& why) {
    const LineEnd start{from.free, -from.axis}, end{to.free, to.axis};
    const RefinedLine refined = refiner.refine(path, start, end);
    if (refined.line.size() < 2) {
        why = "not be found, for want of length or of a step that improves it";
        return std::nullopt;
    }
    if (!(refined.cost_after <= refined.cost_before * (1 + kCostRounding + kCostNoise * refined.noise))) {
        why = "be farther from the axis by its own measure";
        return std::nullopt;
    }
    if (refined.largest_stray > kStray) {
        why = "stray from the balls of its path";
        return std::nullopt;
    }
    if (const Turn turn = sharpest_turn(refined.line); turn.cosine < kSharpestTurn) {
        why = "turn sharply at " + short_text(turn.at);
        return std::nullopt;
    }
    FinalLine final;
    final.line = refined.line;
    double cut_front = 0;
    if (from.cut) cut_front = cut_at_plane(final.line, from.point, from.normal, true);
    if (to.cut) cut_at_plane(final.line, to.point, to.normal, false);
    if (final.line.size() < 2) {
        why = "have no part between the planes of its openings";
        return std::nullopt;
    }
    const Graph radius(refined.line.abscissa, refined.line.radius);
    const Graph radius_error(refined.line.abscissa, refined.radius_error);
    const Graph position_error(refined.line.abscissa, refined.position_error);
    Polyline checked = final.line;
    for (std::size_t i = 0; i < final.line.size(); ++i) {
        const double s = final.line.abscissa[i] + cut_front;
        final.line.radius[i] = radius(s);
        final.radius_error.push_back(radius_error(s));
        final.position_error.push_back(position_error(s));
        checked.radius[i] = verifier.empty_ball_radius(final.line.points[i]);
    }
    final.ball_radius = checked.radius;
    LineCheck check = verifier.check(checked);
    if (!check.inside) {
        why = "leave the lumen";
        return std::nullopt;
    }
    final.clearance = std::move(check.clearance);
    const Graph along(refined.path_abscissa, refined.line.abscissa);
    for (const double s : path.abscissa)
        final.path_to_line.push_back(std::clamp(along(s) - cut_front, 0.0, final.line.abscissa.back()));
    return final;
}

}  // namespace lumenline
