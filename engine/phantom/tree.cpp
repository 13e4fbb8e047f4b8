// Growth of the tree and its exact geometry. A branch is a round cone: the distance to it is the least
// over its balls of the distance to a ball, |x - c(t)| - r(t), whose t has a closed form. Open ends go
// on straight for a few radii before a plane cuts them, so that the wall is the cone up to the plane.
// The blend is a sum of kernels that vanish at the distance k_i ("soft objects", Wyvill et al. 1986): on
// a lone branch the sum is one exactly where the distance is zero.
// Trap: a kernel's support, not the wall, is what must keep clear of other branches.
#include "engine/phantom/tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>

#include "engine/core/text.h"
#include "engine/phantom/random.h"

namespace lumenline {
namespace {

using std::numbers::pi;

constexpr double kTaper = 0.9;      // radius at a branch's end by that at its start
constexpr double kBlend = 0.4;      // k_i by the start radius
constexpr double kOverhang = 1;     // radii by which the axis goes on behind the plane of an open end
constexpr double kClearance = 2.5;  // radii kept free before an opening: overhang, its ball, its blend; extensions
constexpr double kMarked = 2;       // radii near a junction that are marked
constexpr int kMaxLeaves = 1024;

[[noreturn]] void reject(const std::string& sentence) { throw std::invalid_argument("impossible tree: " + sentence); }

void check(const TreeOptions& o) {
    if (o.leaves < 1 || o.leaves > kMaxLeaves || (o.leaves & (o.leaves - 1)) != 0) {
        reject("leaves are " + std::to_string(o.leaves) + ", must be a power of two up to " +
               std::to_string(kMaxLeaves));
    }
    for (const auto& [value, name] : {std::pair{o.a, "radius"}, {o.length, "length"}, {o.scale, "scale"}}) {
        if (!(value > 0 && std::isfinite(value))) reject(name + (" is " + short_text(value)) + ", must be positive");
    }
    if (!std::isfinite(o.offset.x + o.offset.y + o.offset.z)) reject("the offset must be finite");
}

Vec3 direction_from(RandomStream& random) {
    const double z = random.symmetric();
    const double angle = pi * random.symmetric();
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

/// Least distance between two segments: at an end of one of them, or where the lines are nearest.
double segment_distance(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    const auto to_segment = [](Vec3 x, Vec3 p, Vec3 q) {
        const Vec3 e = q - p;
        return distance(x, lerp(p, q, std::clamp(dot(x - p, e) / squared_norm(e), 0.0, 1.0)));
    };
    double least = std::min({to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b)});
    const Vec3 u = b - a, v = d - c, w = a - c;
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v);
    const double determinant = uu * vv - uv * uv;
    if (determinant > 0) {
        const double s = (uv * dot(v, w) - vv * dot(u, w)) / determinant;
        const double t = (uu * dot(v, w) - uv * dot(u, w)) / determinant;
        if (s > 0 && s < 1 && t > 0 && t < 1) least = std::min(least, distance(lerp(a, b, s), lerp(c, d, t)));
    }
    return least;
}

/// Axis including the room that an open end wants before it.
std::pair<Vec3, Vec3> claimed_segment(const TreeBranch& b) {
    const Vec3 e = b.direction();
    return {b.open_start ? b.start - kClearance * b.start_radius * e : b.start,
            b.open_end ? b.end + kClearance * b.end_radius * e : b.end};
}

/// Do the two branches keep out of each other's blends? For branches that share no node.
bool apart(const TreeBranch& a, const TreeBranch& b) {
    const auto [p, q] = claimed_segment(a);
    const auto [r, s] = claimed_segment(b);
    return segment_distance(p, q, r, s) > a.start_radius + a.blend + b.start_radius + b.blend;
}

class Grower {
public:
    explicit Grower(const TreeOptions& options) : options_(options), random_(options.seed) {}

