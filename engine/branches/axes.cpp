// Curvature and torsion are second and third derivatives: they are not of the polyline but of polynomials fitted to
// the line's own points in a window of stated width. Degree five keeps the bias at a circle below a thousandth where
// the window is as wide as the radius of curvature; cubics would need windows so narrow that torsion is noise. Fits
// reach beyond the own part of a branch into its junctions, where the line goes on: its ends are no ends of the line.
#include "engine/branches/axes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace lumenline {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr Vec3 kNoVector{kNaN, kNaN, kNaN};
constexpr int kDegree = 5, kEndDegree = 3;
constexpr double kShifted = 0.25;      // of the half width: a window moved by more counts as one at an end
constexpr std::ptrdiff_t kFewest = 5;  // points in a window, which else is made wider
constexpr double kWiden = 1.5;
constexpr double kParallel = 0.1;   // sine of the angle between a branch and one that gives its direction of angle 0
constexpr double kStraight = 0.02;  // turn along half the window below which the axis is straight [radians]
constexpr double kStraightLine = 0.01;  // of the mean radius

using Powers = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kDegree + 1, kDegree + 1>;
using Sides = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kDegree + 1, 3>;

double tricube(double u) {
    const double v = 1 - std::fabs(u * u * u);
    return v > 0 ? v * v * v : 0;
}

}  // namespace

CurveFit fit_curve(std::span<const Vec3> points, std::span<const double> abscissa, double s, double half_width) {
    const CurveFit none{kNoVector, kNoVector, kNoVector};
    const double first = abscissa.front(), last = abscissa.back();
    double width = std::min(half_width, 0.5 * (last - first)), centre = s;
    if (!(width > 0)) return none;
    auto begin = abscissa.begin(), end = abscissa.end();
    for (;; width = std::min(kWiden * width, 0.5 * (last - first))) {
        centre = std::clamp(s, first + width, last - width);
        begin = std::lower_bound(abscissa.begin(), abscissa.end(), centre - width);
        end = std::upper_bound(begin, abscissa.end(), centre + width);
        if (end - begin >= kFewest || width >= 0.5 * (last - first)) break;
    }
    const auto from = static_cast<std::size_t>(begin - abscissa.begin());
    const auto count = static_cast<int>(end - begin);
    // Weights vanish at the window's border; where the curve itself ends there, its last points would not count.
    const double reach = std::fabs(s - centre) + 1.001 * width;
    const int most = std::fabs(s - centre) > kShifted * half_width || width < half_width ? kEndDegree : kDegree;
    const int degree = std::min(most, (count - 1) / 2 + (count < 5 ? 1 : 0));
    if (degree < 1) return none;
    Powers matrix = Powers::Zero(degree + 1, degree + 1);
    Sides right = Sides::Zero(degree + 1, 3);
    for (int k = 0; k < count; ++k) {
        const std::size_t i = from + static_cast<std::size_t>(k);
        const double u = (abscissa[i] - s) / width;
        const double weight = tricube((abscissa[i] - s) / reach);
        std::array<double, 2 * kDegree + 1> power{1};
        for (std::size_t n = 1; n < power.size(); ++n) power[n] = power[n - 1] * u;
        for (int a = 0; a <= degree; ++a) {
            const double wa = weight * power[static_cast<std::size_t>(a)];
            for (int b = 0; b <= degree; ++b) matrix(a, b) += weight * power[static_cast<std::size_t>(a + b)];
            for (int axis = 0; axis < 3; ++axis) right(a, axis) += wa * (points[i][axis] - points[from][axis]);
        }
    }
    const Sides c = matrix.ldlt().solve(right);
    const auto derivative = [&](int n, double factor) {
        return n <= degree ? factor * Vec3{c(n, 0), c(n, 1), c(n, 2)} : kNoVector;
    };
    return {derivative(1, 1 / width), derivative(2, 2 / (width * width)), derivative(3, 6 / (width * width * width))};
}

