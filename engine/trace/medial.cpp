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
#include <numbers>

#include "engine/geometry/segment_cost.h"

namespace lumenline {

namespace {

constexpr double kEdgesPerStep = 0.5;
constexpr double kLeastStep = 0.05, kLargestStep = 0.25;  // of the radius
constexpr double kWindow = 0.5;                           // of the radius: half the chord that gives a tangent
constexpr double kLookAhead = 0.6;    // of the radius: where from the feet in each direction are sought
constexpr double kFirstReach = 0.15;  // of the radius
constexpr int kRounds = 5;
constexpr double kSag = 1e-4;   // of the radius: how far the line may be from the curve through its nodes
constexpr int kMostPieces = 4;  // of a segment
constexpr double kRest = 2e-4;  // of the radius: moves below it end the rounds

}  // namespace

void MedialRefiner::resample(const Polyline& path, const LineEnd& start, const LineEnd& end) {
    const Surface& surface = curved_.surface();
    nodes_.clear();
    problem_.nodes.clear();
    const auto& t0 = surface.triangles.front();
    SurfaceDistance::Nearest wall{0, surface.points[at(t0[0])], TriangleId(std::size_t{0})};
    std::size_t segment = 0;
    const double whole = path.abscissa.back();
    for (double s = 0;;) {
        while (segment + 2 < path.size() && path.abscissa[segment + 1] < s) ++segment;
        const double length = path.abscissa[segment + 1] - path.abscissa[segment];
        const double t = length > 0 ? std::clamp((s - path.abscissa[segment]) / length, 0.0, 1.0) : 0.0;
        const Vec3 x = lerp(path.points[segment], path.points[segment + 1], t);
        wall = curved_.flat().nearest(x, wall.point, wall.triangle);
        const auto& corners = surface.triangles[at(wall.triangle)];
        double edge = 0;
        for (std::size_t k = 0; k < 3; ++k)
            edge += distance(surface.points[at(corners[k])], surface.points[at(corners[(k + 1) % 3])]) / 3;
        RidgeNode ridge;
        ridge.position = x;
        ridge.radius = wall.distance;
        Node node;
        node.start = x;
        node.path_abscissa = s;
        node.radius = node.path_radius = wall.distance;
        node.reach = kFirstReach * wall.distance;
        node.nearest = {wall.point, wall.triangle, {}};
        problem_.nodes.push_back(ridge);
        nodes_.push_back(std::move(node));
        if (s >= whole) break;
        const double r = wall.distance;
        const double step = std::clamp(kEdgesPerStep * edge, kLeastStep * r, kLargestStep * r);
        s = s + 1.5 * step < whole ? s + step : whole;
        if (!(step > 0)) break;
    }
    if (!start.free) nodes_.front().reach = 0;
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
    if (start.free) nodes_.front().tangent = start.direction;
    if (end.free) nodes_.back().tangent = end.direction;
    Vec3 axis = any_perpendicular(nodes_.front().tangent);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 t = nodes_[i].tangent;
        axis = normalized(axis - dot(axis, t) * t);
        if (!(squared_norm(axis) > 0.5)) axis = any_perpendicular(t);
        problem_.nodes[i].axes = {axis, cross(t, axis)};
    }
}

