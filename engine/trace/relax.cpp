// Minimises sum c(L_i, R_i + R_{i+1}), c = 2 atanh(L/S), over the positions t_i of the points on
// their edges, 0 <= t_i <= 1. Each term joins neighbours only: the Hessian is tridiagonal. Damped
// Newton steps with the bounds as an active set; the damping grows until the step lowers the cost.
// Where two nodes meet the cost has a kink; they stay, or no step of the others would be accepted.
// The derivatives are closed: with D = S^2 - L^2,
//   c_L = 2S/D   c_S = -2L/D   c_LL = c_SS = 4SL/D^2   c_LS = -2(S^2 + L^2)/D^2.
#include <algorithm>
#include <cmath>

#include "engine/geometry/segment_cost.h"
#include "engine/trace/path.h"

namespace lumenline {

namespace {

constexpr int kMaxSteps = 60;
constexpr double kGradientLimit = 1e-10;  // per ball radius moved, relative to a cost of order one per radius
constexpr double kShortEdge = 1e-9;       // of the ball radius: too short to slide on
constexpr double kMet = 1e-7;             // of the radii: nodes this close have met and stay

/// A node that slides on its edge, or stays.
struct Node {
    Vec3 origin, edge;
    double edge_length2 = 0;
    double radius_a = 0, radius_b = 0;
    double t = 0;
    bool fixed = true;

    [[nodiscard]] Vec3 position(double s) const { return fixed ? origin : origin + s * edge; }
    [[nodiscard]] double radius(double s) const {
        return fixed ? radius_a : radius_between(radius_a, radius_b, edge_length2, s);
    }
};

/// Value and derivatives of one segment's cost in the two node parameters.
struct SegmentTerms {
    double cost = 0, gx = 0, gy = 0, hxx = 0, hxy = 0, hyy = 0;
    bool met = false;  ///< the two nodes have met: the cost has a kink there and no derivative
};

SegmentTerms segment_terms(const Node& a, const Node& b) {
    const Vec3 d = b.position(b.t) - a.position(a.t);
    const double ra = a.radius(a.t), rb = b.radius(b.t);
    const double length = norm(d), sum = ra + rb;
    SegmentTerms k;
    k.cost = segment_cost(length, sum);
    k.met = !(length > kMet * sum);
    if (k.met || !(length < (1 - 1e-9) * sum)) return k;  // no direction, or the metric's pole

    const double lx = a.fixed ? 0 : -dot(a.edge, d) / length, ly = b.fixed ? 0 : dot(b.edge, d) / length;
    const double lxx = a.fixed ? 0 : (a.edge_length2 - lx * lx) / length;
    const double lyy = b.fixed ? 0 : (b.edge_length2 - ly * ly) / length;
    const double lxy = a.fixed || b.fixed ? 0 : (-dot(a.edge, b.edge) - lx * ly) / length;
    const auto radius_slope = [](const Node& n, double r) {
        return n.fixed ? 0
                       : (n.radius_b * n.radius_b - n.radius_a * n.radius_a - (1 - 2 * n.t) * n.edge_length2) / (2 * r);
    };
    const double rx = radius_slope(a, ra), ry = radius_slope(b, rb);
    const double rxx = a.fixed ? 0 : (a.edge_length2 - rx * rx) / ra,
                 ryy = b.fixed ? 0 : (b.edge_length2 - ry * ry) / rb;

    const double det = sum * sum - length * length;
    const double cl = 2 * sum / det, cs = -2 * length / det;
    const double cll = 4 * sum * length / (det * det), cls = -2 * (sum * sum + length * length) / (det * det);
    k.gx = cl * lx + cs * rx;
    k.gy = cl * ly + cs * ry;
    k.hxx = cll * lx * lx + 2 * cls * lx * rx + cll * rx * rx + cl * lxx + cs * rxx;
    k.hyy = cll * ly * ly + 2 * cls * ly * ry + cll * ry * ry + cl * lyy + cs * ryy;
    k.hxy = cll * lx * ly + cls * (lx * ry + rx * ly) + cll * rx * ry + cl * lxy;
    return k;
}

class Relaxation {
public:
    explicit Relaxation(std::vector<Node> nodes)
        : nodes_(std::move(nodes)),
          gradient_(nodes_.size()),
          diagonal_(nodes_.size()),
          above_(nodes_.size()),
          met_(nodes_.size()),
          free_(nodes_.size()),
          step_(nodes_.size()) {}

    /// @returns the cost saved
    double run() {
        const double before = total(nodes_);
        double cost = before, damping = 1e-6;
        for (int i = 0; i < kMaxSteps && !assemble(); ++i)
            if (!descend(cost, damping)) break;
        return before - cost;
    }

    [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }

private:
    static double total(const std::vector<Node>& nodes) {
        double sum = 0;
        for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
            const Node &a = nodes[i], &b = nodes[i + 1];
            sum += segment_cost(distance(a.position(a.t), b.position(b.t)), a.radius(a.t) + b.radius(b.t));
        }
        return sum;
    }

