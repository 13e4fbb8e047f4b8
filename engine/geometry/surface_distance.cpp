// A tree of bounding boxes over the triangles, split at the median of the longest side, boxes in
// single precision rounded outwards. The nearer child is entered first and a child is dropped when
// its box is farther than the best so far, which starts at the hint: callers know a site on the
// maximal ball, hence a point of the surface at most a ball radius away. No triangle is nearer than
// its plane, which settles most of them. CGAL's AABB tree, which this
// replaces, took many times as long on round tubes, where hundreds of triangles are about equally near:
// it enters children in storage order.
#include "engine/geometry/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace lumenline {

namespace {

constexpr std::uint32_t kLeafSize = 8;

struct Box {
    float low[3], high[3];

    [[nodiscard]] double squared_distance(Vec3 p) const {
        double sum = 0;
        for (int k = 0; k < 3; ++k) {
            const double d = std::max({0.0, low[k] - p[k], p[k] - high[k]});
            sum += d * d;
        }
        return sum;
    }
};

/// Children are at `first` and `first + 1`, or triangles from `first` on where count > 0.
struct Node {
    Box box;
    std::uint32_t first = 0, count = 0;
};

struct Corners {
    Vec3 a, b, c;
    Vec3 normal;  ///< unit; zero without area
};

/// Leaves of a tree whose boxes are within a distance of a point, which may shrink on the way; of two children the
/// nearer comes first.
class NearestFirst {
public:
    NearestFirst(const std::vector<Node>& nodes, Vec3 p) : nodes_(nodes), p_(p) { push(0); }

    /// @returns null when no leaf is left
    const Node* next(double within2) {
        while (height_ > 0) {
            const Entry entry = stack_[--height_];
            if (entry.distance2 >= within2) continue;
            const Node& node = nodes_[entry.node];
            if (node.count > 0) return &node;
            push(node.first);
            push(node.first + 1);
            if (stack_[height_ - 2].distance2 < stack_[height_ - 1].distance2)
                std::swap(stack_[height_ - 2], stack_[height_ - 1]);
        }
        return nullptr;
    }

private:
    struct Entry {
        std::uint32_t node;
        double distance2;
    };
    void push(std::uint32_t node) { stack_[height_++] = {node, nodes_[node].box.squared_distance(p_)}; }

    const std::vector<Node>& nodes_;
    Vec3 p_;
    std::array<Entry, 128> stack_;  // two a level; medians keep the depth below 32
    std::size_t height_ = 0;
};

/// Nearest point of a triangle, by the region of its plane that the point projects into (Ericson,
/// Real-Time Collision Detection, 2005, section 5.1.5).
Vec3 nearest_point(Vec3 p, const Corners& t) {
    const Vec3 ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return t.a;
    const Vec3 bp = p - t.b;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return t.b;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return t.a + (d1 - d3 > 0 ? d1 / (d1 - d3) : 0.0) * ab;
    const Vec3 cp = p - t.c;
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return t.c;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return t.a + (d2 - d6 > 0 ? d2 / (d2 - d6) : 0.0) * ac;
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double whole = (d4 - d3) + (d5 - d6);
        return t.b + (whole > 0 ? (d4 - d3) / whole : 0.0) * (t.c - t.b);
    }
    const double scale = 1 / (va + vb + vc);
    return t.a + (vb * scale) * ab + (vc * scale) * ac;
}

}  // namespace

struct SurfaceDistance::Tree {
    /// A triangle while the tree is built: its centre and number together, for the partitions to run over memory in
    /// order.
    struct Item {
        float centre[3];
        std::uint32_t triangle;
    };

    std::vector<Node> nodes;
    std::vector<Item> items;       // in leaf order
    std::vector<Corners> corners;  // in leaf order

