// Outer loop: places of the wall around every node are found on the curved surface, the bounds that
// they set on the balls are solved for the nodes' moves (ridge.h), and again from the new positions,
// until the nodes rest. Two kinds of places:
//  - in each of a dozen directions of the section the foot of a point most of the way to the wall: a
//    fixed place, whose distance bounds every ball. They hold nodes of round sections from all sides;
//  - the feet of the node itself: minima of the distance, which slide as the node moves. The distance
//    to a wall of curvature k at depth d has the second derivative -k / (1 - k d) along the wall.
// A place that is not the nearest costs nothing but time: it only makes a bound that does not press.
#include "engine/trace/medial.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "engine/geometry/segment_cost.h"

namespace lumenline {

namespace {

constexpr double kEdgesPerStep = 1;
constexpr double kLeastStep = 0.1, kLargestStep = 0.4;  // of the radius
constexpr double kWindow = 0.5;                         // of the radius: half the chord that gives a tangent
constexpr double kLookAhead = 0.6;    // of the radius: where from the feet in each direction are sought
constexpr double kFirstReach = 0.15;  // of the radius
constexpr int kRounds = 4;
constexpr int kSearchRounds = 2;      // of them with searches in all directions
constexpr std::size_t kStagger = 3;   // nodes in turn look in directions turned by this part of the angle between two
constexpr std::size_t kShared = 2;    // nodes on either side whose places bound a node's ball too
constexpr double kRelevant = 3;       // reaches beyond the nearest place: farther ones cannot come to bear
constexpr std::size_t kHalo = 16;     // nodes on either side of one that moved which are solved for again
constexpr double kSame = 0.02;        // of the radius: paths no farther apart are one
constexpr std::size_t kContext = 3;   // nodes of a stretch taken over that stay in view
constexpr std::size_t kParting = 2;   // nodes before the parting that are refined anew
constexpr double kClearlyNearer = 3;  // of the wall's uncertainty
constexpr double kLeastReach = 1e-4;  // of the radius
constexpr double kLeastStretch = 1e-3;
constexpr double kAccuracy = 1e-10, kRoughAccuracy = 1e-5;  // of the radius: of the finest and the roughest solution
constexpr double kAccuracyShare = 5e-4;  // of the wall's uncertainty (no need for better), for one round's solution
constexpr double kRestShare = 5e-3;      // of the wall's uncertainty, for the rounds' end
constexpr double kRest = 1e-6;           // of the radius: moves below it end the rounds

}  // namespace

void MedialRefiner::take_over(const Polyline& path) {
    shared_with_ = nullptr;
    shared_nodes_ = 0;
    std::size_t most = 0;
    for (const Finished& f : finished_) {
        if (f.path.points.front() != path.points.front()) continue;
        // Both start at the same place: they are compared at equal arc lengths.
        std::size_t count = 0, segment = 0;
        for (const Node& node : f.nodes) {
            const double s = node.path_abscissa;
            while (segment + 2 < path.size() && path.abscissa[segment + 1] < s) ++segment;
            const double length = path.abscissa[segment + 1] - path.abscissa[segment];
            const double t = length > 0 ? (s - path.abscissa[segment]) / length : 0.0;
            if (t > 1 || distance(lerp(path.points[segment], path.points[segment + 1], t), node.start) >
                             kSame * node.path_radius)
                break;
            ++count;
        }
        if (count > most) {
            most = count;
            shared_with_ = &f;
        }
    }
    nodes_.clear();
    problem_.nodes.clear();
    // The last nodes before the parting are refined anew; those before them stay as they are.
    if (shared_with_ == nullptr || most <= kContext + kParting || most == shared_with_->nodes.size()) {
        shared_with_ = nullptr;
        return;
    }
    const std::size_t kept = most - kParting;
    shared_nodes_ = kept - kContext;
    for (std::size_t i = shared_nodes_; i < kept; ++i) {
        nodes_.push_back(shared_with_->nodes[i]);
        nodes_.back().frozen = true;
        nodes_.back().reach = nodes_.back().moved = 0;
        problem_.nodes.push_back(shared_with_->ridge[i]);
        problem_.nodes.back().reach = 0;
    }
}

void MedialRefiner::resample(const Polyline& path, const LineEnd& start, const LineEnd& end) {
    const Surface& surface = curved_.surface();
    const TriangleId first(std::size_t{0});
    const Vec3 somewhere = surface.points[at(surface.triangles[0][0])];
    std::size_t segment = 0;
    const double whole = path.abscissa.back();
    const std::size_t taken = nodes_.size();
    const auto step_at = [&](double radius) {
        return std::clamp(kEdgesPerStep * surface.median_edge, kLeastStep * radius, kLargestStep * radius);
    };
    for (double s = taken > 0 ? nodes_.back().path_abscissa + step_at(nodes_.back().radius) : 0;;) {
        while (segment + 2 < path.size() && path.abscissa[segment + 1] < s) ++segment;
        const double length = path.abscissa[segment + 1] - path.abscissa[segment];
        const double t = length > 0 ? std::clamp((s - path.abscissa[segment]) / length, 0.0, 1.0) : 0.0;
        RidgeNode ridge;
        ridge.position = lerp(path.points[segment], path.points[segment + 1], t);
        ridge.radius = std::lerp(path.radius[segment], path.radius[segment + 1], t);
        Node node;
        node.start = ridge.position;
        node.path_abscissa = s;
        node.radius = node.path_radius = ridge.radius;
        node.reach = kFirstReach * ridge.radius;
        node.flat = somewhere;
        node.triangle = first;
        problem_.nodes.push_back(ridge);
        nodes_.push_back(std::move(node));
        if (s >= whole) break;
        const double step = step_at(ridge.radius);
        if (!(step > 0)) break;
        s = s + 1.5 * step < whole ? s + step : whole;
    }
    if (!start.free || taken > 0) nodes_.front().reach = 0;
    if (!end.free) nodes_.back().reach = 0;
}

void MedialRefiner::make_sections(const LineEnd& start, const LineEnd& end) {
    const std::size_t n = nodes_.size();
    std::vector<double> s(n, 0.0);
    for (std::size_t i = 1; i < n; ++i)
        s[i] = s[i - 1] + distance(problem_.nodes[i].position, problem_.nodes[i - 1].position);
    std::size_t back = 0, ahead = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double window = kWindow * nodes_[i].radius;
        while (back + 1 < i && s[back + 1] <= s[i] - window) ++back;
        while (back > 0 && s[back] > s[i] - window) --back;
        ahead = std::max(ahead, i);
        while (ahead + 1 < n && s[ahead] < s[i] + window) ++ahead;
        nodes_[i].tangent = normalized(problem_.nodes[ahead].position - problem_.nodes[back].position);
    }
    if (start.free && shared_nodes_ == 0) nodes_.front().tangent = start.direction;
    if (end.free) nodes_.back().tangent = end.direction;
    Vec3 axis = any_perpendicular(nodes_.front().tangent);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 t = nodes_[i].tangent;
        axis = normalized(axis - dot(axis, t) * t);
        if (!(squared_norm(axis) > 0.5)) axis = any_perpendicular(t);
        problem_.nodes[i].axes = {axis, cross(t, axis)};
    }
}

