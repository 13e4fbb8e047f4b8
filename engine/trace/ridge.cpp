// Primal-dual interior point method. Unknowns of node i, in units of its radius: the move (u, v) and
// the ball's radius q. Slack of a bound: s = value + g.y + y.Hy/2 - q >= 0; of the reach: s = reach -+ u.
// Each has a multiplier p with p s = mu, mu falling towards zero. Eliminating the multipliers leaves
//   (W - sum p hess(s) + sum (p/s) a a') dw = -grad f + sum (mu/s) a,     a = grad s,
// block tridiagonal with 3 x 3 blocks, since the cost joins neighbours only. W is the cost's Hessian
// without its mixed term of length and radius, which alone can make it indefinite; lines cross their
// sections at right angles, so that the term is small. Barriers are weighted by a node's share of the
// cost, or short segments would be held off the ridge.
#include "engine/trace/ridge.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <span>

#include "engine/geometry/segment_cost.h"

namespace lumenline {

namespace {

using Block = Eigen::Matrix3d;
using Column = Eigen::Vector3d;

constexpr int kMaxSteps = 60;
constexpr double kToBoundary = 0.99;  // share of the way to the nearest bound that a step may go
constexpr double kAtRest = 1e-7;      // of the radii: steps below it end the iteration
constexpr double kMuFall = 0.05;
constexpr double kRegular = 1e-13;  // of a block's trace, added to its diagonal: some rounding errors of its sums

/// A bound in units of its node's radius: slack b + g.y + y.Hy/2 - beta q.
struct Slack {
    double b, g0, g1, h00, h01, h11, beta;
    double value = 0, slide = 0;      // of the slack, and its step
    double pressure = 0, change = 0;  // of the multiplier

    [[nodiscard]] double at(const Column& w) const {
        return b + g0 * w[0] + g1 * w[1] + 0.5 * (h00 * w[0] * w[0] + h11 * w[1] * w[1]) + h01 * w[0] * w[1] -
               beta * w[2];
    }
    [[nodiscard]] Column gradient(const Column& w) const {
        return {g0 + h00 * w[0] + h01 * w[1], g1 + h01 * w[0] + h11 * w[1], -beta};
    }
};

class Solver {
public:
    Solver(RidgeProblem& problem, double accuracy) : problem_(problem), accuracy_(accuracy) {
        for (const RidgeNode& n : problem.nodes) scale_.push_back(n.radius);
        const std::size_t n = problem.nodes.size();
        w_.assign(n, Column::Zero());
        step_.assign(n, Column::Zero());
        diagonal_.resize(n);
        above_.resize(n);
        right_.resize(n);
        weight_.resize(n);
        offsets_.assign(n + 1, 0);
    }

    bool run() {
        start();
        double mu = start_mu_;
        for (int k = 0; k < kMaxSteps; ++k) {
            assemble(mu);
            if (!factor()) return false;
            substitute();
            const double shared = advance(mu);
            if (mu <= accuracy_ && shared > 0.9 && largest_step() < std::max(kAtRest, 10 * accuracy_)) break;
            if (shared > 0.5) mu = std::max(mu * kMuFall, 0.5 * accuracy_);
        }
        finish();
        return true;
    }

private:
    [[nodiscard]] std::span<Slack> slacks(std::size_t i) {
        return {slacks_.data() + offsets_[i], slacks_.data() + offsets_[i + 1]};
    }

