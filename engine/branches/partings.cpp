// The tube of a line is the union of the balls on its segments, radii linear between points: x is in it where the least
// of |x - c(t)|^2 - r(t)^2 is negative, whose t on a segment has a closed form. Both lines start together, so that the
// search on the other line goes along with the point; while the lines are within half a radius of each other, which
// is nearly all of the common way, one distance per point decides.
#include "engine/branches/partings.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumenline {

namespace {

constexpr double kSurelyInside = 0.5;  // of the radius
constexpr double kReach = 3;           // of the radius: along the other line, on either side of where it was nearest

/// Least of |x - c|^2 - r^2 on a segment.
double power(Vec3 x, Vec3 a, Vec3 b, double ra, double rb) {
    const Vec3 e = b - a, d = x - a;
    const double slope = rb - ra;
    const double quadratic = squared_norm(e) - slope * slope;
    const double linear = dot(d, e) + ra * slope;
    double t = 0;
    if (quadratic > 0)
        t = std::clamp(linear / quadratic, 0.0, 1.0);
    else if (rb > ra)
        t = 1;  // the larger ball holds the smaller one
    const double r = ra + t * slope;
    return squared_norm(d - t * e) - r * r;
}

/// The tube of a line, asked at points that move along it.
class Tube {
public:
    explicit Tube(const LineView& line) : line_(line) {}

    /// Negative inside [length^2].
    double operator()(Vec3 x) {
        const std::size_t last = line_.points.size() - 1;
        double here = squared_norm(x - line_.points[nearest_]);
        for (; nearest_ < last; ++nearest_) {
            const double next = squared_norm(x - line_.points[nearest_ + 1]);
            if (next > here) break;
            here = next;
        }
        const double r = line_.radius[nearest_];
        if (here < kSurelyInside * kSurelyInside * r * r) return here - r * r;
        const double from = line_.abscissa[nearest_] - kReach * r, to = line_.abscissa[nearest_] + kReach * r;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = nearest_; k > 0 && line_.abscissa[k] > from; --k) least = std::min(least, at(k - 1, x));
        for (std::size_t k = nearest_; k < last && line_.abscissa[k] < to; ++k) least = std::min(least, at(k, x));
        return least;
    }

private:
    [[nodiscard]] double at(std::size_t k, Vec3 x) const {
        return power(x, line_.points[k], line_.points[k + 1], line_.radius[k], line_.radius[k + 1]);
    }

    const LineView& line_;
    std::size_t nearest_ = 0;
};

/// Where, going back from `exit`, balls no longer reach it.
double touching(const LineView& line, double exit) {
    const Vec3 x = line.position(exit);
    std::size_t k = line.segment(exit);
    const auto gap = [&](std::size_t i) { return distance(line.points[i], x) - line.radius[i]; };
    double after = exit, gap_after = -line.radius_at(exit);
    for (;; --k) {
        const double g = gap(k);
        if (g >= 0) return std::lerp(line.abscissa[k], after, g / (g - gap_after));
        if (k == 0) return 0;
        after = line.abscissa[k];
        gap_after = g;
    }
}

}  // namespace

std::size_t LineView::segment(double s) const {
    const auto above = std::upper_bound(abscissa.begin() + 1, abscissa.end() - 1, s);
    return static_cast<std::size_t>(above - abscissa.begin()) - 1;
}

namespace {

double share_at(const LineView& line, std::size_t k, double s) {
    const double step = line.abscissa[k + 1] - line.abscissa[k];
    return step > 0 ? std::clamp((s - line.abscissa[k]) / step, 0.0, 1.0) : 0.0;
}

}  // namespace

Vec3 LineView::position(double s) const {
    const std::size_t k = segment(s);
    return lerp(points[k], points[k + 1], share_at(*this, k, s));
}

double LineView::radius_at(double s) const {
    const std::size_t k = segment(s);
    return std::lerp(radius[k], radius[k + 1], share_at(*this, k, s));
}

double LineView::foot(Vec3 x, double from, double to) const {
    double best = from, least = std::numeric_limits<double>::infinity();
    for (std::size_t k = segment(from); k + 1 < points.size() && abscissa[k] <= to; ++k) {
        const Vec3 e = points[k + 1] - points[k];
        const double e2 = squared_norm(e);
        const double t = e2 > 0 ? std::clamp(dot(x - points[k], e) / e2, 0.0, 1.0) : 0.0;
        const double s = std::clamp(std::lerp(abscissa[k], abscissa[k + 1], t), from, to);
        if (const double d = squared_norm(x - position(s)); d < least) {
            least = d;
            best = s;
        }
    }
    return best;
}

std::vector<LineView> views_of(const Centerlines& lines) {
    std::vector<LineView> views;
    for (std::size_t i = 0; i < lines.line_count(); ++i) {
        const std::size_t from = lines.offsets[i], count = lines.offsets[i + 1] - from;
        views.push_back({{lines.points.data() + from, count},
                         {lines.radius.data() + from, count},
                         {lines.abscissa.data() + from, count}});
    }
    return views;
}

ReversedLine reversed(const LineView& line) {
    ReversedLine back;
    back.points.assign(line.points.rbegin(), line.points.rend());
    back.radius.assign(line.radius.rbegin(), line.radius.rend());
    for (std::size_t k = line.points.size(); k-- > 0;) back.abscissa.push_back(line.length() - line.abscissa[k]);
    return back;
}

Parting part(const LineView& line, const LineView& other) {
    Tube tube(other);
    double before = 0;
    for (std::size_t k = 0; k < line.points.size(); ++k) {
        const double value = tube(line.points[k]);
        if (value > 0) {
            const double from = k > 0 ? line.abscissa[k - 1] : 0.0;
            const double share = k > 0 ? before / (before - value) : 0.0;
            const double exit = std::lerp(from, line.abscissa[k], share);
            return {true, touching(line, exit), exit};
        }
        before = value;
    }
    return {};
}

}  // namespace lumenline