void MedialRefiner::find_around(std::size_t i, bool search) {
    Node& node = nodes_[i];
    const RidgeNode& ridge = problem_.nodes[i];
    const double far = kLookAhead * node.radius;
    if (search) {
        if (i > 0) std::tie(node.flat, node.triangle) = std::tie(nodes_[i - 1].flat, nodes_[i - 1].triangle);
        node.around =
            i > 0 ? nodes_[i - 1].around : std::vector<Contact>(kDirections, Contact{node.flat, node.triangle, {}});
    }
    for (std::size_t k = 0; k < kDirections; ++k) {
        const double turns = (static_cast<double>(k) + static_cast<double>(i % kStagger) / kStagger) / kDirections;
        const double angle = 2 * std::numbers::pi * turns;
        const Vec3 p =
            ridge.position + (far * std::cos(angle)) * ridge.axes[0] + (far * std::sin(angle)) * ridge.axes[1];
        Contact& c = node.around[k];
        if (search) {
            const SurfaceDistance::Nearest wall = curved_.flat().nearest(p, c.flat, c.triangle);
            c.flat = wall.point;
            c.triangle = wall.triangle;
            c.foot = curved_.foot(p, wall.point, wall.triangle);
        } else {
            c.foot = curved_.foot(p, c.foot.point, c.foot.triangle);
        }
    }
}