    void build(std::uint32_t at_node, std::uint32_t begin, std::uint32_t end) {
        if (end - begin <= kLeafSize) {
            nodes[at_node].first = begin;
            nodes[at_node].count = end - begin;
            return;
        }
        float low[3], high[3];
        std::copy_n(items[begin].centre, 3, low);
        std::copy_n(items[begin].centre, 3, high);
        for (std::uint32_t i = begin; i < end; ++i)
            for (int k = 0; k < 3; ++k) {
                low[k] = std::min(low[k], items[i].centre[k]);
                high[k] = std::max(high[k], items[i].centre[k]);
            }
        int axis = 0;
        for (int k = 1; k < 3; ++k)
            if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
        const std::uint32_t middle = begin + (end - begin) / 2;
        std::nth_element(
            items.begin() + begin, items.begin() + middle, items.begin() + end, [axis](const Item& a, const Item& b) {
                return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis] : a.triangle < b.triangle;
            });
        const auto children = static_cast<std::uint32_t>(nodes.size());
        nodes.resize(nodes.size() + 2);
        nodes[at_node].first = children;
        build(children, begin, middle);
        build(children + 1, middle, end);
    }

    /// Boxes of all nodes, children before parents: they come later in the array.
    void fit_boxes() {
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        for (std::size_t n = nodes.size(); n-- > 0;) {
            Node& node = nodes[n];
            if (node.count == 0) {
                const Box &a = nodes[node.first].box, &b = nodes[node.first + 1].box;
                for (int k = 0; k < 3; ++k) {
                    node.box.low[k] = std::min(a.low[k], b.low[k]);
                    node.box.high[k] = std::max(a.high[k], b.high[k]);
                }
                continue;
            }
            for (int k = 0; k < 3; ++k) {
                double low = corners[node.first].a[k], high = low;
                for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
                    low = std::min({low, corners[i].a[k], corners[i].b[k], corners[i].c[k]});
                    high = std::max({high, corners[i].a[k], corners[i].b[k], corners[i].c[k]});
                }
                node.box.low[k] = std::nextafter(static_cast<float>(low), -kInfinity);
                node.box.high[k] = std::nextafter(static_cast<float>(high), kInfinity);
            }
        }
    }
};

SurfaceDistance::SurfaceDistance(std::span<const Vec3> points, std::span<const std::array<SiteId, 3>> triangles)
    : tree_(std::make_unique<Tree>()) {
    const auto corners_of = [&](std::size_t i) {
        const Vec3 a = points[at(triangles[i][0])], b = points[at(triangles[i][1])], c = points[at(triangles[i][2])];
        return Corners{a, b, c, normalized(cross(b - a, c - a))};
    };
    tree_->items.resize(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const auto& t = triangles[i];
        const Vec3 c = (1.0 / 3) * (points[at(t[0])] + points[at(t[1])] + points[at(t[2])]);
        tree_->items[i] = {{static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)},
                           static_cast<std::uint32_t>(i)};
    }
    tree_->nodes.reserve(triangles.size() / 2);
    tree_->nodes.resize(1);
    tree_->build(0, 0, static_cast<std::uint32_t>(triangles.size()));
    tree_->corners.resize(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) tree_->corners[i] = corners_of(tree_->items[i].triangle);
    tree_->fit_boxes();
}

SurfaceDistance::~SurfaceDistance() = default;

SurfaceDistance::Nearest SurfaceDistance::nearest(Vec3 p, Vec3 hint, TriangleId hint_triangle) const {
    Nearest best{0, hint, hint_triangle};
    double best2 = squared_norm(p - hint);
    NearestFirst pending(tree_->nodes, p);
    while (const Node* node = pending.next(best2))
        for (std::uint32_t i = node->first; i < node->first + node->count; ++i) {
            const Corners& t = tree_->corners[i];
            const double height = dot(p - t.a, t.normal);
            if (height * height >= best2) continue;
            const Vec3 q = nearest_point(p, t);
            if (const double d2 = squared_norm(p - q); d2 < best2) {
                best2 = d2;
                best.point = q;
                best.triangle = TriangleId(std::size_t{tree_->items[i].triangle});
            }
        }
    best.distance = std::sqrt(best2);
    return best;
}

double SurfaceDistance::nearest_vertex(Vec3 p, double within) const {
    double best2 = within * within;
    NearestFirst pending(tree_->nodes, p);
    while (const Node* node = pending.next(best2))
        for (std::uint32_t i = node->first; i < node->first + node->count; ++i) {
            const Corners& t = tree_->corners[i];
            best2 = std::min({best2, squared_norm(p - t.a), squared_norm(p - t.b), squared_norm(p - t.c)});
        }
    return std::sqrt(best2);
}

double covering_radius(Vec3 a, Vec3 b, Vec3 c) {
    // Sides opposite to a, b, c, turned so that the largest angle is at c.
    double la = distance(b, c), lb = distance(c, a), lc = distance(a, b);
    if (la > lc) std::swap(la, lc);
    if (lb > lc) std::swap(lb, lc);
    if (lc * lc < la * la + lb * lb) {  // acute: the circumcentre is inside
        const double twice_area = norm(cross(b - a, c - a));
        return la * lb * lc / (2 * twice_area);
    }
    // Obtuse: where the bisectors of the short sides meet the long side.
    const double cos_a = (lb * lb + lc * lc - la * la) / (2 * lb * lc);
    const double cos_b = (la * la + lc * lc - lb * lb) / (2 * la * lc);
    const double from_a = cos_a > 0 ? lb / (2 * cos_a) : lc;
    const double from_b = cos_b > 0 ? la / (2 * cos_b) : lc;
    return std::min(lc, std::max({from_a, from_b, 0.5 * lc}));
}

}  // namespace lumenline
