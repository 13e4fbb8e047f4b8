// Errors of a line by the midpoint rule. Mean and variance are accumulated by West's weighted
// update, since the sum of squares minus the squared mean loses a small sigma on a large mean; of equal values
// rounding may leave it just below zero.
#include "engine/phantom/accuracy.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "engine/core/text.h"
#include "engine/phantom/tree.h"

namespace lumenline {
namespace {

struct WeightedMoments {
    double weight = 0, mean = 0, spread = 0;

    void add(double value, double w) {
        weight += w;
        const double shift = value - mean;
        mean += shift * w / weight;
        spread += w * shift * (value - mean);
    }
    [[nodiscard]] double sigma() const { return std::sqrt(std::max(0.0, spread) / weight); }
};

void check_line(std::span<const Vec3> points, std::span<const double> radius) {
    if (points.size() != radius.size()) {
        throw std::invalid_argument("a line of " + counted(points.size(), "point") + " has " +
                                    counted(radius.size(), "radius value"));
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!std::isfinite(norm(points[i])) || !std::isfinite(radius[i])) {
            throw std::invalid_argument("point " + std::to_string(i) + " of the line is not finite: " +
                                        short_text(points[i]) + ", radius " + short_text(radius[i]));
        }
    }
}

struct Judged {
    double position, radius;  // errors [%]
};

/// Moments of what `judge(point, radius)` finds at the middles of pieces no longer than `step(point)`;
/// no answer = left out.
template <class Step, class Judge>
LineError weighed(std::span<const Vec3> points, std::span<const double> radius, const Step& step, const Judge& judge) {
    WeightedMoments position;
    WeightedMoments size;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const double length = distance(points[i], points[i + 1]);
        if (!(length > 0)) continue;
        const auto pieces = static_cast<std::size_t>(std::ceil(length / step(points[i])));
        const double weight = length / static_cast<double>(pieces);
        for (std::size_t k = 0; k < pieces; ++k) {
            const double t = (static_cast<double>(k) + 0.5) / static_cast<double>(pieces);
            const std::optional<Judged> error =
                judge(lerp(points[i], points[i + 1], t), std::lerp(radius[i], radius[i + 1], t));
            if (!error) continue;
            position.add(error->position, weight);
            size.add(error->radius, weight);
        }
    }
    if (!(position.weight > 0)) {
        throw std::invalid_argument("nothing of the line of " + counted(points.size(), "point") +
                                    " lies where it is to be compared");
    }
    return {position.mean, position.sigma(), size.mean, size.sigma(), position.weight};
}

}  // namespace

LineError line_error(const PhantomTruth& truth, std::span<const Vec3> points, std::span<const double> radius,
                     double exclude_ends, double position_norm, double radius_norm) {
    check_line(points, radius);
    if (!(position_norm > 0 && radius_norm > 0 && exclude_ends >= 0)) {
        throw std::invalid_argument("error norms must be positive and the excluded length not negative");
    }
    constexpr double kPiecesPerRadius = 256;
    const double step = truth.min_section_radius() / kPiecesPerRadius;
    return weighed(
        points, radius, [step](Vec3) { return step; },
        [&](Vec3 x, double r) -> std::optional<Judged> {
            const double s = truth.abscissa_of(x);
            if (s <= exclude_ends || s >= truth.total_length() - exclude_ends) return std::nullopt;
            return Judged{100 * distance(x, truth.position(s)) / position_norm,
                          100 * std::fabs(r - truth.inscribed_radius(s)) / radius_norm};
        });
}

LineError line_error(const TreeTruth& truth, std::span<const Vec3> points, std::span<const double> radius) {
    check_line(points, radius);
    constexpr double kPiecesPerRadius = 64;  // an edge is a tenth of a radius for 64 points around
    constexpr double kExcluded = 0.25;       // radii at open ends
    const auto local_radius = [&](TreeAbscissa at) { return truth.branches()[at.branch].radius(at.s); };
    return weighed(
        points, radius, [&](Vec3 x) { return local_radius(truth.nearest_axis(x)) / kPiecesPerRadius; },
        [&](Vec3 x, double r) -> std::optional<Judged> {
            const TreeAbscissa at = truth.nearest_axis(x);
            const TreeBranch& b = truth.branches()[at.branch];
            const double size = local_radius(at);
            const bool at_opening =
                (b.open_start && at.s < kExcluded * size) || (b.open_end && at.s > b.length() - kExcluded * size);
            if (at_opening || truth.near_junction(at)) return std::nullopt;
            return Judged{100 * distance(x, truth.position(at)) / size,
                          100 * std::fabs(r - truth.inscribed_radius(at)) / size};
        });
}

}  // namespace lumenline
