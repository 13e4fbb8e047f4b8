#include "engine/condition/flat_caps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "engine/condition/half_edges.h"
#include "engine/core/text.h"

// Flat regions grow from the largest triangles, whose normals are the surest. On a curved wall a region
// stops after two degrees, at an edge that is not sharp; so nearly all regions fail at the first test of
// their rim, and growing costs each triangle once.
//
// A box and a short flat vessel have patches that pass all tests of one patch alone. They are told by
// their neighbours: the wall beside the cap of a vessel is no cap.

namespace lumenline {
namespace {

constexpr double kSameNormal = 2;        // degrees, between a triangle and the first of its region
constexpr double kFlat = 0.01;           // of the patch's radius, from its plane
constexpr double kFlatLabelled = 0.05;   // the same, for a patch of equal labels
constexpr double kSharp = 35;            // degrees, by which the wall falls back at the rim
constexpr double kSharpShare = 0.95;     // of the rim's length
constexpr double kSharpLabelled = 0.75;  // the same, for a patch of equal labels
constexpr double kRoundness = 0.5;       // area per area of the circle of the same perimeter
constexpr std::size_t kFewestEdges = 8;  // of a rim
constexpr double kDepth = 1;             // of the patch's radius, to the wall opposite its centre
constexpr double kRoundings = 4;         // roundings of a coordinate by which a vertex may be misplaced

constexpr std::size_t kFewestOpeningEdges = 6;  // of a loop; smaller ones are holes

constexpr std::uint32_t kNoPatch = 0xffffffffU;

bool comes_before(Vec3 a, Vec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// How much a patch may deviate.
struct Patience {
    double flat, sharp_share;
};

/// A patch that is flat and has one rim.
struct CapShape {
    Vec3 centre, normal;
    double area = 0, radius = 0;
};

class CapFinder {
public:
    CapFinder(const WallMesh& wall, const TriangleSoup& soup)
        : wall_(wall),
          rounding_(kRoundings * soup.coordinate_rounding),
          pairs_(pair_half_edges(wall.triangles, wall.points.size())),
          patch_(wall.triangles.size(), kNoPatch) {
        for (const Corners& t : wall.triangles)
            doubled_.push_back(cross(wall.points[t[1]] - wall.points[t[0]], wall.points[t[2]] - wall.points[t[0]]));
    }

    std::vector<FlatCap> run(const TriangleSoup& soup) {
        for (const CellLabels& labels : soup.cell_labels) try_labels(labels_of_wall(soup, labels));
        grow_flat_regions();
        drop_neighbours();
        std::stable_sort(caps_.begin(), caps_.end(), [&](const FlatCap& a, const FlatCap& b) {
            return area_of(a.triangles) > area_of(b.triangles);
        });
        return std::move(caps_);
    }

private:
    [[nodiscard]] double area_of(const std::vector<std::uint32_t>& triangles) const {
        double area = 0;
        for (const std::uint32_t t : triangles) area += norm(doubled_[t]) / 2;
        return area;
    }

    [[nodiscard]] std::uint32_t neighbour(std::uint32_t half_edge) const {
        const std::uint32_t other = pairs_.opposite[half_edge];
        return other == kNoHalfEdge ? kNoPatch : other / 3;
    }

    /// Everything joined to `seed` for which `belongs` holds becomes patch number `id`.
    template <class Belongs>
    std::vector<std::uint32_t> grow(std::uint32_t seed, std::uint32_t id, const Belongs& belongs) {
        std::vector<std::uint32_t> region{seed};
        patch_[seed] = id;
        for (std::size_t i = 0; i < region.size(); ++i)
            for (std::uint32_t h = 3 * region[i]; h < 3 * region[i] + 3; ++h) {
                const std::uint32_t t = neighbour(h);
                if (t == kNoPatch || patch_[t] != kNoPatch || !belongs(t)) continue;
                patch_[t] = id;
                region.push_back(t);
            }
        return region;
    }

    /// Labels of the wall's triangles; none where a triangle is not one of the file's. Conditioning has
    /// dropped triangles and turned others, but corners kept their positions.
    [[nodiscard]] std::vector<std::optional<std::int32_t>> labels_of_wall(const TriangleSoup& soup,
                                                                          const CellLabels& labels) const {
        using Key = std::array<std::tuple<double, double, double>, 3>;
        const auto key = [](const std::vector<Vec3>& points, const Corners& t) {
            Key k;
            for (std::size_t i = 0; i < 3; ++i) k[i] = {points[t[i]].x, points[t[i]].y, points[t[i]].z};
            std::sort(k.begin(), k.end());
            return k;
        };
        std::map<Key, std::int32_t> known;
        for (std::size_t t = 0; t < soup.triangles.size(); ++t)
            known.try_emplace(key(soup.points, soup.triangles[t]), labels.values[t]);
        std::vector<std::optional<std::int32_t>> result(wall_.triangles.size());
        for (std::size_t t = 0; t < result.size(); ++t)
            if (const auto found = known.find(key(wall_.points, wall_.triangles[t])); found != known.end())
                result[t] = found->second;
        return result;
    }

    void try_labels(const std::vector<std::optional<std::int32_t>>& labels) {
        std::vector<std::vector<std::uint32_t>> regions;
        for (std::uint32_t seed = 0; seed < labels.size(); ++seed)
            if (labels[seed] && patch_[seed] == kNoPatch)
                regions.push_back(grow(seed, seed, [&](std::uint32_t t) { return labels[t] == labels[seed]; }));
        for (const auto& region : regions) try_patch(region, {kFlatLabelled, kSharpLabelled});
        std::fill(patch_.begin(), patch_.end(), kNoPatch);
        for (const FlatCap& cap : caps_)
            for (const std::uint32_t t : cap.triangles) patch_[t] = cap.triangles.front();
    }

    void grow_flat_regions() {
        std::vector<std::uint32_t> seeds(wall_.triangles.size());
        std::iota(seeds.begin(), seeds.end(), 0U);
        std::stable_sort(seeds.begin(), seeds.end(), [&](std::uint32_t a, std::uint32_t b) {
            return squared_norm(doubled_[a]) > squared_norm(doubled_[b]);
        });
        for (const std::uint32_t seed : seeds) {
            if (patch_[seed] != kNoPatch) continue;
            const Vec3 normal = normalized(doubled_[seed]);
            const auto region = grow(seed, seed, [&](std::uint32_t t) { return is_parallel(t, normal); });
            try_patch(region, {kFlat, kSharpShare});
        }
    }

    /// Rounding turns a triangle by up to its share of the triangle's least height.
    [[nodiscard]] bool is_parallel(std::uint32_t t, Vec3 normal) const {
        const Corners& c = wall_.triangles[t];
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(longest, distance(wall_.points[c[k]], wall_.points[c[(k + 1) % 3]]));
        const double doubled_area = norm(doubled_[t]);
        if (!(doubled_area > rounding_ * longest)) return true;
        const double allowed = radians(kSameNormal) + rounding_ * longest / doubled_area;
        return allowed > std::numbers::pi / 2 || dot(doubled_[t], normal) >= std::cos(allowed) * doubled_area;
    }

    /// The rim as one loop; nothing if there is none, more than one, or one that touches itself.
    [[nodiscard]] std::optional<Loop> rim_of(const std::vector<std::uint32_t>& region) const {
        std::map<std::uint32_t, std::uint32_t> next;
        for (const std::uint32_t t : region)
            for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
                if (pairs_.opposite[h] == kNoHalfEdge) return std::nullopt;
                if (patch_[neighbour(h)] == patch_[t]) continue;
                if (!next.emplace(start_of(wall_.triangles, h), start_of(wall_.triangles, next_half_edge(h))).second)
                    return std::nullopt;
            }
        if (next.size() < kFewestEdges) return std::nullopt;
        Loop rim;
        std::uint32_t v = next.begin()->first;
        do {
            rim.push_back(v);
            const auto step = next.find(v);
            if (step == next.end() || rim.size() > next.size()) return std::nullopt;
            v = step->second;
        } while (v != rim.front());
        if (rim.size() != next.size()) return std::nullopt;
        return rim;
    }

    [[nodiscard]] CapShape measure(const std::vector<std::uint32_t>& region) const {
        CapShape patch;
        Vec3 sum, weighted;
        const Vec3 start = wall_.points[wall_.triangles[region.front()][0]];
        for (const std::uint32_t t : region) {
            const Corners& c = wall_.triangles[t];
            const double area = norm(doubled_[t]) / 2;
            sum += doubled_[t];
            patch.area += area;
            for (const std::uint32_t v : c) weighted += area / 3 * (wall_.points[v] - start);
        }
        patch.normal = normalized(sum);
        patch.centre = start + (1 / patch.area) * weighted;
        patch.radius = std::sqrt(patch.area / std::numbers::pi);
        return patch;
    }

    bool try_patch(const std::vector<std::uint32_t>& region, Patience patience) {
        std::optional<Loop> rim = rim_of(region);
        if (!rim) return false;
        const CapShape patch = measure(region);
        if (!(patch.area > 0) || !is_disc(*rim, patch) || !is_flat(region, patch, patience.flat) ||
            !has_sharp_rim(region, patch, patience.sharp_share) || !has_depth(patch, patch_[region.front()]))
            return false;
        FlatCap cap{region, std::move(*rim)};
        std::sort(cap.triangles.begin(), cap.triangles.end());
        for (const std::uint32_t t : cap.triangles) patch_[t] = cap.triangles.front();
        caps_.push_back(std::move(cap));
        return true;
    }

    [[nodiscard]] bool is_disc(const Loop& rim, const CapShape& patch) const {
        double perimeter = 0;
        for (std::size_t i = 0; i < rim.size(); ++i)
            perimeter += distance(wall_.points[rim[i]], wall_.points[rim[(i + 1) % rim.size()]]);
        return patch.area * 4 * std::numbers::pi >= kRoundness * perimeter * perimeter;
    }

    [[nodiscard]] bool is_flat(const std::vector<std::uint32_t>& region, const CapShape& patch, double flat) const {
        const double allowed = flat * patch.radius + rounding_;
        return std::all_of(region.begin(), region.end(), [&](std::uint32_t t) {
            const Corners& c = wall_.triangles[t];
            return std::all_of(c.begin(), c.end(), [&](std::uint32_t v) {
                return std::fabs(dot(wall_.points[v] - patch.centre, patch.normal)) <= allowed;
            });
        });
    }

    /// By the slope of the triangles beyond the rim, from the edge to the corner that faces it.
    [[nodiscard]] bool has_sharp_rim(const std::vector<std::uint32_t>& region, const CapShape& patch,
                                     double share) const {
        double sharp = 0, perimeter = 0;
        for (const std::uint32_t t : region)
            for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
                if (patch_[neighbour(h)] == patch_[t]) continue;
                const Vec3 a = wall_.points[start_of(wall_.triangles, h)];
                const Vec3 b = wall_.points[start_of(wall_.triangles, next_half_edge(h))];
                const Vec3 far = wall_.points[start_of(wall_.triangles, previous_half_edge(pairs_.opposite[h]))];
                const Vec3 along = normalized(b - a);
                const Vec3 up = (far - a) - dot(far - a, along) * along;
                const double fall = -dot(up, patch.normal), out = dot(up, cross(along, patch.normal));
                perimeter += distance(a, b);
                if (fall > 0 && std::atan2(fall, out) >= radians(kSharp)) sharp += distance(a, b);
            }
        return sharp >= share * perimeter;
    }