    std::vector<TreeBranch> grow() {
        const Vec3 e = direction_from(random_);
        Vec3 plane = any_perpendicular(e);  // normal of the plane in which the children part
        branches.push_back(branch(TreeBranch::kNoParent, {}, e, options_.a, options_.leaves == 1));
        branches.front().open_start = true;
        std::vector<Vec3> planes{plane};
        for (std::size_t i = 0; branches.size() + 1 < 2 * leaves(); ++i) {
            const Vec3 next = part(i, planes[i]);
            planes.push_back(next);
            planes.push_back(next);
        }
        return std::move(branches);
    }

    std::vector<TreeBranch> branches;

private:
    TreeBranch branch(std::size_t parent, Vec3 start, Vec3 direction, double radius, bool leaf) {
        TreeBranch b;
        b.parent = parent;
        b.start = start;
        b.end = start + (options_.length * radius * (1 + 0.05 * random_.symmetric())) * direction;
        b.start_radius = radius;
        b.end_radius = kTaper * radius;
        b.blend = kBlend * radius;
        b.open_end = leaf;
        return b;
    }

    /// Gives branch `i` its two children and returns the normal of their plane, about perpendicular to the last.
    Vec3 part(std::size_t i, Vec3 last_plane) {
        constexpr int kTries = 256;
        const std::size_t count = branches.size();
        const bool last = count + 1 >= leaves();  // level by level, the last one holds as many as all before and one
        for (int attempt = 0; attempt < kTries; ++attempt) {
            const TreeBranch parent = branches[i];
            const Vec3 e = parent.direction();
            const double turn = pi / 180 * (90 + 40 * random_.symmetric());
            const Vec3 plane = normalized(std::cos(turn) * last_plane + std::sin(turn) * cross(e, last_plane));
            const Vec3 aside = cross(plane, e);
            const double share = 1 + 0.15 * random_.symmetric();  // of the children's radii
            const double larger = parent.end_radius / std::cbrt(1 + share * share * share);
            std::array<double, 2> angles{};
            for (double& angle : angles) angle = pi / 180 * (41 + 5 * random_.symmetric());
            branches.push_back(
                branch(i, parent.end, std::cos(angles[0]) * e + std::sin(angles[0]) * aside, share * larger, last));
            branches.push_back(
                branch(i, parent.end, std::cos(angles[1]) * e - std::sin(angles[1]) * aside, larger, last));
            if (free_of_others(count)) return plane;
            branches.resize(count);
        }
        reject("branch " + std::to_string(i) + " finds no free room for its children in " + std::to_string(kTries) +
               " directions; use another seed or longer branches");
    }

    [[nodiscard]] bool free_of_others(std::size_t first) const {
        const std::size_t parent = branches[first].parent;
        for (std::size_t child = first; child < first + 2; ++child)
            for (std::size_t k = 0; k < first; ++k)
                if (k != parent && !apart(branches[child], branches[k])) return false;
        return true;
    }

    [[nodiscard]] std::size_t leaves() const { return static_cast<std::size_t>(options_.leaves); }

