// Four passes: circumcentres and verdicts (independent per cell), Morton keys of the inside cells, a
// gather of these cells in key order, and a look at the Voronoi edges between them. Only inside cells
// are gathered, half of all. The curve order halves the time of everything that follows on large
// models: polygons, marching. An edge between two inside vertices can still pass through the wall
// where two vessels touch or the surface is coarse: where its smallest ball is no larger than the
// triangles around, points along it are asked as well, and the edge is cut.
//
// Round openings put all sites of a ring on one circle. Cells of four of them have no height but what
// rounding gives, and their centre may be any point of a Voronoi edge on the axis; they adopt an end of
// that edge, or lines would depend on where the model lies.
#include "engine/voronoi/inside_cells.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/geometry/circumcentre.h"
#include "engine/geometry/inside_test.h"

namespace lumenline {

namespace {

constexpr std::size_t kGrain = 8192;
/// Squared share of the longest edge around a ball's sites above which the ball is far from the wall.
constexpr double kLargeBall2 = 0.6 * 0.6;
/// The same for Voronoi edges, against the longest edge of all sites of the cells around.
constexpr double kSafeEdge2 = 0.6 * 0.6;
/// Squared ratio of the longest edges of neighbours and of a site itself from which on the mesh is graded there.
constexpr double kGraded2 = 2 * 2;
/// Voronoi edges shorter than a fifth of their ball's radius are no way through a wall; squared.
constexpr double kShortEdge2 = 0.2 * 0.2;
/// Cells lower than this many times the rounding of coordinates have no centre of their own; where the rounding is
/// not small against edges, as far from the origin, it is noise like any other, and only cells lower than this share
/// of the edges are.
constexpr double kFlatRoundings = 64, kFlatShare = 0.01;
/// A ball touches the sites of a flat cell if none is farther from its sphere than this many heights: the centres along
/// the axis of one circle differ by few radii.
constexpr double kSettled = 8;

struct SiteFrame {
    Vec3 position, normal;
    double longest_edge = 0;
};

std::vector<SiteFrame> site_frames(const Surface& surface) {
    std::vector<SiteFrame> frames(surface.site_count());
    for (std::size_t i = 0; i < frames.size(); ++i) frames[i] = {surface.points[i], surface.normals[i], 0};
    for (const auto& t : surface.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t a = at(t[k]), b = at(t[(k + 1) % 3]);
            const double length2 = squared_norm(surface.points[a] - surface.points[b]);
            frames[a].longest_edge = std::max(frames[a].longest_edge, length2);
            frames[b].longest_edge = std::max(frames[b].longest_edge, length2);
        }
    // Beside triangles much larger than its own, a site's ball may be large for its own and still meet those.
    std::vector<double> around(frames.size(), 0);
    for (const auto& t : surface.triangles) {
        const double longest =
            std::max({frames[at(t[0])].longest_edge, frames[at(t[1])].longest_edge, frames[at(t[2])].longest_edge});
        for (const SiteId s : t) around[at(s)] = std::max(around[at(s)], longest);
    }
    for (std::size_t i = 0; i < frames.size(); ++i)
        if (around[i] > kGraded2 * frames[i].longest_edge) frames[i].longest_edge = around[i];
    return frames;
}

enum class Verdict : std::uint8_t { kOutside, kInside, kQueried };

/// The normals' verdict on one cell, or the need to ask.
Verdict judge(const std::vector<SiteFrame>& frames, const std::array<std::uint32_t, 4>& sites, Vec3 centre,
              double radius2) {
    int below = 0;
    double longest2 = 0;
    for (const std::uint32_t s : sites) {
        below += dot(frames[s].position - centre, frames[s].normal) > 0;
        longest2 = std::max(longest2, frames[s].longest_edge);
    }
    if ((below == 0 || below == 4) && radius2 > kLargeBall2 * longest2)
        return below == 4 ? Verdict::kInside : Verdict::kOutside;
    return Verdict::kQueried;
}

/// Spreads the low 21 bits of x to every third bit.
std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x1f00000000ffffULL;
    x = (x | x << 16) & 0x1f0000ff0000ffULL;
    x = (x | x << 8) & 0x100f00f00f00f00fULL;
    x = (x | x << 4) & 0x10c30c30c30c30c3ULL;
    return (x | x << 2) & 0x1249249249249249ULL;
}

struct Keyed {
    std::uint64_t key;
    std::uint32_t cell;
};

/// Stable radix sort by the upper 48 of the 63 key bits.
void sort_by_key(std::vector<Keyed>& items) {
    std::vector<Keyed> other(items.size());
    for (const int shift : {15, 31, 47}) {
        std::vector<std::uint32_t> start(65537, 0);
        for (const Keyed& k : items) ++start[((k.key >> shift) & 65535) + 1];
        for (std::size_t i = 0; i < 65536; ++i) start[i + 1] += start[i];
        for (const Keyed& k : items) other[start[(k.key >> shift) & 65535]++] = k;
        items.swap(other);
    }
}

std::vector<std::uint32_t> curve_order(const std::vector<Vec3>& centres, const std::vector<Verdict>& verdict, Vec3 low,
                                       Vec3 high) {
    const Vec3 size = high - low;
    const double scale = 2097151.0 / std::max({size.x, size.y, size.z});
    std::vector<Keyed> keyed;
    for (std::size_t i = 0; i < centres.size(); ++i) {
        if (verdict[i] != Verdict::kInside) continue;
        const Vec3 p = scale * (centres[i] - low);
        keyed.push_back({spread(static_cast<std::uint64_t>(p.x)) | spread(static_cast<std::uint64_t>(p.y)) << 1 |
                             spread(static_cast<std::uint64_t>(p.z)) << 2,
                         static_cast<std::uint32_t>(i)});
    }
    sort_by_key(keyed);
    std::vector<std::uint32_t> order(keyed.size());
    for (std::size_t i = 0; i < keyed.size(); ++i) order[i] = keyed[i].cell;
    return order;
}

/// A cell that has no centre of its own: lower than `height`, no more than 64 roundings or a hundredth of its edges.
double flat_height(const std::array<std::uint32_t, 4>& sites, const std::vector<SiteFrame>& frames,
                   double coordinate_rounding) {
    double longest2 = 0;
    for (const std::uint32_t s : sites) longest2 = std::max(longest2, frames[s].longest_edge);
    return std::min(kFlatRoundings * coordinate_rounding, kFlatShare * std::sqrt(longest2));
}

/// Gives flat cells that hang together the centre of the first cell beside them that is not flat, if its ball touches
/// their sites: those of one circle do. Where circles of several kinds hang together a cell takes the centre of one of
/// its own neighbours, or keeps what it has.
void settle_flat_cells(InsideCells& cells, const std::vector<std::uint8_t>& flat, const std::vector<SiteFrame>& frames,
                       double coordinate_rounding) {
    const auto touches = [&](std::uint32_t cell, std::uint32_t firm) {
        const double most = kSettled * flat_height(cells.sites[cell], frames, coordinate_rounding);
        return std::all_of(cells.sites[cell].begin(), cells.sites[cell].end(), [&](std::uint32_t s) {
            return std::fabs(distance(cells.centre[firm], frames[s].position) - cells.radius[firm]) <= most;
        });
    };
    std::vector<bool> seen(cells.count(), false);
    std::vector<std::uint32_t> group;
    for (std::uint32_t start = 0; start < cells.count(); ++start) {
        if (flat[start] == 0 || seen[start]) continue;
        std::uint32_t firm = InsideCells::kOutside;
        group.assign(1, start);
        seen[start] = true;
        for (std::size_t i = 0; i < group.size(); ++i)
            for (const std::uint32_t n : cells.neighbours[group[i]]) {
                if (n == InsideCells::kOutside || (flat[n] != 0 && seen[n])) continue;
                if (flat[n] == 0) {
                    firm = std::min(firm, n);
                    continue;
                }
                seen[n] = true;
                group.push_back(n);
            }
        if (firm == InsideCells::kOutside) continue;
        for (const std::uint32_t cell : group) {
            std::array<std::uint32_t, 5> choices{firm};
            std::copy(cells.neighbours[cell].begin(), cells.neighbours[cell].end(), choices.begin() + 1);
            std::sort(choices.begin() + 1, choices.end());
            const auto choice = std::find_if(choices.begin(), choices.end(), [&](std::uint32_t n) {
                return n != InsideCells::kOutside && flat[n] == 0 && touches(cell, n);
            });
            if (choice == choices.end()) continue;
            cells.centre[cell] = cells.centre[*choice];
            cells.radius[cell] = cells.radius[*choice];
        }
    }
}

/// Per site, the longest edge of any site with which it shares an inside cell, squared: the triangle
/// that passes through a ball need not be at the sites on the ball, nor of their size.
std::vector<double> longest_around(const InsideCells& cells, const std::vector<SiteFrame>& frames) {
    std::vector<double> around(frames.size(), 0);
    for (const auto& sites : cells.sites) {
        double longest2 = 0;
        for (const std::uint32_t s : sites) longest2 = std::max(longest2, frames[s].longest_edge);
        for (const std::uint32_t s : sites) around[s] = std::max(around[s], longest2);
    }
    return around;
}

/// Does the Voronoi edge between two inside cells leave the lumen?
bool leaves_lumen(const InsideCells& cells, const std::vector<double>& around, const InsideTest& test, std::size_t cell,
                  std::size_t face) {
    const std::uint32_t other = cells.neighbours[cell][face];
    double longest2 = 0;
    for (std::size_t k = 0; k < 4; ++k)
        if (k != face) longest2 = std::max(longest2, around[cells.sites[cell][k]]);
    const Vec3 from = cells.centre[cell], to = cells.centre[other];
    const double length2 = squared_norm(to - from);
    const double ra2 = cells.radius[cell] * cells.radius[cell], rb2 = cells.radius[other] * cells.radius[other];
    if (!(length2 > kShortEdge2 * ra2)) return false;
    // R^2 along the edge is t -> ra^2 + t (rb^2 - ra^2 - l^2) + t^2 l^2, least at t = m. A wall can only be where
    // it is small.
    const double m = 0.5 * (ra2 - rb2 + length2) / length2;
    const double reach2 = (kSafeEdge2 * longest2 - ra2) / length2 + m * m;
    if (!(reach2 > 0)) return false;
    const double t0 = std::max(0.0, m - std::sqrt(reach2)), t1 = std::min(1.0, m + std::sqrt(reach2));
    if (!(t0 < t1)) return false;
    if (m > 0 && m < 1 && !test.inside(lerp(from, to, m))) return true;
    // An eighth of a triangle apart: thin overlaps of two walls are not stepped over.
    const double pieces = std::clamp(std::ceil(8 * (t1 - t0) * std::sqrt(length2 / longest2)), 2.0, 32.0);
    for (double i = 1; i < pieces; ++i)
        if (!test.inside(lerp(from, to, std::lerp(t0, t1, i / pieces)))) return true;
    return false;
}

void cut_edges(InsideCells& cells, const std::vector<SiteFrame>& frames, const InsideTest& test,
               const StageContext& context) {
    const std::vector<double> around = longest_around(cells, frames);
    std::vector<std::uint8_t> cut(cells.count(), 0);  // faces, as bits
    context.parallel_for(cells.count(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell)
            for (std::size_t k = 0; k < 4; ++k) {
                const std::uint32_t other = cells.neighbours[cell][k];
                if (other == InsideCells::kOutside || other < cell) continue;
                if (leaves_lumen(cells, around, test, cell, k)) cut[cell] |= static_cast<std::uint8_t>(1U << k);
            }
    });
    for (std::uint32_t cell = 0; cell < cells.count(); ++cell)
        for (std::size_t k = 0; k < 4; ++k) {
            if ((cut[cell] >> k & 1) == 0) continue;
            for (std::uint32_t& back : cells.neighbours[cells.neighbours[cell][k]])
                if (back == cell) back = InsideCells::kOutside;
            cells.neighbours[cell][k] = InsideCells::kOutside;
            ++cells.cut_edges;
        }
}

