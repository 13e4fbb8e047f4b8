// Sites carry a third of the area, and of the volume, of each triangle around them. Prisms share their sides, bent
// quadrilaterals that count as the mean of their two triangulations, so that no volume is counted twice; only where
// the corners of a triangle belong to different branches, at the border of what is measured, is it a cone.
#include "engine/branches/wall.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/branches/axes.h"

namespace lumenline {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kPrismOverCone = 1.5;  // of a thin wedge of a round tube

using Corners = std::array<Vec3, 3>;

double determinant(Vec3 a, Vec3 b, Vec3 c) { return dot(a, cross(b, c)); }

/// Volume between an outward triangle and another one behind it.
double prism_volume(Corners p, Corners c) {
    const Vec3 origin = c[0];
    for (std::size_t k = 0; k < 3; ++k) {
        p[k] = p[k] - origin;
        c[k] = c[k] - origin;
    }
    double sum = determinant(p[0], p[1], p[2]) - determinant(c[0], c[1], c[2]);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        sum += 0.5 * (determinant(p[j], p[i], c[i]) + determinant(p[j], c[i], c[j]) + determinant(p[j], p[i], c[j]) +
                      determinant(p[i], c[i], c[j]));
    }
    return sum / 6;
}

double triangle_area(const Corners& p) { return 0.5 * norm(cross(p[1] - p[0], p[2] - p[0])); }

/// Calls visit(triangle, corners) for the triangles of the wall.
template <class Visit>
void for_wall(const Surface& surface, const Visit& visit) {
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        if (!surface.cap[t].is_none()) continue;
        const auto& s = surface.triangles[t];
        visit(s, Corners{surface.points[at(s[0])], surface.points[at(s[1])], surface.points[at(s[2])]});
    }
}

/// A sum and the area it is over.
struct Weighted {
    double sum = 0, area = 0;
    void add(double value, double weight) {
        if (std::isnan(value)) return;
        sum += weight * value;
        area += weight;
    }
    [[nodiscard]] double mean() const { return area > 0 ? sum / area : kNaN; }
};

struct WallMeans {
    Weighted geodesic, euclidean, deviation;
    void add(const SurfaceCharacter& c, std::size_t site, double area) {
        geodesic.add(c.geodesic_distance[site], area);
        euclidean.add(c.euclidean_distance[site], area);
        deviation.add(c.normalized_tangency_deviation[site], area);
    }
};

/// Where on the axis each site belongs.
std::vector<Vec3> axis_points(const BranchAxes& branches, const SurfaceBranches& sites) {
    std::vector<Vec3> points(sites.branch.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!sites.branch[i].is_none())
            points[i] = position_at(branches.lines, place_on(branches.lines, sites.branch[i], sites.longitudinal[i]));
    return points;
}

}  // namespace

SurfaceBranches coordinates_of(const Surface& surface, const SurfaceCharacter& character, const BranchAxes& branches,
                               const StageContext& context) {
    const std::size_t count = surface.site_count();
    SurfaceBranches sites;
    sites.branch.assign(count, BranchId());
    sites.junction.assign(count, JunctionId());
    for (auto* values : {&sites.longitudinal, &sites.relative, &sites.angle}) values->assign(count, kNaN);
    context.parallel_for(count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (character.centerline_id[i].is_none()) continue;
            const BranchPlace place =
                branch_place(branches.pieces, at(character.centerline_id[i]), character.abscissa[i]);
            if (place.branch.is_none()) continue;
            const BranchLines& axes = branches.lines;
            sites.branch[i] = place.branch;
            sites.junction[i] = place.junction;
            sites.longitudinal[i] = place.abscissa;
            sites.relative[i] = std::clamp(place.abscissa / axes.length(at(place.branch)), 0.0, 1.0);
            const AxisPlace on = place_on(axes, place.branch, place.abscissa);
            const Vec3 e1 = lerp(axes.frame[on.point], axes.frame[on.point + 1], on.share);
            const Vec3 e2 = cross(lerp(axes.tangent[on.point], axes.tangent[on.point + 1], on.share), e1);
            const Vec3 away = surface.points[i] - position_at(axes, on);
            sites.angle[i] = std::atan2(dot(away, e2), dot(away, e1));
        }
    });
    return sites;
}