    const TreeOptions& options_;
    RandomStream random_;
};

/// Parameter of the ball of `b` that is nearest to a point, in lengths from the start.
struct Foot {
    double s = 0;
    Vec3 centre;
    double radius = 0;
};

Foot foot_on(const TreeBranch& b, Vec3 x) {
    const double length = b.length();
    const Vec3 e = (1 / length) * (b.end - b.start);
    const double z = dot(x - b.start, e);
    const double rho = norm(x - b.start - z * e);
    const double slope = (b.start_radius - b.end_radius) / length;
    const double low = b.open_start ? -kOverhang * b.start_radius : 0.0;
    const double high = b.open_end ? length + kOverhang * b.end_radius : length;
    Foot foot;
    foot.s = std::clamp(z - rho * slope / std::sqrt(1 - slope * slope), low, high);
    foot.centre = b.start + foot.s * e;
    foot.radius = b.start_radius - slope * foot.s;
    return foot;
}

/// Point in which the ball at `s` touches the branch's own wall, at the angle `around`.
Vec3 contact(const TreeBranch& b, double s, double around) {
    const Vec3 e = b.direction();
    const Vec3 u = any_perpendicular(e);
    const double slope = (b.start_radius - b.end_radius) / b.length();
    const Vec3 outward = std::cos(around) * u + std::sin(around) * cross(e, u);
    return b.position(s) + b.radius(s) * (slope * e + std::sqrt(1 - slope * slope) * outward);
}

/// Does the ball at `s` of `b` touch its own wall, unblended, all around? Sampled, with a margin
/// for what lies between the samples: distances change no faster than the place.
bool is_clear(const TreeBranch& b, const std::vector<TreeBranch>& others, double s, double step) {
    constexpr int kAround = 96;
    const double margin = b.radius(s) * pi / kAround + step;
    for (int k = 0; k < kAround; ++k) {
        const Vec3 x = contact(b, s, 2 * pi * k / kAround);
        for (const TreeBranch& other : others) {
            const Foot foot = foot_on(other, x);
            if (distance(x, foot.centre) - foot.radius < other.blend + margin) return false;
        }
    }
    return true;
}

void find_clear_part(std::vector<TreeBranch>& branches, std::size_t i) {
    TreeBranch& b = branches[i];
    const double step = b.end_radius / 16;
    std::vector<TreeBranch> others;
    for (std::size_t j = 0; j < branches.size(); ++j)
        if (j != i && !apart(b, branches[j])) others.push_back(branches[j]);
    const auto search = [&](double direction, bool open, double limit) {
        if (open) return limit;
        double s = 0.5 * b.length();
        if (!is_clear(b, others, s, step)) {
            reject("branch " + std::to_string(i) + " is too short to have a part without blends; use longer branches");
        }
        while (s + direction * step > 0 && s + direction * step < b.length() &&
               is_clear(b, others, s + direction * step, step)) {
            s += direction * step;
        }
        return s;
    };
    b.clear_from = search(-1, b.open_start, 0);
    b.clear_to = search(1, b.open_end, b.length());
}

}  // namespace

TreeTruth::TreeTruth(const TreeOptions& options) {
    check(options);
    branches_ = Grower(options).grow();
    for (std::size_t i = 0; i < branches_.size(); ++i) find_clear_part(branches_, i);
    for (TreeBranch& b : branches_) {
        b.start = options.offset + options.scale * b.start;
        b.end = options.offset + options.scale * b.end;
        for (double* size : {&b.start_radius, &b.end_radius, &b.blend, &b.clear_from, &b.clear_to})
            *size *= options.scale;
        if (b.parent != TreeBranch::kNoParent) {
            const TreeBranch& parent = branches_[b.parent];
            b.abscissa = parent.abscissa + parent.length();
        }
        const double reach = 0.5 * b.length() + (1 + kOverhang) * b.start_radius + b.blend;
        reach_.push_back({lerp(b.start, b.end, 0.5), reach * reach});
    }
}

std::vector<std::vector<std::size_t>> TreeTruth::lines() const {
    std::vector<std::vector<std::size_t>> lines;
    for (std::size_t leaf = 0; leaf < branches_.size(); ++leaf) {
        if (!branches_[leaf].open_end) continue;
        std::vector<std::size_t> line;
        for (std::size_t i = leaf; i != TreeBranch::kNoParent; i = branches_[i].parent) line.push_back(i);
        std::reverse(line.begin(), line.end());
        lines.push_back(std::move(line));
    }
    return lines;
}

TreeAbscissa TreeTruth::nearest_axis(Vec3 point) const {
    TreeAbscissa best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < branches_.size(); ++i) {
        const TreeBranch& b = branches_[i];
        const double s = std::clamp(dot(point - b.start, b.direction()), 0.0, b.length());
        const double away = distance(point, b.position(s)) / b.radius(s);
        if (away < least) {
            least = away;
            best = {i, s};
        }
    }
    return best;
}

bool TreeTruth::near_junction(TreeAbscissa at) const {
    const TreeBranch& b = branches_[at.branch];
    return (!b.open_start && at.s < b.clear_from + kMarked * b.radius(b.clear_from)) ||
           (!b.open_end && at.s > b.clear_to - kMarked * b.radius(b.clear_to));
}

double TreeTruth::inscribed_radius(TreeAbscissa at) const {
    constexpr int kDirections = 256;
    const TreeBranch& b = branches_[at.branch];
    if (at.s >= b.clear_from && at.s <= b.clear_to) return b.radius(at.s);
    return distance_to_wall(b.position(at.s), kDirections);
}

