// Of the lines that run through a branch the one with the larger balls at its junctions stands for it. There the lines
// begin to turn off, and a line into a narrow side branch comes near the wall while it still is in the parent's tube:
// as the parent's axis it would show a stenosis, and a bend towards the side branch. How far the lines go on behind the
// junction plays a part only between equal balls. The own part of a branch is that line's between the parts of its two
// junctions; from there to the origins of the junctions the branch is taken to be straight. Lines round the corners of
// a junction, their axes do not.
#include "engine/branches/graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <queue>

#include "engine/core/text.h"

namespace lumenline {

namespace {

constexpr double kAxisFrom = 0.5,
                 kAxisTo = 2;        // of the radius: what of an own part, next to a junction, gives its axis
constexpr double kBentShare = 0.25;  // of an own part, at most, that is left out there
constexpr std::size_t kAxisSamples = 9;
constexpr double kHold = 0.05;  // share by which the origin is held to the mean

/// A straight axis.
struct Axis {
    Vec3 centre, direction;  // unit, away from the junction
};

/// Fitted to the line next to `at`, where it may still round the corner, at most up to `to`, which may lie before it.
Axis fitted_axis(const LineView& line, double at, double to) {
    const double radius = line.radius_at(at), length = std::fabs(to - at), sign = to > at ? 1 : -1;
    const double start = at + sign * std::min(kAxisFrom * radius, kBentShare * length);
    const double end = at + sign * std::min(kAxisTo * radius, length);
    std::array<Vec3, kAxisSamples> x;
    Axis axis;
    for (std::size_t k = 0; k < kAxisSamples; ++k) {
        x[k] = line.position(std::lerp(start, end, static_cast<double>(k) / (kAxisSamples - 1)));
        axis.centre += (1.0 / kAxisSamples) * x[k];
    }
    for (std::size_t k = 0; k < kAxisSamples; ++k)
        axis.direction += (static_cast<double>(k) - 0.5 * (kAxisSamples - 1)) * x[k];
    axis.direction = normalized(axis.direction);
    return axis;
}

/// Solves a symmetric positive definite system of three by Cramer's rule.
Vec3 solved(const std::array<Vec3, 3>& a, Vec3 b) {
    const Vec3 c = cross(a[1], a[2]);
    const double determinant = dot(a[0], c);
    return (1 / determinant) * (b.x * c + b.y * cross(a[2], a[0]) + b.z * cross(a[0], a[1]));
}

/// The point nearest to the axes, held to `prior`.
Vec3 nearest_to_axes(const std::vector<Axis>& axes, Vec3 prior) {
    const double hold = kHold * static_cast<double>(axes.size());
    std::array<Vec3, 3> matrix{Vec3{hold, 0, 0}, Vec3{0, hold, 0}, Vec3{0, 0, hold}};
    Vec3 right;
    for (const Axis& axis : axes) {
        const Vec3 d = axis.direction, away = axis.centre - prior;
        for (int k = 0; k < 3; ++k) {
            Vec3 row = -d[k] * d;
            row[k] += 1;
            matrix[static_cast<std::size_t>(k)] += row;
        }
        right += away - dot(away, d) * d;
    }
    return prior + solved(matrix, right);
}

class GraphMaker {
public:
    GraphMaker(const Split& split, const Centerlines& lines, std::span<const LineView> views)
        : split_(split), lines_(lines), views_(views) {}

    GraphDraft run() {
        choose_tracts();
        place_nodes();
        measure_extents();
        number_branches();
        name_nodes();
        for (BranchCourse& b : draft_.branches) finish(b);
        make_pieces();
        return std::move(draft_);
    }

private:
    /// An edge of the split: tracts of lines that run together.
    struct Edge {
        std::size_t tract = 0;           // of the line that stands for it
        std::pair<double, double> rank;  // of that line: its balls at the junctions, its length
        std::size_t line_count = 0;
        double extent = 0;
        std::size_t branch = BranchCourse::kNone;
        bool second = false;  // the half of a branch that closes a loop, run from behind
    };

    [[nodiscard]] const Tract& tract_of(std::size_t e) const { return split_.tracts[edges_[e].tract]; }
    [[nodiscard]] const LineView& view_of(std::size_t e) const { return views_[tract_of(e).line]; }

