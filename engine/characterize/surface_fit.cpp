// Coordinates are taken in units of the two rings' size, so that the normal equations, solved by Cholesky, are of
// order one at any scale. A sphere of radius r has height |d|^2 / (2 r) at the chord d, which is no quadric of the
// plane coordinates; heights scaled by (u^2 + v^2) / |d|^2 are. Without this the curvature of a round tube of 40 points
// comes out 1.6 % too large, and with it every touching ball too small.
#include "engine/characterize/surface_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace lumenline {

namespace {

constexpr int kTerms = 5;
constexpr double kSingular = 1e-10;  // of a diagonal of order one: the neighbours do not determine the quadric

using Matrix = Eigen::Matrix<double, kTerms, kTerms>;
using Vector = Eigen::Matrix<double, kTerms, 1>;

}  // namespace

SurfaceFit::SurfaceFit(const Surface& surface, const SiteNeighbours& ring)
    : surface_(surface), ring_(ring), stamp_(surface.site_count(), 0) {}

void SurfaceFit::gather(SiteId site) {
    ++turn_;
    near_.clear();
    stamp_[at(site)] = turn_;
    const auto take = [&](SiteId s) {
        if (stamp_[at(s)] == turn_) return;
        stamp_[at(s)] = turn_;
        near_.push_back(s);
    };
    for (const SiteId s : ring_.of(site)) take(s);
    first_ring_ = near_.size();
    for (std::size_t i = 0; i < first_ring_; ++i)
        for (const SiteId s : ring_.of(near_[i])) take(s);
}

LocalShape SurfaceFit::at_site(SiteId site) {
    gather(site);
    const Vec3 p = surface_.points[at(site)], n = surface_.normals[at(site)];
    LocalShape shape{-1 * n, 0};
    double size2 = 0;
    for (const SiteId s : near_) size2 = std::max(size2, squared_norm(surface_.points[at(s)] - p));
    if (near_.size() < kTerms || !(size2 > 0)) return shape;
    const double scale = 1 / std::sqrt(size2);
    const Vec3 e1 = scale * any_perpendicular(n), e2 = cross(n, e1);
    Matrix m = Matrix::Zero();
    Vector r = Vector::Zero();
    for (const SiteId s : near_) {
        const Vec3 d = surface_.points[at(s)] - p;
        const double u = dot(d, e1), v = dot(d, e2), height = scale * dot(d, n);
        const double flat2 = u * u + v * v;
        const double z = flat2 > 0 ? height * flat2 / (flat2 + height * height) : height;
        const Vector row(u, v, 0.5 * u * u, u * v, 0.5 * v * v);
        m.noalias() += row * row.transpose();
        r += z * row;
    }
    const Eigen::LLT<Matrix> factor(m);
    const auto pivots = factor.matrixLLT().diagonal().array().square();
    if (factor.info() != Eigen::Success || !(pivots > kSingular * m.diagonal().array()).all()) return shape;
    const Vector solution = factor.solve(r);
    const double a = solution[0], b = solution[1], c = solution[2], d = solution[3], e = solution[4];
    shape.inward = normalized(a * normalized(e1) + b * normalized(e2) - n);
    // Eigenvalues of the second by the first fundamental form; a convex lumen has z fall away.
    const double w = std::sqrt(1 + a * a + b * b), det_first = w * w;
    const double det = (c * e - d * d) / (det_first * det_first);
    const double half_trace = -0.5 * (c * (1 + b * b) - 2 * d * a * b + e * (1 + a * a)) / (det_first * w);
    shape.curvature_max = scale * (half_trace + std::sqrt(std::max(0.0, half_trace * half_trace - det)));
    return shape;
}

}  // namespace lumenline