double TreeTruth::distance_to_branch(std::size_t i, Vec3 point) const {
    const Foot foot = foot_on(branches_[i], point);
    return distance(point, foot.centre) - foot.radius;
}

bool TreeTruth::inside(Vec3 point) const {
    for (std::size_t i = 0; i < branches_.size(); ++i) {
        if (!reach_[i].holds(point)) continue;
        const TreeBranch& b = branches_[i];
        const bool behind = (b.open_start && dot(point - b.start, b.direction()) < 0) ||
                            (b.open_end && dot(point - b.end, b.direction()) > 0);
        if (behind && distance_to_branch(i, point) < b.blend) return false;
    }
    return field(point).value > 0;
}

TreeTruth::Field TreeTruth::field(Vec3 point) const {
    Field field;
    double weights = 0;
    for (std::size_t i = 0; i < branches_.size(); ++i) {
        if (!reach_[i].holds(point)) continue;
        const TreeBranch& b = branches_[i];
        const Foot foot = foot_on(b, point);
        const double d = distance(point, foot.centre) - foot.radius;
        const double u = 1 - d / b.blend;
        if (u <= 0) continue;
        field.value += u * u * u;
        field.gradient += (-3 * u * u / b.blend) * normalized(point - foot.centre);
        field.radius += u * u * u * foot.radius;
        weights += u * u * u;
    }
    if (weights > 0) field.radius /= weights;
    return field;
}

Vec3 TreeTruth::projected(Vec3 point) const {
    constexpr int kSteps = 12;  // quadratic: from an edge away rounding is reached in six
    for (int i = 0; i < kSteps; ++i) {
        const Field f = field(point);
        const double slope2 = squared_norm(f.gradient);
        if (!(slope2 > 0)) break;
        point += (-f.value / slope2) * f.gradient;
    }
    return point;
}

double TreeTruth::distance_to_wall(Vec3 point, int directions) const {
    const double step = 0.05 * branches_[nearest_axis(point).branch].end_radius;
    std::vector<std::pair<double, Vec3>> hits;
    for (int k = 0; k < directions; ++k) {  // a Fibonacci lattice
        const double z = 1 - (2 * k + 1.0) / directions;
        const double angle = pi * (3 - std::sqrt(5.0)) * k;
        const double r = std::sqrt(1 - z * z);
        const Vec3 ray{r * std::cos(angle), r * std::sin(angle), z};
        const double longest = hits.empty() ? 200 * step : 1.5 * hits.front().first;
        double inner = 0, outer = step;
        while (outer < longest && field(point + outer * ray).value > 0) {
            inner = outer;
            outer += step;
        }
        if (outer >= longest) continue;
        for (int i = 0; i < 20; ++i) {
            const double middle = 0.5 * (inner + outer);
            (field(point + middle * ray).value > 0 ? inner : outer) = middle;
        }
        hits.emplace_back(inner, point + inner * ray);
        if (hits.back().first < hits.front().first) std::swap(hits.back(), hits.front());
    }
    constexpr std::size_t kRefined = 8;
    const std::size_t best = std::min(kRefined, hits.size());
    std::partial_sort(hits.begin(), hits.begin() + static_cast<std::ptrdiff_t>(best), hits.end(),
                      [](const auto& a, const auto& b) { return a.first < b.first; });
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < best; ++k) {
        // Slides along the wall towards the foot, by ever smaller shares where it would move away.
        Vec3 foot = projected(hits[k].second);
        double share = 0.5;
        for (int i = 0; i < 60 && share > 1e-3; ++i) {
            const Vec3 n = normalized(field(foot).gradient);
            const Vec3 aside = (point - foot) - dot(point - foot, n) * n;
            const Vec3 next = projected(foot + share * aside);
            if (squared_norm(next - point) < squared_norm(foot - point))
                foot = next;
            else
                share *= 0.5;
        }
        least = std::min(least, distance(point, foot));
    }
    return least;
}

}  // namespace lumenline