    /// Slacks in units of the radii, radii a little below their bounds, multipliers to match.
    void start() {
        const auto& nodes = problem_.nodes;
        double reach = 0;
        for (const RidgeNode& n : nodes) reach = std::max(reach, n.reach / n.radius);
        start_mu_ = std::max(0.3 * reach, accuracy_);
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const RidgeNode& n = nodes[i];
            const double unit = n.radius;
            double least = 1;
            if (n.reach > 0) {
                least = problem_.bounds[n.first].value / unit;
                for (std::uint32_t k = n.first; k < n.last; ++k) {
                    const WallBound& b = problem_.bounds[k];
                    slacks_.push_back({b.value / unit, b.gradient[0], b.gradient[1], b.hessian[0] * unit,
                                       b.hessian[1] * unit, b.hessian[2] * unit, 1});
                    least = std::min(least, slacks_.back().b);
                }
                const double limit = n.reach / unit;
                for (const double sign : {1.0, -1.0}) {
                    slacks_.push_back({limit, sign, 0, 0, 0, 0, 0});
                    slacks_.push_back({limit, 0, sign, 0, 0, 0, 0});
                }
                least *= 1 - start_mu_;
            }
            offsets_[i + 1] = static_cast<std::uint32_t>(slacks_.size());
            w_[i] = {0, 0, least};
            double length = 0;
            if (i > 0) length += 0.5 * distance(n.position, nodes[i - 1].position);
            if (i + 1 < nodes.size()) length += 0.5 * distance(n.position, nodes[i + 1].position);
            weight_[i] = std::max(length / unit, 1e-12);
            for (Slack& s : slacks(i)) {
                s.value = s.at(w_[i]);
                s.pressure = start_mu_ * weight_[i] / s.value;
            }
        }
    }

    [[nodiscard]] Vec3 position(std::size_t i) const {
        const RidgeNode& n = problem_.nodes[i];
        return n.position + (n.radius * w_[i][0]) * n.axes[0] + (n.radius * w_[i][1]) * n.axes[1];
    }

    void assemble(double mu) {
        const std::size_t n = w_.size();
        for (std::size_t i = 0; i < n; ++i) {
            diagonal_[i].setZero();
            above_[i].setZero();
            right_[i].setZero();
        }
        for (std::size_t i = 0; i + 1 < n; ++i) add_segment(i);
        for (std::size_t i = 0; i < n; ++i) {
            if (problem_.nodes[i].reach <= 0) {
                diagonal_[i].setIdentity();
                right_[i].setZero();
                above_[i].setZero();
                if (i > 0) above_[i - 1].setZero();
                continue;
            }
            for (const Slack& s : slacks(i)) {
                const Column a = s.gradient(w_[i]);
                diagonal_[i].noalias() += (s.pressure / s.value) * a * a.transpose();
                right_[i] += ((mu * weight_[i] - s.pressure * (s.at(w_[i]) - s.value)) / s.value) * a;
                if (s.h00 + s.h11 >= 0) continue;
                diagonal_[i](0, 0) -= s.pressure * s.h00;
                diagonal_[i](0, 1) -= s.pressure * s.h01;
                diagonal_[i](1, 0) -= s.pressure * s.h01;
                diagonal_[i](1, 1) -= s.pressure * s.h11;
            }
        }
    }

    /// Cost of the segment from node i to the next: gradient to the right-hand side, Hessian to the blocks.
    void add_segment(std::size_t i) {
        const RidgeNode &a = problem_.nodes[i], &b = problem_.nodes[i + 1];
        const Vec3 d = position(i + 1) - position(i);
        const double length = norm(d), sum = a.radius * w_[i][2] + b.radius * w_[i + 1][2];
        if (!(length > 0)) return;
        const Vec3 u = (1 / length) * d;
        const double room = std::max(sum * sum - length * length, 1e-3 * sum * sum);
        const double cl = 2 * sum / room, cs = -2 * length / room;
        const double cll = 4 * sum * length / (room * room);  // of the radii as well
        // Gradients of length and of the sum of radii in the six unknowns.
        const Column la(-a.radius * dot(a.axes[0], u), -a.radius * dot(a.axes[1], u), 0);
        const Column lb(b.radius * dot(b.axes[0], u), b.radius * dot(b.axes[1], u), 0);
        const Column ra(0, 0, a.radius), rb(0, 0, b.radius);
        right_[i] -= cl * la + cs * ra;
        right_[i + 1] -= cl * lb + cs * rb;
        Block aa = cll * (la * la.transpose() + ra * ra.transpose());
        Block bb = cll * (lb * lb.transpose() + rb * rb.transpose());
        Block ab = cll * (la * lb.transpose() + ra * rb.transpose());
        const double bend = cl / length;
        for (int r = 0; r < 2; ++r)
            for (int c = 0; c < 2; ++c) {
                const auto x = static_cast<std::size_t>(r), y = static_cast<std::size_t>(c);
                aa(r, c) += bend * (a.radius * a.radius * dot(a.axes[x], a.axes[y]) - la[r] * la[c]);
                bb(r, c) += bend * (b.radius * b.radius * dot(b.axes[x], b.axes[y]) - lb[r] * lb[c]);
                ab(r, c) -= bend * (a.radius * b.radius * dot(a.axes[x], b.axes[y]) + la[r] * lb[c]);
            }
        diagonal_[i] += aa;
        diagonal_[i + 1] += bb;
        above_[i] += ab;
    }

