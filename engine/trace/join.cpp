// Within the bend pieces are cut short enough for the bend to look smooth; elsewhere the line keeps its points and all
// their values. The bend is a radius long, but no longer than half the line: the two never overlap.
#include "engine/trace/join.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lumenline {

namespace {

constexpr double kPieces = 16;        // of a bend, at least
constexpr double kMeetingGap = 0.25;  // of the radius: between the ends of a loop's two refined sides

/// Share of the shift at a distance from the end, in lengths of the bend: 1 at 0, 0 from 1 on, with level ends.
double share(double t) { return t < 1 ? 1 - t * t * t * (10 - 15 * t + 6 * t * t) : 0.0; }

/// What one end of a line is shifted by.
struct Bend {
    double end = 0, length = 0;  ///< abscissas
    Vec3 shift;

    Bend(const Polyline& line, Vec3 by, bool front) : shift(by) {
        const std::size_t i = front ? 0 : line.size() - 1;
        end = line.abscissa[i];
        length = squared_norm(shift) > 0 ? std::min(line.radius[i], 0.5 * line.abscissa.back()) : 0.0;
    }
    [[nodiscard]] bool holds(double s) const { return std::fabs(s - end) < length; }
    [[nodiscard]] Vec3 at(double s) const { return holds(s) ? share(std::fabs(s - end) / length) * shift : Vec3{}; }
};

/// The line with its ends shifted.
std::optional<FinalLine> bent_line(const FinalLine& axis, Vec3 shift_front, Vec3 shift_back, MedialRefiner* refiner,
                                   LineVerifier& verifier) {
    const Polyline& old = axis.line;
    const Bend start(old, shift_front, true), end(old, shift_back, false);
    const Graph radius_error(old.abscissa, axis.radius_error), position_error(old.abscissa, axis.position_error);
    FinalLine bent;
    Polyline balls;
    std::vector<double> abscissa;  // on the line as it was
    const auto add = [&](std::size_t i, Vec3 x, double s, bool between) {
        const Vec3 tangent = normalized(old.points[std::min(i + 1, old.size() - 1)] - old.points[i > 0 ? i - 1 : 0]);
        const Vec3 shift = start.at(s) + end.at(s);
        x += shift;
        double ball = axis.ball_radius[i], radius = old.radius[i];
        if (between || start.holds(s) || end.holds(s)) {
            ball = verifier.empty_ball_radius(x);
            radius = refiner != nullptr ? refiner->radius_at(x, tangent, ball) : ball;
        }
        abscissa.push_back(s);
        bent.line.append(x, radius);
        balls.append(x, ball);
        bent.radius_error.push_back(radius_error(s));
        bent.position_error.push_back(position_error(s) + norm(shift));
    };
    for (std::size_t i = 0; i < old.size(); ++i) {
        if (i > 0) {
            const double a = old.abscissa[i - 1], b = old.abscissa[i];
            double longest = b - a;
            for (const Bend& bend : {start, end})
                if (bend.holds(a) || bend.holds(b)) longest = std::min(longest, bend.length / kPieces);
            const double pieces = longest > 0 ? std::ceil((b - a) / longest) : 1;
            for (double k = 1; k < pieces; ++k)
                add(i, lerp(old.points[i - 1], old.points[i], k / pieces), std::lerp(a, b, k / pieces), true);
        }
        add(i, old.points[i], old.abscissa[i], false);
    }
    if (sharpest_turn(bent.line).cosine < kSharpestTurn) return std::nullopt;
    LineCheck check = verifier.check(balls);
    if (!check.inside) return std::nullopt;
    bent.ball_radius = balls.radius;
    bent.clearance = std::move(check.clearance);
    if (refiner == nullptr)
        for (std::size_t i = 0; i < bent.line.size(); ++i)
            bent.radius_error[i] = std::max(bent.ball_radius[i] - bent.clearance[i], 0.0);
    const Graph along(abscissa, bent.line.abscissa);
    for (const double s : axis.path_to_line) bent.path_to_line.push_back(along(s));
    return bent;
}

}  // namespace

std::optional<FinalLine> join_centres(const FinalLine& axis, const Endpoint& from, const Endpoint& to,
                                      MedialRefiner* refiner, LineVerifier& verifier) {
    const auto shift = [](const Endpoint& end, Vec3 x) { return end.opening.is_none() ? Vec3{} : end.point - x; };
    return bent_line(axis, shift(from, axis.line.points.front()), shift(to, axis.line.points.back()), refiner,
                     verifier);
}

std::optional<FinalLine> end_together(const FinalLine& first, const FinalLine& second, MedialRefiner& refiner,
                                      LineVerifier& verifier) {
    const Vec3 end = first.line.points.back(), gap = end - second.line.points.back();
    if (norm(gap) > kMeetingGap * first.line.radius.back()) return std::nullopt;
    std::optional<FinalLine> bent = bent_line(second, {}, gap, &refiner, verifier);
    if (!bent) return bent;
    bent->line.points.back() = end;
    bent->line.radius.back() = first.line.radius.back();
    bent->ball_radius.back() = first.ball_radius.back();
    bent->clearance.back() = first.clearance.back();
    bent->radius_error.back() = first.radius_error.back();
    bent->position_error.back() = first.position_error.back();
    return bent;
}

}  // namespace lumenline