void MedialRefiner::find_contacts(std::size_t i, bool first_time) {
    Node& node = nodes_[i];
    const RidgeNode& ridge = problem_.nodes[i];
    const Vec3 x = ridge.position;
    const double far = kLookAhead * node.radius;
    if (first_time) node.around = i > 0 ? nodes_[i - 1].around : std::vector<Contact>(kDirections, node.nearest);
    double least = std::numeric_limits<double>::infinity();
    const auto offer = [&](const Contact& c) {
        const double d = distance(x, c.foot.point);
        if (d >= least) return;
        least = d;
        node.nearest.foot = c.foot;
    };
    for (std::size_t k = 0; k < kDirections; ++k) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(k) / kDirections;
        const Vec3 p = x + (far * std::cos(angle)) * ridge.axes[0] + (far * std::sin(angle)) * ridge.axes[1];
        Contact& c = node.around[k];
        if (first_time) {
            const SurfaceDistance::Nearest wall = curved_.flat().nearest(p, c.flat, c.triangle);
            c.flat = wall.point;
            c.triangle = wall.triangle;
        }
        c.foot = curved_.foot(p, c.flat, c.triangle);
        c.flat = c.foot.point;
        c.triangle = c.foot.triangle;
        offer(c);
    }
    const SurfaceDistance::Nearest wall = curved_.flat().nearest(x, node.nearest.flat, node.nearest.triangle);
    node.nearest.flat = wall.point;
    node.nearest.triangle = wall.triangle;
    offer({node.nearest.flat, node.nearest.triangle, curved_.foot(x, node.nearest.flat, node.nearest.triangle)});
    node.radius = least;
}

void MedialRefiner::find_contacts(bool first_time) {
    problem_.bounds.clear();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        find_contacts(i, first_time);
        add_bounds(i);
    }
}

void MedialRefiner::add_bound(const RidgeNode& ridge, const SurfaceFoot& foot, double reach, bool curved) {
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
            const double least = std::min(0.9, reach * kDirections / (std::numbers::pi * bound.value));
            const double kd = std::min(k * bound.value, 1.0);
            const double bend = -kd / (bound.value * std::max(1 - kd, std::max(least, 1e-3)));
            const double a = dot(foot.directions[j], ridge.axes[0]), b = dot(foot.directions[j], ridge.axes[1]);
            bound.hessian[0] += bend * a * a;
            bound.hessian[1] += bend * a * b;
            bound.hessian[2] += bend * b * b;
        }
    problem_.bounds.push_back(bound);
}

void MedialRefiner::add_bounds(std::size_t i) {
    Node& node = nodes_[i];
    RidgeNode& ridge = problem_.nodes[i];
    ridge.radius = node.radius;
    ridge.reach = node.reach;
    ridge.first = static_cast<std::uint32_t>(problem_.bounds.size());
    add_bound(ridge, node.nearest.foot, node.reach, true);
    std::array<double, kDirections> d{};
    for (std::size_t k = 0; k < kDirections; ++k) d[k] = distance(ridge.position, node.around[k].foot.point);
    own_.clear();
    const double relevant = node.radius + 3 * node.reach;
    for (std::size_t k = 0; k < kDirections; ++k) {
        if (d[k] > relevant) continue;
        add_bound(ridge, node.around[k].foot, node.reach, false);
        if (d[k] > d[(k + 1) % kDirections] || d[k] > d[(k + kDirections - 1) % kDirections]) continue;
        own_.push_back(curved_.foot(ridge.position, node.around[k].flat, node.around[k].triangle));
        add_bound(ridge, own_.back(), node.reach, true);
        node.radius = std::min(node.radius, problem_.bounds.back().value);
    }
    for (const SurfaceFoot& f : node.met) {
        const double value = distance(ridge.position, f.point);
        if (value > relevant) continue;
        node.radius = std::min(node.radius, value);
        add_bound(ridge, f, node.reach, false);
    }
    for (const Contact& c : node.around)
        if (distance(ridge.position, c.foot.point) <= relevant) node.met.push_back(c.foot);
    node.met.insert(node.met.end(), own_.begin(), own_.end());
    node.met.push_back(node.nearest.foot);
    ridge.radius = node.radius;
    ridge.last = static_cast<std::uint32_t>(problem_.bounds.size());
}

double MedialRefiner::cost() const {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < nodes_.size(); ++i)
        sum += segment_cost(distance(problem_.nodes[i].position, problem_.nodes[i + 1].position),
                            nodes_[i].radius + nodes_[i + 1].radius);
    return sum;
}