void measure_wall(const Surface& surface, const SurfaceCharacter& character, const BranchAxes& branches,
                  const SurfaceBranches& sites, BranchTable& table) {
    const std::size_t count = branches.graph.branch_count();
    std::vector<double> area(count, 0), volume(count, 0);
    std::vector<WallMeans> means(count);
    const std::vector<Vec3> axis = axis_points(branches, sites);
    for_wall(surface, [&](const std::array<SiteId, 3>& corners, const Corners& p) {
        const auto counts = [&](SiteId s) {
            return !sites.branch[at(s)].is_none() && sites.junction[at(s)].is_none() &&
                   character.zone[at(s)] == SiteZone::kWall;
        };
        if (std::none_of(corners.begin(), corners.end(), counts)) return;
        const bool one_branch = sites.branch[at(corners[0])] == sites.branch[at(corners[1])] &&
                                sites.branch[at(corners[0])] == sites.branch[at(corners[2])];
        const double third = triangle_area(p) / 3;
        double prism = 0;
        if (one_branch) prism = prism_volume(p, {axis[at(corners[0])], axis[at(corners[1])], axis[at(corners[2])]});
        for (const SiteId s : corners) {
            if (!counts(s)) continue;
            const std::size_t b = at(sites.branch[at(s)]);
            area[b] += third;
            means[b].add(character, at(s), third);
            const Vec3 c = axis[at(s)];
            volume[b] += (one_branch ? prism : kPrismOverCone * determinant(p[0] - c, p[1] - c, p[2] - c) / 6) / 3;
        }
    });
    for (std::size_t b = 0; b < count; ++b) {
        table.wall_area[b] = area[b] > 0 ? area[b] : kNaN;
        table.volume[b] = area[b] > 0 ? volume[b] : kNaN;
        table.geodesic_distance[b] = means[b].geodesic.mean();
        table.euclidean_distance[b] = means[b].euclidean.mean();
        table.normalized_tangency_deviation[b] = means[b].deviation.mean();
    }
}

PatchTable measure_patches(const Surface& surface, const SurfaceCharacter& character, const BranchAxes& branches,
                           const SurfaceBranches& sites, const BranchOptions& options) {
    const auto rows = static_cast<std::size_t>(options.patches_along);
    const auto columns = static_cast<std::size_t>(options.patches_around);
    const std::size_t count = branches.graph.branch_count() * rows * columns;
    std::vector<WallMeans> means(count);
    std::vector<Weighted> distances(count);
    const std::vector<Vec3> axis = axis_points(branches, sites);
    PatchTable patches;
    patches.sites.assign(count, 0);
    std::vector<double> share(surface.site_count(), 0);
    for_wall(surface, [&](const std::array<SiteId, 3>& corners, const Corners& p) {
        for (const SiteId s : corners) share[at(s)] += triangle_area(p) / 3;
    });
    const auto bin = [](double value, std::size_t bins) {
        return std::min(bins - 1, static_cast<std::size_t>(std::max(0.0, value * static_cast<double>(bins))));
    };
    for (std::size_t i = 0; i < surface.site_count(); ++i) {
        if (sites.branch[i].is_none() || character.zone[i] != SiteZone::kWall) continue;
        const double turn = sites.angle[i] / (2 * std::numbers::pi);
        const std::size_t around = bin(turn < 0 ? turn + 1 : turn, columns);
        const std::size_t k = (at(sites.branch[i]) * rows + bin(sites.relative[i], rows)) * columns + around;
        ++patches.sites[k];
        means[k].add(character, i, share[i]);
        distances[k].add(distance(surface.points[i], axis[i]), share[i]);
    }
    for (std::size_t k = 0; k < count; ++k) {
        patches.branch.emplace_back(k / (rows * columns));
        patches.along.push_back(static_cast<std::uint32_t>(k / columns % rows));
        patches.around.push_back(static_cast<std::uint32_t>(k % columns));
        patches.area.push_back(distances[k].area > 0 ? distances[k].area : kNaN);
        patches.distance.push_back(distances[k].mean());
        patches.geodesic_distance.push_back(means[k].geodesic.mean());
        patches.euclidean_distance.push_back(means[k].euclidean.mean());
        patches.normalized_tangency_deviation.push_back(means[k].deviation.mean());
    }
    return patches;
}

}  // namespace lumenline