    /// Gradient, Hessian and active set; true when the gradient vanishes.
    bool assemble() {
        std::fill(gradient_.begin(), gradient_.end(), 0.0);
        std::fill(diagonal_.begin(), diagonal_.end(), 0.0);
        std::fill(met_.begin(), met_.end(), false);
        for (std::size_t i = 0; i + 1 < nodes_.size(); ++i) {
            const SegmentTerms k = segment_terms(nodes_[i], nodes_[i + 1]);
            gradient_[i] += k.gx;
            gradient_[i + 1] += k.gy;
            diagonal_[i] += k.hxx;
            diagonal_[i + 1] += k.hyy;
            above_[i] = k.hxy;
            if (k.met) met_[i] = met_[i + 1] = true;
        }
        double largest = 0;
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const Node& n = nodes_[i];
            free_[i] = !n.fixed && !met_[i] && !(n.t <= 0 && gradient_[i] > 0) && !(n.t >= 1 && gradient_[i] < 0);
            if (free_[i]) largest = std::max(largest, std::fabs(gradient_[i]) * n.radius_a / std::sqrt(n.edge_length2));
        }
        return largest < kGradientLimit;
    }

    /// One damped step; false when no damping lowers the cost.
    bool descend(double& cost, double& damping) {
        std::vector<Node> trial = nodes_;
        for (int attempt = 0; attempt < 12; ++attempt) {
            if (solve(damping))
                for (double share = 1; share > 0.2; share *= 0.5) {
                    for (std::size_t i = 0; i < nodes_.size(); ++i)
                        trial[i].t = std::clamp(nodes_[i].t + share * step_[i], 0.0, 1.0);
                    const double reached = total(trial);
                    if (reached < cost * (1 - 1e-15)) {
                        cost = reached;
                        nodes_ = trial;
                        damping = std::max(damping * 0.1, 1e-9);
                        return true;
                    }
                }
            damping = std::max(damping * 10, 1e-4);
        }
        return false;
    }

    /// Solves the damped tridiagonal system for step_; false where it is not positive definite.
    bool solve(double damping) {
        const std::size_t n = nodes_.size();
        std::vector<double> d(n), r(n), u(n, 0.0);
        for (std::size_t i = 0; i < n; ++i) {
            d[i] = 1;
            if (!free_[i]) continue;
            const double scale = nodes_[i].edge_length2 / (nodes_[i].radius_a * nodes_[i].radius_a);
            d[i] = std::max(diagonal_[i], 1e-3 * scale) + damping * (std::fabs(diagonal_[i]) + scale);
            r[i] = -gradient_[i];
            if (i + 1 < n && free_[i + 1]) u[i] = above_[i];
        }
        for (std::size_t i = 1; i < n; ++i) {
            const double m = u[i - 1] / d[i - 1];
            d[i] -= m * u[i - 1];
            r[i] -= m * r[i - 1];
            if (!(d[i] > 0)) return false;
        }
        step_[n - 1] = r[n - 1] / d[n - 1];
        for (std::size_t i = n - 1; i-- > 0;) step_[i] = (r[i] - u[i] * step_[i + 1]) / d[i];
        return true;
    }

    std::vector<Node> nodes_;
    std::vector<double> gradient_, diagonal_, above_;
    std::vector<bool> met_, free_;
    std::vector<double> step_;
};

}  // namespace

double relax_path(const VoronoiComplex& complex, ComplexPath& path) {
    if (path.inner.empty()) return 0;
    std::vector<Node> nodes;
    nodes.reserve(path.size());
    nodes.push_back({path.start, {}, 0, path.start_radius, path.start_radius, 0, true});
    for (const ComplexPoint& p : path.inner) {
        const Vec3 a = complex.vertices[at(p.a)], b = complex.vertices[at(p.b)];
        const double ra = complex.ball_radius[at(p.a)], rb = complex.ball_radius[at(p.b)];
        const double length2 = squared_norm(b - a);
        if (p.is_vertex() || length2 <= kShortEdge * kShortEdge * ra * ra)
            nodes.push_back({position(complex, p), {}, 0, ball_radius(complex, p), 0, p.t, true});
        else
            nodes.push_back({a, b - a, length2, ra, rb, p.t, false});
    }
    nodes.push_back({path.end, {}, 0, path.end_radius, path.end_radius, 0, true});
    Relaxation relaxation(std::move(nodes));
    const double saved = relaxation.run();
    for (std::size_t i = 0; i < path.inner.size(); ++i) {
        ComplexPoint& p = path.inner[i];
        const Node& n = relaxation.nodes()[i + 1];
        if (n.fixed) continue;
        p.t = n.t;
        if (p.t <= 0)
            p = {p.a, p.a, 0};
        else if (p.t >= 1)
            p = {p.b, p.b, 0};
    }
    return saved;
}

}  // namespace lumenline
