// The largest ball of each part of the complex starts a first sweep; the vertex it reaches last is an
// extreme of the part and the root of a second sweep, on whose lengths the merge tree stands.
//
// Lengths are taken along the paths of least cost, not of least length: those keep to the middle of the
// lumen, where balls are largest, so that a path that leaves the balls of another has left its vessel.
// The complex of a real surface bristles with spurs towards bumps of the wall. A spur adds no more than
// the radius at its root to the length, so its branch of the merge tree ends before it leaves the balls
// of the vessel it stands on; and the edge of a flat lumen is no maximum at all, for along it the
// length keeps growing.
#include "engine/endpoints/tips.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

#include "engine/endpoints/shortest_paths.h"

namespace lumenline {

namespace {

constexpr double kInset = 1.25;         // of a tip's vertex, from the wall beyond the tip, in its ball radii
constexpr double kGrowth = 0.1;         // of the balls over the next radius inward, at most, beyond a spur
constexpr double kDeepest = 2;          // of a tip's vertex, from the wall beyond the tip, in its ball radii
constexpr double kCoverStep = 0.5;      // between balls that cover, in their radii
constexpr double kLoopReach = 2;        // cost below the tip's vertex down to which its part is one region
constexpr double kLoopBand = 1;         // cost of the band below the region in which its necks are counted
constexpr double kLoopRadius = 0.5;     // least radius of a neck that counts, in the tip's
constexpr double kLeastEdges = 2;       // length of a branch in median edges: shorter ones are cracks of the sampling
constexpr double kOpeningRadii = 1.75;  // of an opening's centre, within which its own end lies

using Vertex = std::uint32_t;
constexpr Vertex kNoVertex = VoronoiVertexId::kNoneValue;

/// Union of sets of vertices by the merge tree's elder rule: a set is named after its first vertex.
class ElderSets {
public:
    explicit ElderSets(std::size_t count) : above_(count) { std::iota(above_.begin(), above_.end(), 0U); }

    Vertex find(Vertex v) {
        while (above_[v] != v) v = above_[v] = above_[above_[v]];
        return v;
    }
    void join(Vertex younger, Vertex elder) { above_[younger] = elder; }

private:
    std::vector<Vertex> above_;
};

template <class Visit>
void for_each_neighbour(const VoronoiComplex& complex, Vertex v, const Visit& visit) {
    for (const PolygonId p : complex.polygons_of(VoronoiVertexId(v)))
        for (const VoronoiVertexId w : complex.polygon(p))
            if (w.value != v) visit(w.value);
}

/// Visits everything joined to `start` through vertices for which `belongs` holds, each once.
template <class Belongs, class Visit>
void flood(const VoronoiComplex& complex, Vertex start, const Belongs& belongs, const Visit& visit) {
    std::vector<Vertex> front{start};
    while (!front.empty()) {
        const Vertex v = front.back();
        front.pop_back();
        visit(v);
        for_each_neighbour(complex, v, [&](Vertex w) {
            if (belongs(w)) front.push_back(w);
        });
    }
}

/// The vertex of largest ball in each connected part of the complex.
std::vector<Seed> largest_balls(const VoronoiComplex& complex) {
    std::vector<char> seen(complex.vertex_count(), 0);
    std::vector<Seed> seeds;
    for (Vertex start = 0; start < complex.vertex_count(); ++start) {
        if (seen[start]) continue;
        Vertex largest = start;
        seen[start] = 1;
        const auto enter = [&](Vertex w) { return seen[w] ? false : (seen[w] = 1, true); };
        flood(complex, start, enter, [&](Vertex v) {
            if (complex.ball_radius[v] > complex.ball_radius[largest]) largest = v;
        });
        seeds.push_back({VoronoiVertexId(largest), 0});
    }
    return seeds;
}

/// For each vertex where the length has a maximum, the length at which its branch of the merge tree
/// joins an older one; 0 at the root's own maximum. Negative at all other vertices.
std::vector<double> branch_ends(const VoronoiComplex& complex, const ShortestPaths& paths,
                                const std::vector<Vertex>& descending) {
    std::vector<double> ends(complex.vertex_count(), -1);
    std::vector<char> entered(complex.vertex_count(), 0);
    ElderSets sets(complex.vertex_count());
    std::vector<std::uint32_t> rank(complex.vertex_count());
    for (std::size_t i = 0; i < descending.size(); ++i) rank[descending[i]] = static_cast<std::uint32_t>(i);
    for (const Vertex v : descending) {
        entered[v] = 1;
        ends[v] = 0;
        for_each_neighbour(complex, v, [&](Vertex w) {
            if (!entered[w]) return;
            Vertex elder = sets.find(w), younger = sets.find(v);
            if (elder == younger) return;
            if (rank[younger] < rank[elder]) std::swap(elder, younger);
            ends[younger] = younger == v ? -1 : paths.length[v];
            sets.join(younger, elder);
        });
    }
    return ends;
}

class TipFinder {
public:
    TipFinder(const Surface& surface, const VoronoiComplex& complex, double tip_length, StageContext& context)
        : surface_(surface),
          complex_(complex),
          tip_length_(tip_length),
          context_(context),
          covered_(complex.vertex_count(), 0),
          stamp_(complex.vertex_count(), 0) {}

