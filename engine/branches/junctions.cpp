// The parent's direction is that of travel, towards the junction; children's directions are away from it.
//
// Own parts begin one to two radii from the node, and a vessel that tapers has another calibre there: on a tree whose
// radii obey Murray's law at the nodes and fall by 1 % a radius, medians over the nearest two radii give the exponent 2.6
// for 3. So diameters are carried to the node along the line fitted to the radii.
#include "engine/branches/junctions.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/branches/measures.h"
#include "engine/branches/robust.h"

namespace lumenline {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kNext = 2;         // radii: next to the junction
constexpr double kFitted = 10;      // radii: that the diameter at the node is extrapolated from
constexpr double kParallel = 1e-6;  // sine of the angle below which two directions span no plane
constexpr double kLargestExponent = 1000;

/// An end of a branch at a junction.
struct Arm {
    std::size_t branch;
    bool first;  ///< the branch's first end
    Vec3 away;
    double diameter;
};

double angle_between(Vec3 a, Vec3 b) { return kDegrees * std::atan2(norm(cross(a, b)), dot(a, b)); }
double elevation(Vec3 d, Vec3 normal) { return kDegrees * std::atan2(dot(d, normal), norm(cross(d, normal))); }

/// Normal of the plane through the origin that the directions are nearest to.
Vec3 fitted_normal(std::initializer_list<Vec3> directions) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const Vec3 d : directions) {
        const Eigen::Vector3d v(d.x, d.y, d.z);
        sum += v * v.transpose();
    }
    const Eigen::Vector3d n = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum).eigenvectors().col(0);
    return normalized({n.x(), n.y(), n.z()});
}

/// From a to b about the normal, both projected into its plane.
double turn_in_plane(Vec3 a, Vec3 b, Vec3 normal) {
    a = a - dot(a, normal) * normal;
    b = b - dot(b, normal) * normal;
    return kDegrees * std::atan2(dot(cross(a, b), normal), dot(a, b));
}

/// Diameter at the node where the branch starts (first) or ends.
double diameter_at_node(const BranchLines& axes, std::size_t branch, bool first) {
    const OwnPart own = own_part(axes, branch);
    if (own.begin == own.end) return kNaN;
    const std::size_t end = first ? own.begin : own.end - 1;
    const double node = first ? 0 : axes.length(branch);
    const double way = std::fabs(axes.abscissa[end] - node);
    std::vector<double> s, diameters, next;
    for (std::size_t k = own.begin; k < own.end; ++k) {
        const double from_end = std::fabs(axes.abscissa[k] - axes.abscissa[end]);
        if (from_end <= kNext * axes.radius[end]) next.push_back(2 * axes.radius[k]);
        if (from_end > kFitted * axes.radius[end]) continue;
        s.push_back(axes.abscissa[k]);
        diameters.push_back(2 * axes.radius[k]);
    }
    // From a stretch shorter than the way the slope says nothing of the node.
    if (s.back() - s.front() >= way)
        if (const double fitted = repeated_median(s, diameters)(node); fitted > 0) return fitted;
    return median_of(next);
}

std::vector<Arm> arms_at(const GraphDraft& draft, const BranchLines& axes, std::size_t node) {
    std::vector<Arm> arms;
    const auto known = [](Vec3 direction) { return squared_norm(direction) > 0 ? direction : Vec3{kNaN, kNaN, kNaN}; };
    for (std::size_t b = 0; b < draft.branches.size(); ++b) {
        const BranchCourse& c = draft.branches[b];
        if (c.last == node) arms.push_back({b, false, known(c.last_direction), diameter_at_node(axes, b, false)});
        if (c.first == node) arms.push_back({b, true, known(c.first_direction), diameter_at_node(axes, b, true)});
    }
    // The parent is the first branch that comes to the node: branches are numbered in this order.
    const auto parent = std::find_if(arms.begin(), arms.end(), [](const Arm& a) { return !a.first; });
    if (parent != arms.end()) std::rotate(arms.begin(), parent, parent + 1);
    return arms;
}