void MedialRefiner::find_own_feet(std::size_t i) {
    Node& node = nodes_[i];
    const Vec3 x = problem_.nodes[i].position;
    node.before.insert(node.before.end(), node.own.begin(), node.own.end());
    node.own.clear();
    std::array<double, kDirections> d{};
    for (std::size_t k = 0; k < kDirections; ++k) d[k] = distance(x, node.around[k].foot.point);
    const double relevant = *std::min_element(d.begin(), d.end()) + kRelevant * node.reach;
    for (std::size_t k = 0; k < kDirections; ++k) {
        if (d[k] > relevant || d[k] > d[(k + 1) % kDirections] || d[k] > d[(k + kDirections - 1) % kDirections])
            continue;
        node.own.push_back(curved_.foot(x, node.around[k].foot.point, node.around[k].foot.triangle));
    }
    double sum2 = 0, least = std::numeric_limits<double>::infinity();
    for (const SurfaceFoot& f : node.own) {
        const double u = curved_.uncertainty(f);
        sum2 += u * u;
        least = std::min(least, distance(x, f.point));
    }
    node.uncertainty = std::sqrt(sum2 / static_cast<double>(node.own.size()));
    // What no direction of the section found. On an axis many places are nearest but for the wall's uncertainty, and
    // rounding chooses one of them: it must not count.
    const SurfaceDistance::Nearest wall = curved_.flat().nearest(x, node.flat, node.triangle);
    node.flat = wall.point;
    node.triangle = wall.triangle;
    const SurfaceFoot nearest = curved_.foot(x, wall.point, wall.triangle);
    if (distance(x, nearest.point) < least - kClearlyNearer * node.uncertainty) node.own.push_back(nearest);
}

void MedialRefiner::find_places(int round) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (nodes_[i].frozen) continue;
        if (round < kSearchRounds) find_around(i, round == 0);
        if (round < kSearchRounds || nodes_[i].moved > rest_ * nodes_[i].radius) find_own_feet(i);
    }
}

void MedialRefiner::add_bound(const RidgeNode& ridge, const SurfaceFoot& foot, bool curved) {
    const Vec3 d = ridge.position - foot.point;
    WallBound bound;
    bound.value = norm(d);
    const Vec3 g = (1 / bound.value) * d;
    bound.gradient = {dot(g, ridge.axes[0]), dot(g, ridge.axes[1])};
    if (!curved)
        bound.hessian = {(1 - bound.gradient[0] * bound.gradient[0]) / bound.value,
                         -bound.gradient[0] * bound.gradient[1] / bound.value,
                         (1 - bound.gradient[1] * bound.gradient[1]) / bound.value};
    else
        for (std::size_t j = 0; j < 2; ++j) {
            const double k = foot.curvature[j];
            if (k <= 0) continue;
            // The foot slides by move / stretch: no farther than to the next direction's.
            const double least =
                std::clamp(ridge.reach * kDirections / (std::numbers::pi * bound.value), kLeastStretch, 0.9);
            const double kd = std::min(k * bound.value, 1.0);
            const double bend = -kd / (bound.value * std::max(1 - kd, least));
            const double a = dot(foot.directions[j], ridge.axes[0]), b = dot(foot.directions[j], ridge.axes[1]);
            bound.hessian[0] += bend * a * a;
            bound.hessian[1] += bend * a * b;
            bound.hessian[2] += bend * b * b;
        }
    problem_.bounds.push_back(bound);
}

void MedialRefiner::set_bounds(bool all, std::size_t shared) {
    problem_.bounds.clear();
    std::size_t awake_until = 0;  // nodes beside one that moved
    std::size_t ahead = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        for (; ahead < nodes_.size() && ahead <= i + kHalo; ++ahead)
            if (nodes_[ahead].moved > rest_ * nodes_[ahead].radius) awake_until = ahead + kHalo + 1;
        set_bounds(i, shared);
        if (!all && shared > 0 && i >= awake_until) {
            problem_.nodes[i].reach = 0;
            problem_.bounds.resize(problem_.nodes[i].first);
            problem_.nodes[i].last = problem_.nodes[i].first;
        }
    }
}

double MedialRefiner::radius_known(std::size_t i, Vec3 x, std::size_t shared) const {
    double least = std::numeric_limits<double>::infinity();
    const auto offer = [&](const SurfaceFoot& f) { least = std::min(least, distance(x, f.point)); };
    for (std::size_t j = i < shared ? 0 : i - shared; j <= std::min(i + shared, nodes_.size() - 1); ++j) {
        for (const Contact& c : nodes_[j].around) offer(c.foot);
        for (const SurfaceFoot& f : nodes_[j].own) offer(f);
    }
    for (const SurfaceFoot& f : nodes_[i].before) offer(f);
    return least;
}

