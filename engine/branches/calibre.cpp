// A stenosis may be half of its branch: the fitted line stands as long as more than half of the points are healthy. The
// extreme between points is that of the parabola through the three around it.
#include "engine/branches/calibre.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/branches/axes.h"
#include "engine/branches/measures.h"
#include "engine/branches/robust.h"

namespace lumenline {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kDistal = 10;      // radii: length of the distal reference, at most
constexpr double kLeastDistal = 1;  // and at least
constexpr std::size_t kFewest = 5;  // points: a line by repeated medians passes through some of fewer

/// Radii along the own part of a branch.
struct Profile {
    std::vector<double> s, radius;
    StraightFit fit{kNaN, kNaN};

    [[nodiscard]] double share(std::size_t k) const { return radius[k] / fit(s[k]); }
};

Profile profile_of(const BranchLines& axes, std::size_t branch) {
    Profile p;
    const OwnPart own = own_part(axes, branch);
    for (std::size_t k = own.begin; k < own.end; ++k) {
        p.s.push_back(axes.abscissa[k]);
        p.radius.push_back(axes.radius[k]);
    }
    p.fit = repeated_median(p.s, p.radius);
    return p;
}

/// Where a profile is farthest below (sign -1) or above (+1) its line, and how far that reaches.
struct Extreme {
    double s = kNaN, radius = kNaN, from = kNaN, to = kNaN;
};

Extreme find_extreme(const Profile& p, double sign) {
    Extreme e;
    const std::size_t n = p.s.size();
    if (n < kFewest || !(p.fit(p.s.front()) > 0 && p.fit(p.s.back()) > 0)) return e;
    std::size_t k = 0;
    for (std::size_t i = 1; i < n; ++i)
        if (sign * p.share(i) > sign * p.share(k)) k = i;
    e.s = p.s[k];
    e.radius = p.radius[k];
    if (k > 0 && k + 1 < n) {
        // Points are equally far apart.
        const double a = p.radius[k - 1], b = p.radius[k], c = p.radius[k + 1];
        const double bend = a - 2 * b + c;
        const double shift = sign * bend < 0 ? std::clamp(0.5 * (a - c) / bend, -0.5, 0.5) : 0.0;
        e.s += shift * (p.s[k + 1] - p.s[k]);
        e.radius = b + 0.5 * shift * (c - a) + 0.5 * shift * shift * bend;
    }
    const double half = 0.5 * sign * (e.radius - p.fit(e.s));
    if (!(half > 0)) return e;
    const auto excess = [&](std::size_t i) { return sign * (p.radius[i] - p.fit(p.s[i])) - half; };
    const auto passed = [&](std::size_t in, std::size_t out) {
        return std::lerp(p.s[in], p.s[out], excess(in) / (excess(in) - excess(out)));
    };
    std::size_t i = k;
    while (i > 0 && excess(i) > 0) --i;
    e.from = excess(i) > 0 ? p.s[i] : passed(i + 1, i);
    i = k;
    while (i + 1 < n && excess(i) > 0) ++i;
    e.to = excess(i) > 0 ? p.s[i] : passed(i - 1, i);
    return e;
}

/// Median of the values whose place is within [from, to].
double median_within(const std::vector<double>& s, const std::vector<double>& values, double from, double to) {
    std::vector<double> within;
    for (std::size_t k = 0; k < s.size(); ++k)
        if (s[k] >= from && s[k] <= to && !std::isnan(values[k])) within.push_back(values[k]);
    return median_of(within);
}

/// Closed sections of one branch.
struct Areas {
    std::vector<double> s, area, root;
};

std::vector<Areas> areas_of(const SectionTable& sections, std::size_t branches) {
    std::vector<Areas> areas(branches);
    for (std::size_t k = 0; k < sections.rows(); ++k) {
        if (sections.closed[k] == 0) continue;
        Areas& a = areas[at(sections.branch[k])];
        a.s.push_back(sections.abscissa[k]);
        a.area.push_back(sections.area[k]);
        a.root.push_back(std::sqrt(sections.area[k]));
    }
    return areas;
}

/// Area of the smallest of the sections nearest to `s` on both sides.
double area_at(const Areas& a, double s) {
    const auto above = std::lower_bound(a.s.begin(), a.s.end(), s);
    double least = kNaN;
    const auto k = static_cast<std::size_t>(above - a.s.begin());
    if (k < a.s.size()) least = a.area[k];
    if (k > 0) least = std::fmin(least, a.area[k - 1]);
    return least;
}

}  // namespace

StenosisTable find_stenoses(const BranchAxes& branches, const SectionTable& sections) {
    StenosisTable t;
    const std::size_t count = branches.graph.branch_count();
    const std::vector<Areas> areas = areas_of(sections, count);
    for (std::size_t b = 0; b < count; ++b) {
        const Profile p = profile_of(branches.lines, b);
        const Extreme e = find_extreme(p, -1);
        const double distal_from = e.s + 2 * (e.to - e.s), distal_to = distal_from + kDistal * p.fit(e.s);
        // Without a stretch behind it the narrowest place would be its own reference.
        const bool has_distal = e.to > e.s && p.s.back() - distal_from >= kLeastDistal * p.fit(e.s);
        const double distal = has_distal ? 2 * median_within(p.s, p.radius, distal_from, distal_to) : kNaN;
        const double fitted = 2 * p.fit(e.s);
        const double area = area_at(areas[b], e.s);
        const double original = repeated_median(areas[b].s, areas[b].root)(e.s);
        const double distal_area = has_distal ? median_within(areas[b].s, areas[b].area, distal_from, distal_to) : kNaN;
        t.abscissa.push_back(e.s);
        t.diameter.push_back(2 * e.radius);
        t.area.push_back(area);
        t.nascet_diameter.push_back(1 - 2 * e.radius / distal);
        t.nascet_area.push_back(1 - area / distal_area);
        t.ecst_diameter.push_back(1 - 2 * e.radius / fitted);
        t.ecst_area.push_back(1 - area / (original * original));
        t.distal_reference.push_back(distal);
        t.fitted_reference.push_back(fitted);
        t.from.push_back(e.from);
        t.to.push_back(e.to);
        t.length.push_back(e.to - e.from);
    }
    return t;
}

DilationTable find_dilations(const BranchAxes& branches) {
    DilationTable t;
    for (std::size_t b = 0; b < branches.graph.branch_count(); ++b) {
        const Profile p = profile_of(branches.lines, b);
        const Extreme e = find_extreme(p, +1);
        const double ratio = e.radius / p.fit(e.s);
        t.abscissa.push_back(e.s);
        t.diameter.push_back(2 * e.radius);
        t.fitted_reference.push_back(2 * p.fit(e.s));
        t.ratio.push_back(ratio);
        t.area_ratio.push_back(ratio * ratio);
        t.from.push_back(e.from);
        t.to.push_back(e.to);
        t.length.push_back(e.to - e.from);
    }
    return t;
}

}  // namespace lumenline