    /// Factors the block tridiagonal matrix in place, its diagonal blocks to inverses of pivots; false where one
    /// is singular.
    bool factor() {
        for (std::size_t i = 0; i < w_.size(); ++i) {
            if (i > 0) diagonal_[i] -= above_[i - 1].transpose() * diagonal_[i - 1] * above_[i - 1];
            diagonal_[i].diagonal().array() += kRegular * diagonal_[i].trace();
            Block inverse;
            bool invertible = false;
            diagonal_[i].computeInverseWithCheck(inverse, invertible, 0.0);
            if (!invertible || !inverse.allFinite()) return false;
            diagonal_[i] = inverse;
        }
        return true;
    }

    /// Solves for step_ with the factored matrix; uses up right_.
    void substitute() {
        const std::size_t n = w_.size();
        for (std::size_t i = 1; i < n; ++i) right_[i] -= above_[i - 1].transpose() * (diagonal_[i - 1] * right_[i - 1]);
        for (std::size_t i = n; i-- > 0;) {
            Column r = right_[i];
            if (i + 1 < n) r -= above_[i] * step_[i + 1];
            step_[i] = diagonal_[i] * r;
        }
    }

    [[nodiscard]] double largest_step() const {
        double largest = 0;
        for (const Column& s : step_) largest = std::max(largest, s.lpNorm<Eigen::Infinity>());
        return largest;
    }

    /// Goes along the step as far as slacks and multipliers stay positive; returns the shorter share.
    double advance(double mu) {
        double primal = 1, dual = 1;
        for (std::size_t i = 0; i < w_.size(); ++i)
            for (Slack& s : slacks(i)) {
                s.slide = s.gradient(w_[i]).dot(step_[i]) + s.at(w_[i]) - s.value;
                s.change = (mu * weight_[i] - s.pressure * s.slide) / s.value - s.pressure;
                if (primal * s.slide < -kToBoundary * s.value) primal = kToBoundary * s.value / -s.slide;
                if (dual * s.change < -kToBoundary * s.pressure) dual = kToBoundary * s.pressure / -s.change;
            }
        for (std::size_t i = 0; i < w_.size(); ++i) {
            w_[i] += primal * step_[i];
            for (Slack& s : slacks(i)) {
                s.value += primal * s.slide;
                s.pressure += dual * s.change;
            }
        }
        return std::min(primal, dual);
    }

    void finish() {
        for (std::size_t i = 0; i < w_.size(); ++i) {
            RidgeNode& n = problem_.nodes[i];
            if (n.reach <= 0) continue;
            n.move = {n.radius * w_[i][0], n.radius * w_[i][1]};
            n.radius *= w_[i][2];
        }
    }

    RidgeProblem& problem_;
    double accuracy_, start_mu_ = 0;
    std::vector<Column> w_, step_, right_;
    std::vector<Block> diagonal_, above_;
    std::vector<double> weight_, scale_;
    std::vector<Slack> slacks_;
    std::vector<std::uint32_t> offsets_;
};

}  // namespace

bool solve_ridge(RidgeProblem& problem, double accuracy) { return Solver(problem, accuracy).run(); }

}  // namespace lumenline