/// Gathers the cells `order` of the tetrahedra. @returns which of them are flat
std::vector<std::uint8_t> gather(const Tetrahedra& tetrahedra, const std::vector<Vec3>& centres,
                                 const std::vector<std::uint32_t>& order, const std::vector<SiteFrame>& frames,
                                 double coordinate_rounding, InsideCells& inside, const StageContext& context) {
    std::vector<std::uint32_t> number(tetrahedra.count(), InsideCells::kOutside);
    for (std::size_t i = 0; i < order.size(); ++i) number[order[i]] = static_cast<std::uint32_t>(i);
    inside.centre.resize(order.size());
    inside.radius.resize(order.size());
    inside.sites.resize(order.size());
    inside.neighbours.resize(order.size());
    std::vector<std::uint8_t> flat(order.size(), 0);
    context.parallel_for(order.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t cell = order[i];
            inside.centre[i] = centres[cell];
            inside.sites[i] = tetrahedra.sites[cell];
            const auto corner = [&](std::size_t k) { return frames[inside.sites[i][k]].position; };
            inside.radius[i] = distance(centres[cell], corner(0));
            const double height = flat_height(inside.sites[i], frames, coordinate_rounding);
            flat[i] = is_flat(corner(0), corner(1), corner(2), corner(3), height) ? 1 : 0;
            for (std::size_t k = 0; k < 4; ++k) {
                const std::uint32_t n = tetrahedra.neighbours[cell][k];
                inside.neighbours[i][k] = n == Tetrahedra::kOuter ? InsideCells::kOutside : number[n];
            }
        }
    });
    return flat;
}

}  // namespace