RefinedLine MedialRefiner::refine(const Polyline& path, const LineEnd& start, const LineEnd& end) {
    RefinedLine result;
    if (path.size() < 2) return result;
    resample(path, start, end);
    if (nodes_.size() < 3) return result;
    for (int round = 0; round < kRounds; ++round) {
        make_sections(start, end);
        find_contacts(round == 0);
        if (round == 0) result.cost_before = cost();
        if (!solve_ridge(problem_, 1e-10)) break;
        double largest = 0;
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            RidgeNode& ridge = problem_.nodes[i];
            if (ridge.reach <= 0) continue;
            ridge.position += ridge.move[0] * ridge.axes[0] + ridge.move[1] * ridge.axes[1];
            const double move = std::hypot(ridge.move[0], ridge.move[1]);
            largest = std::max(largest, move / nodes_[i].radius);
            nodes_[i].reach = std::min(nodes_[i].reach, std::max(2 * move, 1e-4 * nodes_[i].radius));
        }
        if (largest < kRest) break;
    }
    find_contacts(false);
    result.cost_after = cost();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        result.largest_stray = std::max(result.largest_stray,
                                        distance(problem_.nodes[i].position, nodes_[i].start) / nodes_[i].path_radius);
        if (i > 0) append_between(i - 1, result);
        append(problem_.nodes[i].position, nodes_[i].radius, i, 0, result);
    }
    return result;
}

void MedialRefiner::append(Vec3 x, double radius, std::size_t i, double share, RefinedLine& result) const {
    const std::size_t j = share > 0 ? i + 1 : i;
    result.line.append(x, radius);
    result.path_abscissa.push_back(std::lerp(nodes_[i].path_abscissa, nodes_[j].path_abscissa, share));
    result.radius_error.push_back(
        std::lerp(nodes_[i].nearest.foot.uncertainty, nodes_[j].nearest.foot.uncertainty, share));
    result.position_error.push_back(0);
}

void MedialRefiner::append_between(std::size_t i, RefinedLine& result) {
    if (i == 0 || i + 2 >= nodes_.size()) return;
    const auto at_node = [this](std::size_t k) { return problem_.nodes[k].position; };
    const Vec3 a = at_node(i - 1), b = at_node(i), c = at_node(i + 1), d = at_node(i + 2);
    const double ab = distance(a, b), bc = distance(b, c), cd = distance(c, d);
    if (!(ab > 0 && bc > 0 && cd > 0)) return;
    // Tangents of the circles through three nodes each, times the segment's length.
    const Vec3 at_b = (bc / (ab + bc)) * ((bc / ab) * (b - a) + (ab / bc) * (c - b));
    const Vec3 at_c = (bc / (bc + cd)) * ((cd / bc) * (c - b) + (bc / cd) * (d - c));
    const double bulge = 0.125 * norm(at_b - at_c), allowed = kSag * nodes_[i].radius;
    const int pieces = std::clamp(static_cast<int>(std::ceil(std::sqrt(bulge / allowed))), 1, kMostPieces);
    for (int k = 1; k < pieces; ++k) {
        const double t = static_cast<double>(k) / pieces, u = 1 - t;
        const Vec3 x = (u * u * (1 + 2 * t)) * b + (t * t * (1 + 2 * u)) * c + (t * u * u) * at_b - (t * t * u) * at_c;
        const SurfaceFoot* nearest = &nodes_[i].nearest.foot;
        double least = distance(x, nearest->point);
        const auto offer = [&](const SurfaceFoot& f) {
            const double r = distance(x, f.point);
            if (r >= least) return;
            least = r;
            nearest = &f;
        };
        for (const std::size_t node : {i, i + 1}) {
            offer(nodes_[node].nearest.foot);
            for (const SurfaceFoot& f : nodes_[node].met) offer(f);
        }
        const double r = distance(x, curved_.foot(x, nearest->point, nearest->triangle).point);
        append(x, std::min(r, least), i, t, result);
    }
}

}  // namespace lumenline
