// Feet are found by Newton steps in the tangent plane of the blended patch, from facet to facet.
// The blend's own derivatives are left out of the steps: they are as small as the quadrics disagree,
// and an error of the foot enters the distance squared.
#include "engine/geometry/curved_surface.h"

#include <algorithm>
#include <cmath>

namespace lumenline {

namespace {

constexpr int kMaxSteps = 8;
constexpr double kConverged = 1e-5;    // of the edge: the last step; slopes of the distance need it, distances less
constexpr double kLeastStretch = 0.5;  // of 1 - curvature x distance: below it, near a focal point, any foot will do
constexpr double kFlatCap = 0.9;       // cosine between a cap's facets and the opening's axis

/// Barycentric weights moved into the triangle.
void clamp(std::array<double, 3>& weight) {
    double sum = 0;
    for (double& w : weight) sum += w = std::max(w, 0.0);
    for (double& w : weight) w /= sum;
}

/// Eigenvalues and eigenvectors of a symmetric matrix in the basis (u, v).
void principal(double uu, double uv, double vv, Vec3 u, Vec3 v, SurfaceFoot& foot) {
    const double mean = 0.5 * (uu + vv), half = 0.5 * (uu - vv), radius = std::hypot(half, uv);
    const double angle = radius > 0 ? 0.5 * std::atan2(uv, half) : 0.0;
    const double c = std::cos(angle), s = std::sin(angle);
    foot.directions = {c * u + s * v, c * v - s * u};
    foot.curvature = {mean + radius, mean - radius};
}

}  // namespace

CurvedSurface::CurvedSurface(const Surface& surface, const SurfaceDistance& flat) : surface_(surface), flat_(flat) {
    const std::size_t sites = surface.site_count(), count = surface.triangles.size();
    part_.resize(count, Part::kWall);
    offsets_.assign(sites + 1, 0);
    for (std::size_t i = 0; i < count; ++i) {
        for (const SiteId s : surface.triangles[i]) ++offsets_[at(s) + 1];
        if (surface.cap[i].is_none()) continue;
        const Opening& opening = surface.openings[at(surface.cap[i])];
        const auto t = static_cast<std::uint32_t>(i);
        const Vec3 n = normalized(cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)));
        const bool flat_cap = opening.extension_length <= 0 || dot(n, opening.axis) > kFlatCap;
        part_[i] = flat_cap ? Part::kCap : Part::kExtension;
    }
    for (std::size_t s = 0; s < sites; ++s) offsets_[s + 1] += offsets_[s];
    around_.resize(offsets_.back());
    std::vector<std::uint32_t> next(offsets_.begin(), offsets_.end() - 1);
    for (std::size_t i = 0; i < count; ++i)
        for (const SiteId s : surface.triangles[i]) around_[next[at(s)]++] = static_cast<std::uint32_t>(i);
    known_.assign(sites, {SiteId::kNoneValue, SiteId::kNoneValue});
}

std::uint32_t CurvedSurface::quadric(std::uint32_t triangle, int k) {
    const SiteId site = surface_.triangles[triangle][static_cast<std::size_t>(k)];
    const Part part = part_[triangle];
    std::uint32_t& known = known_[at(site)][part == Part::kWall ? 0 : 1];
    if (known == SiteId::kNoneValue) {
        known = static_cast<std::uint32_t>(quadrics_.size());
        quadrics_.push_back(fit(site, part));
    }
    return known;
}

Quadric CurvedSurface::fit(SiteId site, Part part) {
    ring_.clear();
    const auto add_around = [&](SiteId s) {
        for (std::uint32_t i = offsets_[at(s)]; i < offsets_[at(s) + 1]; ++i) {
            if (part_[around_[i]] != part) continue;
            for (const SiteId n : surface_.triangles[around_[i]])
                if (n != site && std::find(ring_.begin(), ring_.end(), n) == ring_.end()) ring_.push_back(n);
        }
    };
    add_around(site);
    for (std::size_t i = 0, first = ring_.size(); i < first; ++i) add_around(ring_[i]);
    ring_offset_.clear();
    for (const SiteId n : ring_) ring_offset_.push_back(surface_.points[at(n)] - surface_.points[at(site)]);
    return fit_quadric(ring_offset_, surface_.normals[at(site)]);
}

std::uint32_t CurvedSurface::neighbour(std::uint32_t triangle, int opposite_corner) const {
    const auto& t = surface_.triangles[triangle];
    const SiteId a = t[static_cast<std::size_t>((opposite_corner + 1) % 3)];
    const SiteId b = t[static_cast<std::size_t>((opposite_corner + 2) % 3)];
    for (std::uint32_t i = offsets_[at(a)]; i < offsets_[at(a) + 1]; ++i) {
        const auto& other = surface_.triangles[around_[i]];
        if (around_[i] != triangle && std::find(other.begin(), other.end(), b) != other.end()) return around_[i];
    }
    return triangle;
}

CurvedSurface::Place CurvedSurface::locate(Vec3 p, std::uint32_t triangle) const {
    const Vec3 a = corner(triangle, 0), u = corner(triangle, 1) - a, v = corner(triangle, 2) - a, w = p - a;
    const double uu = squared_norm(u), uv = dot(u, v), vv = squared_norm(v), wu = dot(w, u), wv = dot(w, v);
    const double det = uu * vv - uv * uv;
    if (!(det > 0)) return {triangle, {1, 0, 0}};
    const double s = (vv * wu - uv * wv) / det, t = (uu * wv - uv * wu) / det;
    return {triangle, {1 - s - t, s, t}};
}