CurveGeometry curve_geometry(const CurveFit& fit, double half_width) {
    CurveGeometry g;
    g.tangent = normalized(fit.first);
    const Vec3 bend = cross(fit.first, fit.second);
    const double speed = norm(fit.first);
    g.curvature = norm(bend) / (speed * speed * speed);
    const bool bends = g.curvature * half_width >= kStraight;
    g.torsion = bends ? dot(bend, fit.third) / squared_norm(bend) : kNaN;
    g.normal = bends ? normalized(cross(bend, fit.first)) : kNoVector;
    return g;
}

void transport(std::span<const Vec3> points, std::span<const Vec3> tangents, std::span<Vec3> normals) {
    const auto reflect = [](Vec3 v, Vec3 mirror) {
        const double m2 = squared_norm(mirror);
        return m2 > 0 ? v - (2 * dot(v, mirror) / m2) * mirror : v;
    };
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const Vec3 step = points[k + 1] - points[k];
        const Vec3 normal = reflect(normals[k], step), tangent = reflect(tangents[k], step);
        const Vec3 next = reflect(normal, tangents[k + 1] - tangent);
        normals[k + 1] = normalized(next - dot(next, tangents[k + 1]) * tangents[k + 1]);
    }
}

namespace {

/// The line behind a branch: its own part and what goes on from it at both ends.
struct Support {
    std::vector<Vec3> points;
    std::vector<double> radius, abscissa;  // of the own part's start 0
    [[nodiscard]] LineView view() const { return {points, radius, abscissa}; }
};

void add_stretch(Support& support, const LineView& line, double from, double to, bool backward) {
    Support part;
    const auto add = [&](double s) {
        part.points.push_back(line.position(s));
        part.radius.push_back(line.radius_at(s));
    };
    add(from);
    for (std::size_t k = 0; k < line.points.size(); ++k)
        if (line.abscissa[k] > from && line.abscissa[k] < to) add(line.abscissa[k]);
    if (to > from) add(to);
    if (backward) {
        std::reverse(part.points.begin(), part.points.end());
        std::reverse(part.radius.begin(), part.radius.end());
    }
    for (std::size_t k = 0; k < part.points.size(); ++k) {
        const double step = support.points.empty() ? 0 : distance(support.points.back(), part.points[k]);
        if (!support.points.empty() && !(step > 0)) continue;
        support.abscissa.push_back(support.points.empty() ? 0 : support.abscissa.back() + step);
        support.points.push_back(part.points[k]);
        support.radius.push_back(part.radius[k]);
    }
}

/// @returns the own part's start on the support
double make_support(const BranchCourse& b, std::span<const LineView> views, double beyond, Support& support) {
    const auto outer = [&](const Course& c, bool start) {
        const LineView& line = views[c.line];
        const double s = start != c.backward ? c.from : c.to;
        const double reach = beyond * line.radius_at(s);
        return std::clamp(start != c.backward ? s - reach : s + reach, 0.0, line.length());
    };
    double own_from = 0;
    for (std::size_t k = 0; k < b.courses.size(); ++k) {
        const Course& c = b.courses[k];
        double from = c.from, to = c.to;
        if (k == 0) {
            (c.backward ? to : from) = outer(c, true);
            own_from = c.backward ? to - c.to : c.from - from;
        }
        if (k + 1 == b.courses.size()) (c.backward ? from : to) = outer(c, false);
        add_stretch(support, views[c.line], from, to, c.backward);
    }
    return own_from;
}

class AxisMaker {
public:
    AxisMaker(const GraphDraft& draft, std::span<const LineView> views, const BranchOptions& options)
        : draft_(draft), views_(views), options_(options) {}