    /// Shoots a ray from the centre into the lumen.
    [[nodiscard]] bool has_depth(const CapShape& patch, std::uint32_t id) const {
        const Vec3 ray = -patch.normal, u = any_perpendicular(ray), v = cross(ray, u);
        const double nearest = kDepth * patch.radius;
        for (std::uint32_t t = 0; t < wall_.triangles.size(); ++t) {
            if (patch_[t] == id) continue;
            std::array<Vec3, 3> q;  // corners along u, v and the ray
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 d = wall_.points[wall_.triangles[t][k]] - patch.centre;
                q[k] = {dot(d, u), dot(d, v), dot(d, ray)};
            }
            std::array<double, 3> weight{};
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 a = q[(k + 1) % 3], b = q[(k + 2) % 3];
                weight[k] = a.x * b.y - a.y * b.x;
            }
            const auto [low, high] = std::minmax_element(weight.begin(), weight.end());
            const double sum = weight[0] + weight[1] + weight[2];
            if ((*low < 0 && *high > 0) || sum == 0) continue;
            const double depth = (weight[0] * q[0].z + weight[1] * q[1].z + weight[2] * q[2].z) / sum;
            if (depth > 0 && depth < nearest) return false;
        }
        return true;
    }

    /// Takes out the caps that share a vertex with another one.
    void drop_neighbours() {
        std::map<std::uint32_t, std::size_t> rim_of_vertex;
        std::vector<char> dropped(caps_.size(), 0);
        for (std::size_t i = 0; i < caps_.size(); ++i)
            for (const std::uint32_t v : caps_[i].rim)
                if (const auto [other, is_new] = rim_of_vertex.emplace(v, i); !is_new && other->second != i)
                    dropped[i] = dropped[other->second] = 1;
        std::size_t kept = 0;
        for (std::size_t i = 0; i < caps_.size(); ++i)
            if (!dropped[i]) {
                if (kept != i) caps_[kept] = std::move(caps_[i]);
                ++kept;
            }
        caps_.resize(kept);
    }

    const WallMesh& wall_;
    double rounding_;  // [length]
    HalfEdgePairs pairs_;
    std::vector<std::uint32_t> patch_;  // of each triangle: the patch tried last
    std::vector<Vec3> doubled_;         // twice the area vector of each triangle
    std::vector<FlatCap> caps_;
};

}  // namespace

