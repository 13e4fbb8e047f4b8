// Errors of a line by the midpoint rule. Mean and variance are accumulated by West's weighted
// update, since the sum of squares minus the squared mean loses a small sigma on a large mean.
#include "engine/phantom/accuracy.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "engine/core/text.h"

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
    [[nodiscard]] double sigma() const { return std::sqrt(spread / weight); }
};

}  // namespace

LineError line_error(const PhantomTruth& truth, std::span<const Vec3> points, std::span<const double> radius,
                     double exclude_ends, double position_norm, double radius_norm) {
    if (points.size() != radius.size()) {
        throw std::invalid_argument("a line of " + counted(points.size(), "point") + " has " +
                                    counted(radius.size(), "radius value"));
    }
    if (!(position_norm > 0 && radius_norm > 0 && exclude_ends >= 0)) {
        throw std::invalid_argument("error norms must be positive and the excluded length not negative");
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!std::isfinite(norm(points[i])) || !std::isfinite(radius[i])) {
            throw std::invalid_argument("point " + std::to_string(i) + " of the line is not finite: " +
                                        short_text(points[i]) + ", radius " + short_text(radius[i]));
        }
    }
    constexpr double kPiecesPerRadius = 256;
    const double step = truth.min_section_radius() / kPiecesPerRadius;
    WeightedMoments position;
    WeightedMoments size;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const double length = distance(points[i], points[i + 1]);
        if (!(length > 0)) continue;
        const auto pieces = static_cast<std::size_t>(std::ceil(length / step));
        const double weight = length / static_cast<double>(pieces);
        for (std::size_t k = 0; k < pieces; ++k) {
            const double t = (static_cast<double>(k) + 0.5) / static_cast<double>(pieces);
            const Vec3 x = lerp(points[i], points[i + 1], t);
            const double s = truth.abscissa_of(x);
            if (s <= exclude_ends || s >= truth.total_length() - exclude_ends) continue;
            position.add(100 * distance(x, truth.position(s)) / position_norm, weight);
            const double r = std::lerp(radius[i], radius[i + 1], t);
            size.add(100 * std::fabs(r - truth.inscribed_radius(s)) / radius_norm, weight);
        }
    }
    if (!(position.weight > 0)) {
        throw std::invalid_argument("nothing of the line of " + counted(points.size(), "point") + " lies more than " +
                                    short_text(exclude_ends) + " inside the ends of the axis");
    }
    return {position.mean, position.sigma(), size.mean, size.sigma(), position.weight};
}

}  // namespace lumenline
