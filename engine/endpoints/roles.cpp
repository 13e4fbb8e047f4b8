// Quantities that differ by rounding alone count as equal, so that a mesh read in another order or another
// unit gives the same order; what is left of a tie goes by position along a skew direction, which no two ends
// share but by intent.
#include "engine/endpoints/roles.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/core/text.h"
#include "engine/endpoints/shortest_paths.h"
#include "engine/geometry/heap.h"
#include "engine/geometry/site_neighbours.h"

namespace lumenline {

namespace {

constexpr double kClearLargest = 1.2;  // ratio of radii of the largest end to the second
constexpr double kStartReach = 1.5;    // of an end's nearest site, within which sites are its
constexpr double kSame = 1e-6;         // share by which equal costs and radii may differ

double skew_position(Vec3 p) { return p.x + 0.61803398874989485 * p.y + 0.75487766624669276 * p.z; }

/// Sorts ascending by `key`, then each run of equal keys by `next`.
template <class Iterator, class Key, class Next>
void sort_with_ties(Iterator begin, Iterator end, const Key& key, const Next& next) {
    std::stable_sort(begin, end, [&](const auto& a, const auto& b) { return key(a) < key(b); });
    while (begin != end) {
        const double limit = key(*begin) + kSame * std::fabs(key(*begin));
        Iterator last = begin + 1;
        while (last != end && key(*last) <= limit) ++last;
        next(begin, last);
        begin = last;
    }
}

/// What the rule wants least of.
double badness(const Endpoint& end, const InletRule& rule) {
    switch (rule.kind) {
        case InletRule::Kind::kLargest: return -end.radius;
        case InletRule::Kind::kSmallest: return end.radius;
        case InletRule::Kind::kHighest: return -end.point[rule.axis];
        case InletRule::Kind::kLowest: return end.point[rule.axis];
        case InletRule::Kind::kNearest:
        case InletRule::Kind::kPoint: return distance(end.point, rule.point);
        case InletRule::Kind::kBoundary: return end.opening.is_none() || at(end.opening) + 1 != rule.number ? 1 : 0;
    }
    return 0;
}

void warn_if_not_clear(const Endpoint& largest, const Endpoint& second, StageContext& context) {
    if (!(largest.radius < kClearLargest * second.radius)) return;
    const std::string what = largest.opening.is_none() ? "end" : "opening";
    context.warn("inlet_not_clear",
                 "the largest " + what + " (radius " + short_text(largest.radius) +
                     ") is taken as the inlet, but the second is nearly as large (" + short_text(second.radius) +
                     "): state the inlet if it is another",
                 largest.radius / second.radius, kClearLargest);
}

}  // namespace

std::optional<std::size_t> pick_inlet(const Endpoints& ends, const std::vector<std::size_t>& candidates,
                                      const InletRule& rule, StageContext& context) {
    std::vector<std::size_t> order = candidates;
    const auto by_position = [&](auto begin, auto end) {
        std::stable_sort(begin, end, [&](std::size_t a, std::size_t b) {
            return skew_position(ends[a].point) < skew_position(ends[b].point);
        });
    };
    sort_with_ties(
        order.begin(), order.end(), [&](std::size_t i) { return badness(ends[i], rule); }, by_position);
    if (rule.kind == InletRule::Kind::kBoundary && badness(ends[order.front()], rule) > 0) return std::nullopt;
    if (rule.kind == InletRule::Kind::kLargest && order.size() > 1)
        warn_if_not_clear(ends[order[0]], ends[order[1]], context);
    return order.front();
}

std::vector<double> costs_from(const VoronoiComplex& complex, const Endpoints& inlets, const Endpoints& ends,
                               StageContext& context) {
    std::vector<Seed> seeds;
    for (const Endpoint& e : inlets) seeds.insert(seeds.end(), e.seeds.begin(), e.seeds.end());
    const ShortestPaths paths = shortest_paths(complex, seeds, context);
    std::vector<double> cost(ends.size(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < ends.size(); ++i)
        for (const Seed& s : ends[i].seeds) cost[i] = std::min(cost[i], paths.cost[at(s.vertex)] + s.time);
    return cost;
}

std::vector<double> wall_distances(const Surface& surface, const Endpoints& inlets, const Endpoints& ends) {
    const std::size_t n = surface.site_count();
    const SiteNeighbours neighbours(surface);
    struct Start {
        SiteId site;
        double way = 0;  // to the site
    };
    // Of a ball inside, all sites it rests on count: which is nearest is a matter of rounding.
    const auto starts_of = [&](const Endpoint& e) {
        std::vector<Start> starts;
        if (!e.opening.is_none()) {
            for (const SiteId s : surface.openings[at(e.opening)].loop) starts.push_back({s, 0});
            return starts;
        }
        double least = std::numeric_limits<double>::infinity();
        for (const Vec3& p : surface.points) least = std::min(least, distance(p, e.anchor));
        for (std::size_t s = 0; s < n; ++s)
            if (const double way = distance(surface.points[s], e.anchor); way <= kStartReach * least)
                starts.push_back({SiteId(s), way});
        return starts;
    };
    std::vector<double> length(n, std::numeric_limits<double>::infinity());
    IndexedHeap heap;
    heap.reset(n);
    const auto key = [&length](std::uint32_t s) { return length[s]; };
    for (const Endpoint& e : inlets)
        for (const Start& start : starts_of(e)) {
            double& so_far = length[at(start.site)];
            so_far = std::min(so_far, start.way);
            heap.push_or_decrease(start.site.value, key);
        }
    while (!heap.empty()) {
        const SiteId s(std::size_t{heap.pop(key)});
        for (const SiteId t : neighbours.of(s)) {
            const double reached = length[at(s)] + distance(surface.points[at(s)], surface.points[at(t)]);
            if (!(reached < length[at(t)])) continue;
            length[at(t)] = reached;
            heap.push_or_decrease(t.value, key);
        }
    }
    std::vector<double> result(ends.size(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < ends.size(); ++i)
        for (const Start& start : starts_of(ends[i]))
            result[i] = std::min(result[i], length[at(start.site)] + start.way);
    return result;
}

void sort_by_cost(Endpoints& endpoints, const std::vector<double>& cost) {
    std::vector<std::size_t> order(endpoints.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto by_position = [&](auto begin, auto end) {
        std::stable_sort(begin, end, [&](std::size_t a, std::size_t b) {
            return skew_position(endpoints[a].point) < skew_position(endpoints[b].point);
        });
    };
    const auto by_radius = [&](auto begin, auto end) {
        sort_with_ties(
            begin, end, [&](std::size_t i) { return -endpoints[i].radius; }, by_position);
    };
    sort_with_ties(
        order.begin(), order.end(), [&](std::size_t i) { return cost[i]; }, by_radius);
    Endpoints sorted;
    for (const std::size_t i : order) sorted.push_back(std::move(endpoints[i]));
    endpoints = std::move(sorted);
}

}  // namespace lumenline