    BranchLines run() {
        axes_.offsets.assign(1, 0);
        for (std::size_t b = 0; b < draft_.branches.size(); ++b) add_branch(b);
        return std::move(axes_);
    }

private:
    void add_branch(std::size_t index) {
        const BranchCourse& b = draft_.branches[index];
        Support support;
        const double start = make_support(b, views_, options_.smoothing, support);
        const std::size_t begin = axes_.points.size();
        const double own = b.own_length();
        if (b.first_join > 0) add_node(b.first, 0, b.first_direction);
        std::size_t count = 0;
        if (support.points.size() > 1) {
            const double step = options_.step * mean_radius(support.view(), start, start + own);
            count = static_cast<std::size_t>(std::ceil(own / step));
            for (std::size_t k = 0; k <= count; ++k) {
                const double share = count > 0 ? static_cast<double>(k) / static_cast<double>(count) : 0.0;
                add_point(support.view(), start + share * own, b.first_join + share * own);
            }
        }
        if (b.last_join > 0 || axes_.points.size() < begin + 2) add_node(b.last, b.length(), -b.last_direction);
        axes_.offsets.push_back(static_cast<std::uint32_t>(axes_.points.size()));
        axes_.own_from.push_back(b.first_join);
        axes_.own_to.push_back(b.first_join + own);
        orient(index, begin);
    }

    static double mean_radius(const LineView& line, double from, double to) {
        constexpr int kSamples = 32;
        double sum = 0;
        for (int k = 0; k <= kSamples; ++k) sum += line.radius_at(std::lerp(from, to, k / double{kSamples}));
        return sum / (kSamples + 1);
    }

    void append(Vec3 x, double radius, double abscissa, const CurveGeometry& g) {
        axes_.points.push_back(x);
        axes_.radius.push_back(radius);
        axes_.abscissa.push_back(abscissa);
        axes_.curvature.push_back(g.curvature);
        axes_.torsion.push_back(g.torsion);
        axes_.tangent.push_back(g.tangent);
        axes_.normal.push_back(g.normal);
    }

    void add_node(std::size_t node, double abscissa, Vec3 tangent) {
        append(draft_.graph.position[node], draft_.graph.radius[node], abscissa, {kNaN, kNaN, tangent, kNoVector});
    }

    void add_point(const LineView& line, double s, double abscissa) {
        const double radius = line.radius_at(s), half_width = options_.smoothing * radius;
        const CurveFit fit = fit_curve(line.points, line.abscissa, s, half_width);
        append(line.position(s), radius, abscissa, curve_geometry(fit, half_width));
    }

    /// Sets the frames of a branch whose points begin at `begin`.
    void orient(std::size_t index, std::size_t begin) {
        const std::size_t count = axes_.points.size() - begin;
        axes_.frame.resize(axes_.points.size());
        const std::span<const Vec3> points(axes_.points.data() + begin, count);
        const std::span<const Vec3> tangents(axes_.tangent.data() + begin, count);
        const std::span<Vec3> frames(axes_.frame.data() + begin, count);
        frames[0] = any_perpendicular(tangents[0]);
        transport(points, tangents, frames);
        const auto [at, direction] = zero_direction(index, points, tangents);
        // All frames turn by the angle that brings the one at `at` into the direction.
        const Vec3 e1 = frames[at], e2 = cross(tangents[at], e1);
        const double angle = std::atan2(dot(direction, e2), dot(direction, e1));
        const double c = std::cos(angle), s = std::sin(angle);
        for (std::size_t k = 0; k < count; ++k) frames[k] = c * frames[k] + s * cross(tangents[k], frames[k]);
    }

    /// A direction of angle 0 and the point of the branch where it counts.
    [[nodiscard]] std::pair<std::size_t, Vec3> zero_direction(std::size_t index, std::span<const Vec3> points,
                                                              std::span<const Vec3> tangents) const {
        const BranchCourse& b = draft_.branches[index];
        const std::size_t last = points.size() - 1;
        if (const Vec3 d = direction_at(b.first, index, tangents[0]); squared_norm(d) > 0) return {0, d};
        if (const Vec3 d = direction_at(b.last, index, tangents[last]); squared_norm(d) > 0) return {last, d};
        const Vec3 chord = normalized(points[last] - points[0]);
        std::size_t farthest = 0;
        Vec3 bow;
        for (std::size_t k = 0; k <= last; ++k) {
            const Vec3 x = points[k] - points[0], away = x - dot(x, chord) * chord;
            if (squared_norm(away) > squared_norm(bow)) {
                bow = away;
                farthest = k;
            }
        }
        const double radius = axes_.radius[axes_.radius.size() - points.size()];
        if (norm(bow) > kStraightLine * radius) return {farthest, across(bow, tangents[farthest])};
        return {0, any_perpendicular(tangents[0])};
    }

