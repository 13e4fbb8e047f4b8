// Quantiles by sorting the sites by value and adding up their areas.
#include "engine/characterize/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lumenline {

namespace {

constexpr double kJumpEdges = 3;     // edge lengths
constexpr double kJumpRadii = 0.25;  // ball radii

}  // namespace

std::vector<double> wall_area_per_site(const Surface& surface) {
    std::vector<double> area(surface.site_count(), 0.0);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        if (!surface.cap[t].is_none()) continue;
        const auto& [a, b, c] = surface.triangles[t];
        const Vec3 pa = surface.points[at(a)];
        const double third = norm(cross(surface.points[at(b)] - pa, surface.points[at(c)] - pa)) / 6;
        for (const SiteId s : {a, b, c}) area[at(s)] += third;
    }
    return area;
}

AreaStatistics area_statistics(std::span<const double> values, std::span<const double> weights) {
    std::vector<std::uint32_t> order;
    double total = 0, sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!(weights[i] > 0) || std::isnan(values[i])) continue;
        order.push_back(static_cast<std::uint32_t>(i));
        total += weights[i];
        sum += weights[i] * values[i];
    }
    AreaStatistics result;
    if (order.empty()) return result;
    result.mean = sum / total;
    double squares = 0;
    for (const std::uint32_t i : order) squares += weights[i] * (values[i] - result.mean) * (values[i] - result.mean);
    result.sd = std::sqrt(squares / total);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t i, std::uint32_t j) { return values[i] != values[j] ? values[i] < values[j] : i < j; });
    const auto quantile = [&](double share) {
        double below = 0;
        for (const std::uint32_t i : order)
            if ((below += weights[i]) >= share * total) return values[i];
        return values[order.back()];
    };
    result.median = quantile(0.5);
    result.p95 = quantile(0.95);
    return result;
}

JumpCounts count_jumps(const Surface& surface, const VoronoiComplex& complex, const SurfaceCharacter& character) {
    JumpCounts jumps;
    const auto counts = [&](SiteId s) {
        return character.zone[at(s)] == SiteZone::kWall && !character.centerline_id[at(s)].is_none();
    };
    for (const auto& t : surface.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const SiteId i = t[k], j = t[(k + 1) % 3];  // the surface is closed: the edge runs both ways
            if (!(i < j) || !counts(i) || !counts(j)) continue;
            const std::size_t pi = at(complex.pole[at(i)]), pj = at(complex.pole[at(j)]);
            const double limit = std::max(kJumpEdges * distance(surface.points[at(i)], surface.points[at(j)]),
                                          kJumpRadii * std::min(complex.ball_radius[pi], complex.ball_radius[pj]));
            const double depth = std::fabs(character.geodesic_distance[at(i)] - character.geodesic_distance[at(j)]);
            const double along = distance(character.centerline_point[at(i)], character.centerline_point[at(j)]);
            if (depth <= limit && along <= limit) continue;
            if (distance(complex.vertices[pi], complex.vertices[pj]) > limit)
                ++jumps.pole_sheet;
            else if (along > limit)
                ++jumps.branches_meet;
            else
                ++jumps.other;
        }
    return jumps;
}

void summarize_wall(const Surface& surface, SurfaceCharacter& character) {
    std::vector<double> area = wall_area_per_site(surface);
    for (std::size_t i = 0; i < area.size(); ++i) {
        if (character.zone[i] != SiteZone::kWall) {
            area[i] = 0;
            continue;
        }
        ++character.wall_sites;
        if (!character.centerline_id[i].is_none())
            character.wall_area += area[i];
        else
            ++character.unreached;
    }
    character.geodesic_distance_statistics = area_statistics(character.geodesic_distance, area);
    character.euclidean_distance_statistics = area_statistics(character.euclidean_distance, area);
    character.normalized_tangency_deviation_statistics = area_statistics(character.normalized_tangency_deviation, area);
}

}  // namespace lumenline