    void choose_tracts() {
        edges_.resize(split_.edge_count);
        for (std::size_t t = 0; t < split_.tracts.size(); ++t) {
            Edge& edge = edges_[split_.tracts[t].edge];
            const Tract& tract = split_.tracts[t];
            const std::pair rank{balls_at_junctions(tract), views_[tract.line].length()};
            if (edge.line_count++ > 0 && rank <= edge.rank) continue;
            edge.tract = t;
            edge.rank = rank;
        }
        incident_.resize(split_.nodes.size());
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            incident_[tract_of(e).first].push_back(e);
            incident_[tract_of(e).last].push_back(e);
        }
    }

    /// Product of the radii where the own part comes to a junction; 1 where it comes to none.
    [[nodiscard]] double balls_at_junctions(const Tract& t) const {
        double product = 1;
        if (split_.nodes[t.first].is_junction()) product *= views_[t.line].radius_at(t.own_from);
        if (split_.nodes[t.last].is_junction()) product *= views_[t.line].radius_at(t.own_to);
        return product;
    }

    [[nodiscard]] Vec3 end_point(std::size_t e, std::size_t node) const {
        const Tract& t = tract_of(e);
        return view_of(e).position(t.first == node ? t.own_from : t.own_to);
    }

    void place_nodes() {
        for (std::size_t n = 0; n < split_.nodes.size(); ++n) {
            const SplitNode& node = split_.nodes[n];
            if (node.is_junction()) {
                place_junction(n);
                continue;
            }
            // Lines that end in one opening may differ by their rounding: the longest stands for them.
            const std::size_t e = *std::max_element(
                incident_[n].begin(), incident_[n].end(),
                [&](std::size_t a, std::size_t b) { return view_of(a).length() < view_of(b).length(); });
            const Tract& t = tract_of(e);
            position_.push_back(end_point(e, n));
            radius_.push_back(view_of(e).radius_at(t.first == n ? t.own_from : t.own_to));
        }
    }

    void place_junction(std::size_t n) {
        Vec3 mean;
        double weight = 0, radius = 0;
        for (const NodePart& p : split_.nodes[n].parts) {
            for (const double s : {p.from, p.to}) {
                const double r = views_[p.line].radius_at(s);
                mean += (r * r) * views_[p.line].position(s);
                weight += r * r;
            }
            radius = std::max(radius, views_[p.line].radius_at(p.from));
        }
        mean = (1 / weight) * mean;
        std::vector<Axis> axes;
        for (const std::size_t e : incident_[n]) {
            const Tract& t = tract_of(e);
            if (!(t.own_to > t.own_from)) continue;
            axes.push_back(t.first == n ? fitted_axis(view_of(e), t.own_from, t.own_to)
                                        : fitted_axis(view_of(e), t.own_to, t.own_from));
        }
        Vec3 origin = axes.size() < 2 ? mean : nearest_to_axes(axes, mean);
        if (const double away = distance(origin, mean); away > radius) origin = lerp(mean, origin, radius / away);
        position_.push_back(origin);
        radius_.push_back(radius);
    }

    [[nodiscard]] double length_of(std::size_t e) const {
        const Tract& t = tract_of(e);
        return distance(position_[t.first], end_point(e, t.first)) + (t.own_to - t.own_from) +
               distance(end_point(e, t.last), position_[t.last]);
    }

    /// Lengths add up from the ends: an edge is done when all that leave its last node are.
    void measure_extents() {
        std::vector<std::size_t> waiting(edges_.size());
        std::vector<std::size_t> ready;
        const auto leaving = [&](std::size_t node) {
            std::vector<std::size_t> out;
            for (const std::size_t e : incident_[node])
                if (tract_of(e).first == node) out.push_back(e);
            return out;
        };
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            edges_[e].extent = length_of(e);
            waiting[e] = leaving(tract_of(e).last).size();
            if (waiting[e] == 0) ready.push_back(e);
        }
        for (std::size_t n = 0; n < ready.size(); ++n) {
            const std::size_t e = ready[n], node = tract_of(e).first;
            for (const std::size_t before : incident_[node]) {
                if (tract_of(before).last != node) continue;
                edges_[before].extent += edges_[e].extent;
                if (--waiting[before] == 0) ready.push_back(before);
            }
        }
    }