    std::vector<Tip> run() {
        const ShortestPaths first = shortest_paths(complex_, largest_balls(complex_), context_);
        const std::vector<Seed> roots = farthest_of_each_part(first);
        const ShortestPaths paths = shortest_paths(complex_, roots, context_);
        const std::vector<Vertex> descending = by_descending_length(paths);
        const std::vector<double> ends = branch_ends(complex_, paths, descending);
        for (const Seed& root : roots) cover_root(first, root.vertex.value);
        for (const Vertex v : descending)
            if (ends[v] >= 0) try_tip(paths, v, ends[v]);
        return with_roots(first, roots);
    }

private:
    /// What a path back from a tip shows.
    struct Branch {
        Vertex anchor = kNoVertex, inner = kNoVertex;  ///< a little inside the tip, and one radius on
        double length = 0;                             ///< outside of the covered region [length]
        double radius = 0;                             ///< mean along it [length]
    };

    std::vector<Seed> farthest_of_each_part(const ShortestPaths& paths) {
        std::vector<Vertex> origin(complex_.vertex_count(), kNoVertex);
        std::vector<Vertex> farthest(complex_.vertex_count(), kNoVertex);
        for (const Vertex v : by_descending_length(paths)) {
            std::vector<Vertex> walked;
            Vertex root = v;
            while (origin[root] == kNoVertex && !paths.parent[root].is_none()) {
                walked.push_back(root);
                root = paths.parent[root].value;
            }
            root = origin[root] == kNoVertex ? root : origin[root];
            origin[root] = root;
            for (const Vertex w : walked) origin[w] = root;
            if (farthest[root] == kNoVertex) farthest[root] = v;
        }
        std::vector<Seed> seeds;
        for (Vertex v = 0; v < farthest.size(); ++v)
            if (farthest[v] != kNoVertex) seeds.push_back({VoronoiVertexId(farthest[v]), 0});
        return seeds;
    }

    [[nodiscard]] std::vector<Vertex> by_descending_length(const ShortestPaths& paths) const {
        std::vector<Vertex> order(complex_.vertex_count());
        std::iota(order.begin(), order.end(), 0U);
        std::sort(order.begin(), order.end(), [&](Vertex a, Vertex b) {
            return paths.length[a] != paths.length[b] ? paths.length[a] > paths.length[b] : a < b;
        });
        return order;
    }

    /// Walks from `tip` towards the root, as far as the length `end` or the covered region.
    [[nodiscard]] Branch measure(const ShortestPaths& paths, Vertex tip, double end) const {
        std::vector<Vertex> path{tip};
        Branch branch;
        double integral = 0;
        for (Vertex v = tip; !covered_[v] && paths.length[v] > end && !paths.parent[v].is_none(); v = path.back()) {
            path.push_back(paths.parent[v].value);
            const double step = paths.length[v] - paths.length[path.back()];
            integral += 0.5 * step * (complex_.ball_radius[v] + complex_.ball_radius[path.back()]);
            branch.length += step;
        }
        branch.radius = branch.length > 0 ? integral / branch.length : complex_.ball_radius[tip];
        branch.length += complex_.ball_radius[tip];
        branch.anchor = path[anchor_on(paths, path)];
        branch.inner = branch.anchor;
        while (!paths.parent[branch.inner].is_none() &&
               distance(complex_.vertices[branch.inner], complex_.vertices[branch.anchor]) <
                   complex_.ball_radius[branch.anchor])
            branch.inner = paths.parent[branch.inner].value;
        return branch;
    }