    static Vec3 across(Vec3 direction, Vec3 tangent) { return direction - dot(direction, tangent) * tangent; }

    /// Of the first branch that leaves a junction, neither the branch itself nor along it; zero if there is none.
    [[nodiscard]] Vec3 direction_at(std::size_t node, std::size_t self, Vec3 tangent) const {
        if (draft_.graph.junction[node].is_none()) return {};
        for (const bool leaving : {true, false})
            for (std::size_t k = 0; k < draft_.branches.size(); ++k) {
                const BranchCourse& b = draft_.branches[k];
                if (k == self || (leaving ? b.first : b.last) != node) continue;
                const Vec3 d = across(leaving ? b.first_direction : b.last_direction, tangent);
                if (norm(d) > kParallel) return d;
            }
        return {};
    }

    const GraphDraft& draft_;
    std::span<const LineView> views_;
    const BranchOptions& options_;
    BranchLines axes_;
};

}  // namespace

BranchLines make_axes(const GraphDraft& draft, std::span<const LineView> views, const BranchOptions& options) {
    return AxisMaker(draft, views, options).run();
}

AxisPlace place_on(const BranchLines& axes, BranchId branch, double abscissa) {
    const std::size_t begin = axes.offsets[at(branch)], end = axes.offsets[at(branch) + 1];
    if (end - begin < 2) return {begin, 0};
    const auto first = axes.abscissa.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = axes.abscissa.begin() + static_cast<std::ptrdiff_t>(end);
    const auto above = std::upper_bound(first + 1, last - 1, abscissa);
    const auto k = static_cast<std::size_t>(above - axes.abscissa.begin()) - 1;
    const double step = axes.abscissa[k + 1] - axes.abscissa[k];
    return {k, step > 0 ? std::clamp((abscissa - axes.abscissa[k]) / step, 0.0, 1.0) : 0.0};
}

double value_at(const std::vector<double>& values, AxisPlace place) {
    const double a = values[place.point], b = values[place.point + 1];
    if (std::isnan(a)) return b;
    return std::isnan(b) ? a : std::lerp(a, b, place.share);
}

BranchPlace branch_place(const LinePieces& pieces, std::size_t line, double abscissa) {
    const auto begin = pieces.to.begin() + pieces.offsets[line], end = pieces.to.begin() + pieces.offsets[line + 1];
    if (begin == end) return {};
    const auto piece = std::min(std::lower_bound(begin, end, abscissa), end - 1);
    const auto k = static_cast<std::size_t>(piece - pieces.to.begin());
    const double step = pieces.to[k] - pieces.from[k];
    const double share = step > 0 ? std::clamp((abscissa - pieces.from[k]) / step, 0.0, 1.0) : 0.0;
    return {pieces.branch[k], pieces.junction[k], std::lerp(pieces.branch_from[k], pieces.branch_to[k], share)};
}

LineBranches branches_of_points(const LinePieces& pieces, const BranchLines& axes, std::span<const LineView> views) {
    LineBranches result;
    for (std::size_t i = 0; i < views.size(); ++i)
        for (const double s : views[i].abscissa) {
            const BranchPlace place = branch_place(pieces, i, s);
            result.branch.push_back(place.branch);
            result.junction.push_back(place.junction);
            result.branch_abscissa.push_back(place.abscissa);
            const AxisPlace on = place_on(axes, place.branch, place.abscissa);
            const bool own = place.junction.is_none();
            result.curvature.push_back(own ? value_at(axes.curvature, on) : kNaN);
            result.torsion.push_back(own ? value_at(axes.torsion, on) : kNaN);
            const auto mixed = [&](const std::vector<Vec3>& v) {
                return normalized(lerp(v[on.point], v[on.point + 1], on.share));
            };
            result.tangent.push_back(mixed(axes.tangent));
            result.frame.push_back(mixed(axes.frame));
        }
    return result;
}

}  // namespace lumenline