InsideCells find_inside_cells(const Surface& surface, Tetrahedra tetrahedra, StageContext& context) {
    const std::vector<SiteFrame> frames = site_frames(surface);
    const InsideTest test(surface.points, surface.triangles);
    Vec3 low = surface.points.front(), high = low;
    for (const Vec3& p : surface.points)
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }

    const double reach = distance(low, high);
    const std::size_t count = tetrahedra.count();
    std::vector<Vec3> centres(count);
    std::vector<Verdict> verdict(count);
    std::vector<std::size_t> queried(count / kGrain + 1, 0);
    context.parallel_for(count, kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto& s = tetrahedra.sites[i];
            const Vec3 c = circumcentre(frames[s[0]].position, frames[s[1]].position, frames[s[2]].position,
                                        frames[s[3]].position, reach);
            centres[i] = c;
            const bool in_box =
                c.x > low.x && c.x < high.x && c.y > low.y && c.y < high.y && c.z > low.z && c.z < high.z;
            verdict[i] = in_box ? judge(frames, s, c, squared_norm(c - frames[s[0]].position)) : Verdict::kOutside;
            if (verdict[i] != Verdict::kQueried) continue;
            verdict[i] = test.inside(c) ? Verdict::kInside : Verdict::kOutside;
            ++queried[begin / kGrain];
        }
    });

    const std::vector<std::uint32_t> order = curve_order(centres, verdict, low, high);
    InsideCells inside;
    for (const std::size_t q : queried) inside.queried += q;
    const std::vector<std::uint8_t> flat =
        gather(tetrahedra, centres, order, frames, surface.coordinate_rounding, inside, context);
    if (std::find(flat.begin(), flat.end(), 1) != flat.end())
        settle_flat_cells(inside, flat, frames, surface.coordinate_rounding);
    cut_edges(inside, frames, test, context);
    return inside;
}

}  // namespace lumenline