    /// The vertex of a tip's path that is far enough from the wall beyond the tip and past the spur into a
    /// corner of the end: one radius further in, balls are hardly larger. Within two radii of the end, the
    /// first of which that holds, else the one of which it holds best.
    [[nodiscard]] std::size_t anchor_on(const ShortestPaths& paths, const std::vector<Vertex>& path) const {
        const auto radius = [&](std::size_t i) { return complex_.ball_radius[path[i]]; };
        const auto back = [&](std::size_t i) { return paths.length[path[0]] - paths.length[path[i]]; };
        std::size_t i = 0;
        while (i + 1 < path.size() && back(i) + radius(0) < kInset * radius(i)) ++i;
        std::size_t best = i;
        double least = std::numeric_limits<double>::infinity();
        for (; i < path.size() && back(i) + radius(0) <= kDeepest * radius(i); ++i) {
            const double growth = growth_from(paths, path, i);
            if (growth < least) {
                least = growth;
                best = i;
            }
            if (growth <= kGrowth) break;
        }
        return best;
    }

    /// Largest growth of the ball radius along the path from vertex `i` to the first one beyond one radius,
    /// per radius or length, whichever is more.
    [[nodiscard]] double growth_from(const ShortestPaths& paths, const std::vector<Vertex>& path, std::size_t i) const {
        const double radius = complex_.ball_radius[path[i]];
        double growth = 0, along = 0;
        for (std::size_t k = i + 1; k < path.size() && along < radius; ++k) {
            along = paths.length[path[i]] - paths.length[path[k]];
            growth = std::max(growth, (complex_.ball_radius[path[k]] - radius) / std::max(along, radius));
        }
        return growth;
    }

    void cover_root(const ShortestPaths& first, Vertex root) {
        const Branch branch = measure(first, root, 0);
        cover_ball(branch.anchor);
        cover_path(first, root, branch.anchor);
    }

    void cover_ball(Vertex centre) {
        ++visit_;
        stamp_[centre] = visit_;
        const double radius2 = complex_.ball_radius[centre] * complex_.ball_radius[centre];
        const auto enter = [&](Vertex w) {
            if (stamp_[w] == visit_ || squared_norm(complex_.vertices[w] - complex_.vertices[centre]) > radius2)
                return false;
            stamp_[w] = visit_;
            return true;
        };
        flood(complex_, centre, enter, [&](Vertex v) { covered_[v] = 1; });
    }

    /// Covers the balls of the path from `v` on, until it is `last` or covered already.
    void cover_path(const ShortestPaths& paths, Vertex v, Vertex last = kNoVertex) {
        double since = std::numeric_limits<double>::infinity();
        std::vector<Vertex> path;
        for (; v != kNoVertex && v != last && !covered_[v]; v = paths.parent[v].value) path.push_back(v);
        for (std::size_t i = 0; i < path.size(); ++i) {
            if (i > 0) since += paths.length[path[i - 1]] - paths.length[path[i]];
            if (since < kCoverStep * complex_.ball_radius[path[i]] && i + 1 < path.size()) continue;
            cover_ball(path[i]);
            since = 0;
        }
    }

    void try_tip(const ShortestPaths& paths, Vertex end, double branch_end) {
        if (covered_[end]) return;
        const Branch branch = measure(paths, end, branch_end);
        if (!(branch.length > std::max(tip_length_ * branch.radius, kLeastEdges * surface_.median_edge))) return;
        cover_path(paths, end);
        Vertex root = end;
        while (!paths.parent[root].is_none()) root = paths.parent[root].value;
        branched_.insert(root);
        if (closes_loop(paths, branch.anchor) || is_opening(branch.anchor)) return;
        tips_.push_back(make_tip(branch, end));
    }