void MedialRefiner::set_bounds(std::size_t i, std::size_t shared) {
    Node& node = nodes_[i];
    RidgeNode& ridge = problem_.nodes[i];
    const std::size_t first = i < shared ? 0 : i - shared, last = std::min(i + shared, nodes_.size() - 1);
    const double least = radius_known(i, ridge.position, shared);
    node.radius = ridge.radius = least;
    ridge.reach = node.frozen ? 0 : node.reach;
    ridge.first = static_cast<std::uint32_t>(problem_.bounds.size());
    ridge.last = ridge.first;
    if (ridge.reach <= 0) return;
    const double relevant = least + kRelevant * node.reach;
    const auto add = [&](const SurfaceFoot& f, bool curved) {
        if (distance(ridge.position, f.point) <= relevant) add_bound(ridge, f, curved);
    };
    for (const SurfaceFoot& f : node.own) add(f, true);
    for (const SurfaceFoot& f : node.before) add(f, false);
    for (std::size_t j = first; j <= last; ++j) {
        for (const Contact& c : nodes_[j].around) add(c.foot, false);
        if (j == i) continue;
        for (const SurfaceFoot& f : nodes_[j].own) add(f, false);
    }
    ridge.last = static_cast<std::uint32_t>(problem_.bounds.size());
}

double MedialRefiner::move_nodes() {
    double largest = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        RidgeNode& ridge = problem_.nodes[i];
        nodes_[i].moved = 0;
        if (ridge.reach <= 0) continue;
        ridge.position += ridge.move[0] * ridge.axes[0] + ridge.move[1] * ridge.axes[1];
        nodes_[i].moved = std::hypot(ridge.move[0], ridge.move[1]);
        largest = std::max(largest, nodes_[i].moved / nodes_[i].radius);
        nodes_[i].reach = std::min(nodes_[i].reach, std::max(2 * nodes_[i].moved, kLeastReach * nodes_[i].radius));
    }
    return largest;
}

double MedialRefiner::cost(bool at_start) const {
    const auto node_at = [&](std::size_t i) {
        const bool moved_since = at_start && !nodes_[i].frozen;
        const Vec3 x = moved_since ? nodes_[i].start : problem_.nodes[i].position;
        return std::pair(x, moved_since ? radius_known(i, x, kShared) : nodes_[i].radius);
    };
    double sum = 0;
    auto [from, radius] = node_at(0);
    for (std::size_t i = 1; i < nodes_.size(); ++i) {
        const auto [to, next] = node_at(i);
        sum += segment_cost(distance(from, to), radius + next);
        from = to;
        radius = next;
    }
    return sum;
}

RefinedLine MedialRefiner::refine(const Polyline& path, const LineEnd& start, const LineEnd& end) {
    RefinedLine result;
    if (path.size() < 2) return result;
    take_over(path);
    resample(path, start, end);
    if (nodes_.size() < 3) return result;
    for (int round = 0; round < kRounds; ++round) {
        if (round < kSearchRounds) make_sections(start, end);
        find_places(round);
        set_bounds(false, round < kSearchRounds ? 0 : kShared);
        if (round == 0) {
            result.noise = noise_level();
            accuracy_ = std::clamp(kAccuracyShare * result.noise, kAccuracy, kRoughAccuracy);
            rest_ = std::max(kRestShare * result.noise, kRest);
        }
        if (!solve_ridge(problem_, round == 0 ? kRoughAccuracy : accuracy_)) break;
        if (move_nodes() < rest_) break;
    }
    find_places(kRounds);
    set_bounds(true, kShared);
    result.cost_before = cost(true);
    result.cost_after = cost(false);
    estimate_errors();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        result.largest_stray = std::max(result.largest_stray,
                                        distance(problem_.nodes[i].position, nodes_[i].start) / nodes_[i].path_radius);
        if (!nodes_[i].frozen || i + 1 < nodes_.size()) fill_in(i);
    }
    Finished line{path, {}, {}};
    if (shared_with_ != nullptr) {
        line.ridge.assign(shared_with_->ridge.begin(),
                          shared_with_->ridge.begin() + static_cast<std::ptrdiff_t>(shared_nodes_));
        line.nodes.assign(shared_with_->nodes.begin(),
                          shared_with_->nodes.begin() + static_cast<std::ptrdiff_t>(shared_nodes_));
    }
    line.ridge.insert(line.ridge.end(), problem_.nodes.begin(), problem_.nodes.end());
    std::move(nodes_.begin(), nodes_.end(), std::back_inserter(line.nodes));
    for (std::size_t i = 0; i < line.nodes.size(); ++i)
        append(line.ridge[i], line.nodes[i], i + 1 < line.nodes.size() ? &line.nodes[i + 1] : nullptr, result);
    finished_.push_back(std::move(line));
    return result;
}

}  // namespace lumenline