std::vector<FlatCap> find_flat_caps(const WallMesh& wall, const TriangleSoup& soup) {
    return CapFinder(wall, soup).run(soup);
}

std::vector<Vec3> open_flat_caps(WallMesh& wall, WallTopology& topology, const TriangleSoup& soup,
                                 StageContext& context) {
    const std::vector<FlatCap> caps = find_flat_caps(wall, soup);
    if (caps.empty()) return {};
    std::vector<char> gone(wall.triangles.size(), 0);
    std::vector<Vec3> rim;
    for (const FlatCap& cap : caps) {
        for (const std::uint32_t t : cap.triangles) gone[t] = 1;
        for (const std::uint32_t v : cap.rim) rim.push_back(wall.points[v]);
    }
    std::size_t kept = 0;
    for (std::size_t t = 0; t < gone.size(); ++t)
        if (!gone[t]) wall.triangles[kept++] = wall.triangles[t];
    wall.triangles.resize(kept);
    const std::vector<std::uint32_t> renumbered = drop_unused_vertices(wall);
    for (const FlatCap& cap : caps) topology.loops.push_back(cap.rim);
    for (Loop& loop : topology.loops) {
        for (std::uint32_t& v : loop) v = renumbered[v];
        std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    }
    std::sort(topology.loops.begin(), topology.loops.end());
    std::vector<std::uint32_t> component(wall.points.size());
    for (std::size_t v = 0; v < renumbered.size(); ++v)
        if (renumbered[v] != kDropped) component[renumbered[v]] = topology.component[v];
    topology.component = std::move(component);
    context.note("flat_caps_opened",
                 counted(caps.size(), "flat cap") + " taken off; the ends under them are extended like openings",
                 static_cast<double>(caps.size()));
    std::sort(rim.begin(), rim.end(), comes_before);
    return rim;
}

bool has_no_opening(const WallTopology& topology) {
    return std::all_of(topology.loops.begin(), topology.loops.end(),
                       [](const Loop& loop) { return loop.size() < kFewestOpeningEdges; });
}

void mark_flat_caps(Surface& surface, const std::vector<Vec3>& rim) {
    for (Opening& opening : surface.openings)
        opening.flat_cap = std::any_of(opening.loop.begin(), opening.loop.end(), [&](SiteId s) {
            return std::binary_search(rim.begin(), rim.end(), surface.points[at(s)], comes_before);
        });
}

}  // namespace lumenline