    Tip make_tip(const Branch& branch, Vertex end) const {
        const Vec3 x = complex_.vertices[branch.anchor];
        return {VoronoiVertexId(branch.anchor), VoronoiVertexId(end), normalized(x - complex_.vertices[branch.inner]),
                branch.length, branch.length / branch.radius};
    }

    [[nodiscard]] bool is_opening(Vertex v) const {
        const Vec3 x = complex_.vertices[v];
        return std::any_of(surface_.openings.begin(), surface_.openings.end(), [&](const Opening& o) {
            const double height = std::clamp(dot(x - o.point, o.axis), 0.0, o.extension_length);
            return distance(x, o.point + height * o.axis) < kOpeningRadii * o.radius;
        });
    }

    /// Whether the part of the lumen around a maximum has two necks. Beyond a tip there is nothing, and
    /// the front that arrives there came through one neck; on the far side of a loop it came through two,
    /// of which the other one is covered here.
    bool closes_loop(const ShortestPaths& paths, Vertex anchor) {
        if (surface_.genus == 0) return false;
        const double low = paths.cost[anchor] - kLoopReach, lowest = low - kLoopBand;
        const double least_radius = kLoopRadius * complex_.ball_radius[anchor];
        std::vector<Vertex> below;
        ++visit_;
        stamp_[anchor] = visit_;
        const auto enter_region = [&](Vertex w) {
            if (stamp_[w] == visit_) return false;
            stamp_[w] = visit_;
            if (paths.cost[w] < low) below.push_back(w);
            return paths.cost[w] >= low;
        };
        flood(complex_, anchor, enter_region, [](Vertex) {});

        ++visit_;
        std::vector<Vertex> necks;
        for (const Vertex start : below) {
            if (stamp_[start] == visit_) continue;
            stamp_[start] = visit_;
            Vertex widest = start;
            const auto enter_band = [&](Vertex w) {
                if (stamp_[w] == visit_ || paths.cost[w] >= low || paths.cost[w] < lowest) return false;
                stamp_[w] = visit_;
                return true;
            };
            flood(complex_, start, enter_band, [&](Vertex v) {
                if (complex_.ball_radius[v] > complex_.ball_radius[widest]) widest = v;
            });
            if (complex_.ball_radius[widest] >= least_radius) necks.push_back(widest);
        }
        bool loop = false;
        for (const Vertex neck : necks) {
            const Branch other = measure(paths, neck, 0);
            if (covered_[neck] || !(other.length > tip_length_ * other.radius)) continue;
            cover_path(paths, neck);
            loop = true;
        }
        return loop;
    }

    /// Puts the roots first, which no path ends at: they are tips where their part has another end.
    std::vector<Tip> with_roots(const ShortestPaths& first, const std::vector<Seed>& roots) {
        std::vector<Tip> tips;
        std::fill(covered_.begin(), covered_.end(), 0);
        for (const Seed& root : roots) {
            if (!branched_.contains(root.vertex.value)) continue;
            const Branch branch = measure(first, root.vertex.value, 0);
            if (closes_loop(first, branch.anchor) || is_opening(branch.anchor)) continue;
            tips.push_back(make_tip(branch, root.vertex.value));
        }
        tips.insert(tips.end(), tips_.begin(), tips_.end());
        return tips;
    }

    const Surface& surface_;
    const VoronoiComplex& complex_;
    double tip_length_;
    StageContext& context_;
    std::vector<char> covered_;
    std::vector<std::uint32_t> stamp_;  // of the last flood that entered each vertex
    std::uint32_t visit_ = 0;
    std::set<Vertex> branched_;  // roots that a branch leads to
    std::vector<Tip> tips_;
};

}  // namespace

std::vector<Tip> find_tips(const Surface& surface, const VoronoiComplex& complex, double tip_length,
                           StageContext& context) {
    return TipFinder(surface, complex, tip_length, context).run();
}

}  // namespace lumenline