    [[nodiscard]] std::vector<std::size_t> children(std::size_t node) const {
        std::vector<std::size_t> out;
        for (const std::size_t e : incident_[node])
            if (tract_of(e).first == node) out.push_back(e);
        std::stable_sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) {
            if (edges_[a].extent != edges_[b].extent) return edges_[a].extent > edges_[b].extent;
            return view_of(a).radius_at(tract_of(a).own_from) > view_of(b).radius_at(tract_of(b).own_from);
        });
        return out;
    }

    void number_branches() {
        std::map<EndpointId, std::size_t> roots;
        for (std::size_t n = 0; n < split_.nodes.size(); ++n)
            for (const std::size_t e : incident_[n])
                if (tract_of(e).first == n && !split_.nodes[n].endpoint.is_none()) roots[split_.nodes[n].endpoint] = n;
        std::vector<bool> seen(split_.nodes.size(), false);
        std::vector<std::size_t> reached_by(split_.nodes.size(), BranchCourse::kNone);
        for (const auto& [endpoint, root] : roots) {
            std::queue<std::size_t> queue;
            if (!seen[root]) queue.push(root);
            seen[root] = true;
            for (; !queue.empty(); queue.pop()) {
                const std::size_t node = queue.front();
                const std::vector<std::size_t> out = children(node);
                for (std::size_t k = 0; k < out.size(); ++k) {
                    if (edges_[out[k]].branch != BranchCourse::kNone) continue;
                    const std::size_t last = add_branch(out[k], reached_by[node]);
                    draft_.branches.back().order_margin = margin(out, k);
                    if (seen[last]) continue;
                    seen[last] = true;
                    reached_by[last] = draft_.branches.size() - 1;
                    queue.push(last);
                }
            }
        }
    }

    [[nodiscard]] double margin(const std::vector<std::size_t>& sorted, std::size_t k) const {
        double least = std::numeric_limits<double>::quiet_NaN();
        const auto extent = [&](std::size_t i) { return edges_[sorted[i]].extent; };
        if (k > 0) least = (extent(k - 1) - extent(k)) / extent(k - 1);
        if (k + 1 < sorted.size()) least = std::fmin(least, (extent(k) - extent(k + 1)) / extent(k));
        return least;
    }

    /// @returns the node where it ends
    std::size_t add_branch(std::size_t e, std::size_t parent) {
        BranchCourse b;
        const Tract& t = tract_of(e);
        b.first = t.first;
        b.last = t.last;
        b.parent = parent;
        b.generation = parent == BranchCourse::kNone ? 0 : draft_.branches[parent].generation + 1;
        b.line_count = edges_[e].line_count;
        b.courses.push_back({t.line, t.own_from, t.own_to, false});
        edges_[e].branch = draft_.branches.size();
        if (!split_.nodes[t.last].loop.is_none())
            for (const std::size_t other : incident_[t.last]) {
                if (other == e || edges_[other].branch != BranchCourse::kNone) continue;
                const Tract& back = tract_of(other);
                b.courses.push_back({back.line, back.own_from, back.own_to, true});
                b.last = back.first;
                b.line_count += edges_[other].line_count;
                edges_[other].branch = draft_.branches.size();
                edges_[other].second = true;
                break;
            }
        draft_.branches.push_back(b);
        return b.last;
    }

    /// Numbers the nodes in the order in which branches come to them, and the junctions among them.
    void name_nodes() {
        BranchGraph& graph = draft_.graph;
        node_.assign(split_.nodes.size(), NodeId());
        std::size_t junctions = 0;
        for (BranchCourse& b : draft_.branches)
            for (std::size_t* n : {&b.first, &b.last}) {
                if (node_[*n].is_none()) {
                    node_[*n] = NodeId(graph.node_count());
                    graph.position.push_back(position_[*n]);
                    graph.radius.push_back(radius_[*n]);
                    graph.endpoint.push_back(split_.nodes[*n].endpoint);
                    graph.junction.push_back(split_.nodes[*n].is_junction() ? JunctionId(junctions++) : JunctionId());
                }
                *n = at(node_[*n]);
            }
        for (const BranchCourse& b : draft_.branches) graph.edges.push_back({NodeId(b.first), NodeId(b.last)});
    }

    [[nodiscard]] Vec3 course_point(const Course& c, bool start) const {
        return views_[c.line].position(start != c.backward ? c.from : c.to);
    }

    void finish(BranchCourse& b) const {
        const auto direction = [&](const Course& c, bool start) {
            const bool forward = start != c.backward;
            return fitted_axis(views_[c.line], forward ? c.from : c.to, forward ? c.to : c.from).direction;
        };
        b.first_join = distance(draft_.graph.position[b.first], course_point(b.courses.front(), true));
        b.last_join = distance(draft_.graph.position[b.last], course_point(b.courses.back(), false));
        b.first_direction = direction(b.courses.front(), true);
        b.last_direction = direction(b.courses.back(), false);
        if (b.own_length() > 0) return;
        b.first_direction = normalized(draft_.graph.position[b.last] - draft_.graph.position[b.first]);
        b.last_direction = -b.first_direction;
    }

    void make_pieces() {
        draft_.pieces.offsets.assign(1, 0);
        for (std::size_t i = 0; i < views_.size(); ++i) {
            const ContainedLine& c = split_.contained[i];
            add_line(i, c.in == ContainedLine::kNone ? i : c.in, c.shift);
            draft_.pieces.offsets.push_back(static_cast<std::uint32_t>(draft_.pieces.from.size()));
        }
    }

    /// The pieces of line `i`, which runs as `as` does.
    void add_line(std::size_t i, std::size_t as, double shift) {
        const double length = views_[i].length();
        const std::size_t begin = split_.first_tract[as], end = split_.first_tract[as + 1];
        const std::size_t start = draft_.pieces.from.size();
        for (std::size_t t = begin; t < end; ++t) {
            const Tract& tract = split_.tracts[t];
            const BranchCourse& b = draft_.branches[edges_[tract.edge].branch];
            const bool second = edges_[tract.edge].second;
            const auto [a0, a1] = own_range(b, second);
            const double foot_from = foot(tract.first, as), foot_to = foot(tract.last, as);
            const auto add = [&](double from, double to, double b_from, double b_to, std::size_t node) {
                const double begins = std::max(from - shift, 0.0), ends = std::min(to - shift, length);
                if (!(ends > begins)) return;
                const auto on_branch = [&](double s) {
                    return std::lerp(b_from, b_to, (s + shift - from) / (to - from));
                };
                LinePieces& p = draft_.pieces;
                p.from.push_back(begins);
                p.to.push_back(ends);
                p.branch.emplace_back(edges_[tract.edge].branch);
                p.branch_from.push_back(on_branch(begins));
                p.branch_to.push_back(on_branch(ends));
                p.junction.push_back(node == kOwn ? JunctionId() : draft_.graph.junction[at(node_[node])]);
            };
            const double before = second ? b.length() : 0;
            const double after = split_.nodes[tract.last].loop.is_none() ? b.length() : a1;
            add(foot_from, tract.own_from, before, a0, tract.first);
            add(tract.own_from, tract.own_to, a0, a1, kOwn);
            if (node_[tract.last].is_none()) continue;  // where the sides of a loop meet
            add(tract.own_to, foot_to, a1, after, tract.last);
        }
        if (draft_.pieces.to.size() > start) draft_.pieces.to.back() = length;
    }

    static constexpr std::size_t kOwn = std::numeric_limits<std::size_t>::max();

    /// Abscissas of a branch at the start and the end of a course, as its line runs.
    [[nodiscard]] static std::array<double, 2> own_range(const BranchCourse& b, bool second) {
        const Course& c = b.courses.front();
        const double a0 = b.first_join, a1 = a0 + (c.to - c.from);
        if (!second) return {a0, a1};
        return {b.length() - b.last_join, a1};
    }

    /// Abscissa of a line at a node: of a junction, its point nearest to the origin.
    [[nodiscard]] double foot(std::size_t node, std::size_t line) const {
        for (const NodePart& p : split_.nodes[node].parts)
            if (p.line == line) return p.to > p.from ? views_[line].foot(position_[node], p.from, p.to) : p.from;
        return 0;
    }

    const Split& split_;
    const Centerlines& lines_;
    std::span<const LineView> views_;
    std::vector<Edge> edges_;
    std::vector<std::vector<std::size_t>> incident_;  // per node: edges, ascending
    std::vector<Vec3> position_;                      // per node of the split
    std::vector<double> radius_;
    std::vector<NodeId> node_;  // per node of the split; none where the sides of a loop meet
    GraphDraft draft_;
};

}  // namespace

double BranchCourse::own_length() const {
    double length = 0;
    for (const Course& c : courses) length += c.to - c.from;
    return length;
}

GraphDraft make_graph(const Split& split, const Centerlines& lines, std::span<const LineView> views) {
    return GraphMaker(split, lines, views).run();
}

}  // namespace lumenline