/// Rows of all arms but the parent's, against the plane of the row that was added last.
void add_children(const std::vector<Arm>& arms, Vec3 normal, JunctionId junction, ChildTable& t) {
    const Vec3 travel = -arms[0].away;
    double sum = 0;
    for (std::size_t k = 1; k < arms.size(); ++k) sum += arms[k].diameter * arms[k].diameter;
    for (std::size_t k = 1; k < arms.size(); ++k) {
        const Arm& arm = arms[k];
        t.junction.push_back(junction);
        t.parent.emplace_back(arms[0].branch);
        t.child.emplace_back(arm.branch);
        t.at_last_node.push_back(arm.first ? 0 : 1);
        t.angle.push_back(angle_between(travel, arm.away));
        t.in_plane.push_back(turn_in_plane(travel, arm.away, normal));
        t.out_of_plane.push_back(elevation(arm.away, normal));
        t.diameter.push_back(arm.diameter);
        t.diameter_ratio.push_back(arm.diameter / arms[0].diameter);
        t.share.push_back(arm.diameter * arm.diameter / sum);
    }
}

void add_row(const std::vector<Arm>& arms, BifurcationTable& t) {
    const Arm &parent = arms[0], &a = arms[1], &b = arms[2];
    const Vec3 travel = -parent.away;
    Vec3 normal = fitted_normal({travel, a.away, b.away});
    if (dot(cross(travel, a.away), normal) < 0) normal = -normal;
    t.normal.push_back(normal);
    t.parent.emplace_back(parent.branch);
    t.child_1.emplace_back(a.branch);
    t.child_2.emplace_back(b.branch);
    t.children.push_back(static_cast<std::uint32_t>(arms.size() - 1));
    t.angle_1.push_back(angle_between(travel, a.away));
    t.angle_2.push_back(angle_between(travel, b.away));
    t.angle_between.push_back(angle_between(a.away, b.away));
    t.in_plane_1.push_back(turn_in_plane(travel, a.away, normal));
    t.in_plane_2.push_back(turn_in_plane(travel, b.away, normal));
    t.out_of_plane_parent.push_back(elevation(travel, normal));
    t.out_of_plane_1.push_back(elevation(a.away, normal));
    t.out_of_plane_2.push_back(elevation(b.away, normal));
    const Vec3 of_children = cross(a.away, b.away);
    t.planarity.push_back(norm(of_children) > kParallel ? std::fabs(elevation(travel, normalized(of_children))) : kNaN);
    std::vector<double> ratios;
    double area = 0;
    for (std::size_t k = 1; k < arms.size(); ++k) {
        ratios.push_back(arms[k].diameter / parent.diameter);
        area += ratios.back() * ratios.back();
    }
    t.parent_diameter.push_back(parent.diameter);
    t.diameter_1.push_back(a.diameter);
    t.diameter_2.push_back(b.diameter);
    t.area_ratio.push_back(area);
    t.diameter_ratio_1.push_back(ratios[0]);
    t.diameter_ratio_2.push_back(ratios[1]);
    const double between = a.diameter / b.diameter;
    t.asymmetry.push_back(between < 1 ? between * between : 1 / (between * between));
    t.murray_exponent.push_back(murray_exponent(ratios));
}

}  // namespace

double murray_exponent(const std::vector<double>& ratios) {
    for (const double r : ratios)
        if (!(r > 0 && r < 1)) return kNaN;
    const auto excess = [&](double x) {
        double sum = -1;
        for (const double r : ratios) sum += std::pow(r, x);
        return sum;
    };
    double low = 0, high = 1;
    while (excess(high) > 0) {
        low = high;
        high *= 2;
        if (high > kLargestExponent) return kNaN;
    }
    for (int k = 0; k < 60; ++k) (excess(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
    return 0.5 * (low + high);
}

void measure_junctions(const GraphDraft& draft, const BranchLines& axes, BifurcationTable& t, ChildTable& children) {
    for (std::size_t n = 0; n < draft.graph.node_count(); ++n) {
        if (draft.graph.junction[n].is_none()) continue;
        t.node.emplace_back(n);
        t.origin.push_back(draft.graph.position[n]);
        const std::vector<Arm> arms = arms_at(draft, axes, n);
        add_row(arms, t);
        add_children(arms, t.normal.back(), draft.graph.junction[n], children);
    }
}

}  // namespace lumenline