SurfaceFoot CurvedSurface::evaluate(const Place& place) {
    const std::uint32_t t = place.triangle;
    const Vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    const Vec3 flat_normal = normalized(cross(b - a, c - a));
    const Vec3 p = place.weight[0] * a + place.weight[1] * b + place.weight[2] * c;
    SurfaceFoot foot;
    foot.triangle = TriangleId(std::size_t{t});
    foot.point = p;
    foot.weight = place.weight;
    if (part_[t] == Part::kCap) {
        foot.normal = flat_normal;
        const Vec3 u = any_perpendicular(flat_normal);
        foot.directions = {u, cross(flat_normal, u)};
        return foot;
    }
    SymmetricMatrix matrix{};
    for (int k = 0; k < 3; ++k) {
        const double weight = place.weight[static_cast<std::size_t>(k)];
        if (weight == 0) continue;
        const Quadric& q = quadrics_[quadric(t, k)];
        const SiteId site = surface_.triangles[t][static_cast<std::size_t>(k)];
        const Vec3 w = p - surface_.points[at(site)], normal = surface_.normals[at(site)];
        // The quadric over p, along the site's normal: the root of a quadratic that vanishes with the constant term.
        const double second = dot(normal, times(q.matrix, normal));
        const double first = dot(q.gradient, normal) + 2 * dot(normal, times(q.matrix, w));
        const double constant = dot(q.gradient, w) + dot(w, times(q.matrix, w));
        const double discriminant = first * first - 4 * second * constant;
        const bool over = first > 0 && discriminant > 0.25 * first * first;
        const double height = over ? -2 * constant / (first + std::sqrt(discriminant)) : -constant;
        const Vec3 gradient = q.gradient + 2.0 * times(q.matrix, w + height * normal);
        const double steepness = norm(gradient), share = q.share * weight;
        foot.point += (share * height) * normal;
        foot.normal += (share / steepness) * gradient + (weight - share) * flat_normal;
        for (std::size_t i = 0; i < 6; ++i) matrix[i] += share * 2 / steepness * q.matrix[i];
    }
    foot.normal = normalized(foot.normal);
    const Vec3 u = any_perpendicular(foot.normal), v = cross(foot.normal, u);
    principal(dot(u, times(matrix, u)), dot(u, times(matrix, v)), dot(v, times(matrix, v)), u, v, foot);
    return foot;
}

SurfaceFoot CurvedSurface::foot(Vec3 x, Vec3 start, TriangleId triangle) {
    Place place = locate(start, static_cast<std::uint32_t>(at(triangle)));
    clamp(place.weight);
    std::uint32_t before = place.triangle;
    SurfaceFoot foot = evaluate(place), best = foot;
    double least2 = squared_norm(x - foot.point);
    for (int step = 0; step < kMaxSteps; ++step) {
        const Vec3 r = x - foot.point;
        const double depth = -dot(r, foot.normal);
        Vec3 move;
        for (std::size_t k = 0; k < 2; ++k) {
            const double stretch = std::max(1 - depth * foot.curvature[k], kLeastStretch);
            move += (dot(r, foot.directions[k]) / stretch) * foot.directions[k];
        }
        const double edge = distance(corner(place.triangle, 0), corner(place.triangle, 1));
        const double length = norm(move);
        if (length > edge) move = (edge / length) * move;
        // To the facet under the new point; back and forth across an edge ends on the edge.
        Place next = locate(foot.point + move, place.triangle);
        const auto lowest = std::min_element(next.weight.begin(), next.weight.end());
        if (*lowest < 0) {
            const std::uint32_t over = neighbour(next.triangle, static_cast<int>(lowest - next.weight.begin()));
            if (over != before && over != next.triangle && part_[over] == part_[next.triangle]) {
                before = next.triangle;
                next = locate(foot.point + move, over);
            }
        }
        clamp(next.weight);
        const bool stays = next.triangle == place.triangle && next.weight == place.weight;
        if (stays) break;
        place = next;
        foot = evaluate(place);
        const double distance2 = squared_norm(x - foot.point);
        if (distance2 < least2) {
            least2 = distance2;
            best = foot;
        }
        if (length < kConverged * edge) break;
    }
    return best;
}

double CurvedSurface::uncertainty(const SurfaceFoot& foot) {
    const auto t = static_cast<std::uint32_t>(at(foot.triangle));
    if (part_[t] == Part::kCap) return 0;
    double sum2 = 0;
    for (int k = 0; k < 3; ++k) {
        const double offset = quadrics_[quadric(t, k)].offset;
        sum2 += foot.weight[static_cast<std::size_t>(k)] * offset * offset;
    }
    return std::sqrt(sum2);
}

std::array<double, 3> CurvedSurface::corner_offsets(const SurfaceFoot& foot) {
    const auto t = static_cast<std::uint32_t>(at(foot.triangle));
    if (part_[t] == Part::kCap) return {};
    return {quadrics_[quadric(t, 0)].offset, quadrics_[quadric(t, 1)].offset, quadrics_[quadric(t, 2)].offset};
}

SurfaceFoot CurvedSurface::nearest(Vec3 x, Vec3 hint, TriangleId hint_triangle) {
    const SurfaceDistance::Nearest flat = flat_.nearest(x, hint, hint_triangle);
    return foot(x, flat.point, flat.triangle);
}

}  // namespace lumenline
