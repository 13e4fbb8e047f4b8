// Each triangle that a plane passes through has one half-edge that goes down through it and one that goes up: entered
// by the first and left by the second, triangles follow each other counter-clockwise about the normal where the lumen
// is inside. A site in the plane counts as above, so that every triangle is crossed by two edges or none.
#include "engine/branches/section_cutter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace lumenline {

namespace {

constexpr std::size_t kDirections = 72;  // of chords: every five degrees
constexpr int kMostSteps = 1000;         // of a walk towards a plane

double cross2(PlanePoint a, PlanePoint b) { return a.x * b.y - a.y * b.x; }
PlanePoint minus(PlanePoint a, PlanePoint b) { return {a.x - b.x, a.y - b.y}; }

/// Distances from `centre` to the loop in all directions; the nearest crossing where there are several.
std::array<double, kDirections> distances_around(const std::vector<PlanePoint>& loop, PlanePoint centre) {
    constexpr double kStep = 2 * std::numbers::pi / kDirections;
    std::array<double, kDirections> distance;
    distance.fill(std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < loop.size(); ++i) {
        PlanePoint a = minus(loop[i], centre), b = minus(loop[(i + 1) % loop.size()], centre);
        if (cross2(a, b) < 0) std::swap(a, b);
        double begin = std::atan2(a.y, a.x) / kStep, end = std::atan2(b.y, b.x) / kStep;
        if (end < begin) end += kDirections;
        for (int k = static_cast<int>(std::ceil(begin)); k <= static_cast<int>(std::floor(end)); ++k) {
            const PlanePoint d{std::cos(k * kStep), std::sin(k * kStep)};
            const PlanePoint e = minus(b, a);
            const double across = cross2(d, e);
            if (across == 0) continue;
            const std::size_t slot = static_cast<std::size_t>(k + 2 * static_cast<int>(kDirections)) % kDirections;
            distance[slot] = std::min(distance[slot], std::fabs(cross2(a, e) / across));
        }
    }
    return distance;
}

std::vector<PlanePoint> convex_hull(std::vector<PlanePoint> points) {
    std::sort(points.begin(), points.end(),
              [](PlanePoint a, PlanePoint b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    std::vector<PlanePoint> hull;
    const auto add_chain = [&hull](auto begin, auto end) {
        const std::size_t base = hull.size();
        for (auto p = begin; p != end; ++p) {
            while (hull.size() >= base + 2 &&
                   cross2(minus(hull.back(), hull[hull.size() - 2]), minus(*p, hull.back())) <= 0)
                hull.pop_back();
            hull.push_back(*p);
        }
        hull.pop_back();
    };
    add_chain(points.begin(), points.end());
    add_chain(points.rbegin(), points.rend());
    return hull;
}

/// By calipers: the least width is across one of the hull's edges.
double least_width(const std::vector<PlanePoint>& hull) {
    const std::size_t n = hull.size();
    if (n < 3) return 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0, far = 1; i < n; ++i) {
        const PlanePoint e = minus(hull[(i + 1) % n], hull[i]);
        const auto away = [&](std::size_t k) { return cross2(e, minus(hull[k % n], hull[i])); };
        while (away(far + 1) > away(far)) ++far;
        least = std::min(least, away(far) / std::hypot(e.x, e.y));
    }
    return least;
}

}  // namespace

SectionCutter::SectionCutter(const Surface& surface) : surface_(surface) {
    const auto count = static_cast<HalfEdge>(3 * surface.triangles.size());
    first_.assign(surface.site_count() + 1, 0);
    for (HalfEdge h = 0; h < count; ++h) ++first_[from(h) + 1];
    for (std::size_t i = 0; i < surface.site_count(); ++i) first_[i + 1] += first_[i];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    leaving_.resize(count);
    for (HalfEdge h = 0; h < count; ++h) leaving_[next[from(h)]++] = h;
    twin_.resize(count);
    for (HalfEdge h = 0; h < count; ++h) {
        const std::size_t start = from(h), end = to(h);
        twin_[h] = h;
        for (std::uint32_t k = first_[end]; k < first_[end + 1]; ++k)
            if (to(leaving_[k]) == start) twin_[h] = leaving_[k];
    }
}

double SectionCutter::height(const SectionPlane& plane, std::size_t site) const {
    return dot(surface_.points[site] - plane.origin, plane.normal);
}

bool SectionCutter::find_crossing(const SectionPlane& plane, std::size_t seed, HalfEdge& found) const {
    double here = height(plane, seed);
    for (int step = 0; step < kMostSteps; ++step) {
        HalfEdge best = 0;
        double least = std::fabs(here);
        bool improved = false;
        for (std::uint32_t k = first_[seed]; k < first_[seed + 1]; ++k) {
            const HalfEdge h = leaving_[k];
            const double there = height(plane, to(h));
            if ((there >= 0) != (here >= 0)) {
                found = here >= 0 ? h : twin_[h];
                return true;
            }
            if (std::fabs(there) < least) {
                least = std::fabs(there);
                best = h;
                improved = true;
            }
        }
        if (!improved) return false;
        seed = to(best);
        here = height(plane, seed);
    }
    return false;
}

SectionLoop SectionCutter::follow(const SectionPlane& plane, HalfEdge start) const {
    SectionLoop loop;
    loop.wall = true;
    loop.site = SiteId(from(start));
    HalfEdge down = start;
    do {
        const double a = height(plane, from(down)), b = height(plane, to(down));
        const Vec3 x = lerp(surface_.points[from(down)], surface_.points[to(down)], a / (a - b)) - plane.origin;
        loop.points.push_back({dot(x, plane.e1), dot(x, plane.e2)});
        loop.nearest.emplace_back(a < -b ? from(down) : to(down));
        if (!surface_.cap[down / 3].is_none()) loop.wall = false;
        // The third corner tells by which of the other two edges the plane leaves.
        const HalfEdge base = 3 * (down / 3);
        const HalfEdge next = base + (down - base + 1) % 3, last = base + (down - base + 2) % 3;
        down = twin_[height(plane, to(next)) >= 0 ? next : last];
    } while (down != start && loop.points.size() <= surface_.triangles.size());
    return loop;
}

SectionLoop SectionCutter::cut(const SectionPlane& plane, SiteId seed) const {
    HalfEdge start = 0;
    if (seed.is_none() || !find_crossing(plane, at(seed), start)) return {};
    SectionLoop loop = follow(plane, start);
    return surrounds_origin(loop.points) ? loop : SectionLoop{};
}

SectionLoop SectionCutter::search(const SectionPlane& plane) const {
    std::vector<char> above(surface_.site_count());
    for (std::size_t i = 0; i < above.size(); ++i) above[i] = height(plane, i) >= 0 ? 1 : 0;
    std::vector<char> seen(surface_.triangles.size(), 0);
    SectionLoop best;
    double least = std::numeric_limits<double>::infinity();
    for (HalfEdge h = 0; h < twin_.size(); ++h) {
        if (seen[h / 3] != 0 || above[from(h)] == 0 || above[to(h)] != 0) continue;
        HalfEdge down = h;
        do {
            seen[down / 3] = 1;
            const HalfEdge base = 3 * (down / 3);
            const HalfEdge next = base + (down - base + 1) % 3, last = base + (down - base + 2) % 3;
            down = twin_[above[to(next)] != 0 ? next : last];
        } while (seen[down / 3] == 0);
        SectionLoop loop = follow(plane, h);
        if (!surrounds_origin(loop.points)) continue;
        if (const double area = measure_loop(loop.points).area; area < least) {
            least = area;
            best = std::move(loop);
        }
    }
    return best;
}

bool surrounds_origin(const std::vector<PlanePoint>& loop) {
    int turns = 0;  // crossings of the positive x axis
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const PlanePoint a = loop[i], b = loop[(i + 1) % loop.size()];
        if ((a.y >= 0) == (b.y >= 0)) continue;
        const double side = cross2(a, b);
        if (a.y < 0 && side > 0) ++turns;
        if (a.y >= 0 && side < 0) --turns;
    }
    return turns == 1;
}

SectionMeasures measure_loop(const std::vector<PlanePoint>& loop) {
    SectionMeasures m;
    PlanePoint moment;
    const PlanePoint base = loop.front();
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const PlanePoint a = minus(loop[i], base), b = minus(loop[(i + 1) % loop.size()], base);
        const double twice = cross2(a, b);
        m.area += 0.5 * twice;
        moment = {moment.x + twice * (a.x + b.x) / 6, moment.y + twice * (a.y + b.y) / 6};
        m.perimeter += std::hypot(b.x - a.x, b.y - a.y);
    }
    m.centroid = {base.x + moment.x / m.area, base.y + moment.y / m.area};
    const auto around = distances_around(loop, m.centroid);
    m.min_diameter = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < kDirections / 2; ++k) {
        const double chord = around[k] + around[k + kDirections / 2];
        m.min_diameter = std::min(m.min_diameter, chord);
        if (std::isfinite(chord)) m.max_diameter = std::max(m.max_diameter, chord);
    }
    m.least_width = least_width(convex_hull(loop));
    return m;
}

}  // namespace lumenline
