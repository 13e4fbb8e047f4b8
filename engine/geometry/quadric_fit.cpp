// In the frame of the normal, with coordinates in units of the neighbourhood's size,
//   z = a x + b y | + c x^2 + d x y + e y^2 | + f x z + g y z + h z^2
// is linear in its coefficients. The three groups make nested models: plane, paraboloid, quadric. One
// Cholesky factorisation of the normal equations serves them all: after forward substitution, the
// first two, five or eight components of a row give that model's prediction and its leverage, hence
// the error with which it predicts that neighbour when left out, (z - prediction) / (1 - leverage).
// A last column of ones gives, as its coefficient, the height at which the neighbours alone see the site.
#include "engine/geometry/quadric_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lumenline {

namespace {

constexpr std::size_t kTerms = 9;
constexpr std::array<std::size_t, 3> kModels{2, 5, 8};
constexpr std::size_t kMostNeighbours = 64;  // farther ones would cost time and change little
constexpr double kDependent = 1e-12;         // what is left of a column's square when those before it explain it
constexpr double kLeastFreedom = 0.03;       // of a neighbour that a model follows anyway: no test of it
using Row = std::array<double, kTerms>;

struct Sample {
    Row row;
    double z, weight;
};

/// Lower triangular factor; a column that depends on those before has a zero pivot.
class Factor {
public:
    explicit Factor(const std::array<Row, kTerms>& normal) {
        for (std::size_t j = 0; j < kTerms; ++j) {
            double pivot = normal[j][j];
            for (std::size_t k = 0; k < j; ++k) pivot -= lower_[j][k] * lower_[j][k];
            inverse_[j] = pivot > kDependent * normal[j][j] ? 1 / std::sqrt(pivot) : 0.0;
            for (std::size_t i = j; i < kTerms; ++i) {
                double sum = normal[i][j];
                for (std::size_t k = 0; k < j; ++k) sum -= lower_[i][k] * lower_[j][k];
                lower_[i][j] = sum * inverse_[j];
            }
        }
    }
    [[nodiscard]] Row forward(const Row& b) const {
        Row y;
        for (std::size_t i = 0; i < kTerms; ++i) {
            double sum = b[i];
            for (std::size_t k = 0; k < i; ++k) sum -= lower_[i][k] * y[k];
            y[i] = sum * inverse_[i];
        }
        return y;
    }
    /// Coefficients of the model of the first `terms` columns.
    [[nodiscard]] Row backward(const Row& y, std::size_t terms) const {
        Row c{};
        for (std::size_t i = terms; i-- > 0;) {
            double sum = y[i];
            for (std::size_t k = i + 1; k < terms; ++k) sum -= lower_[k][i] * c[k];
            c[i] = sum * inverse_[i];
        }
        return c;
    }

private:
    std::array<Row, kTerms> lower_{};
    Row inverse_{};
};

/// Sums of squared errors of each model in predicting samples left out of its fit.
std::array<double, kModels.size()> prediction_errors(std::span<const Sample> samples, const Factor& factor,
                                                     const Row& solution) {
    std::array<double, kModels.size()> sums{};
    for (const Sample& s : samples) {
        const Row y = factor.forward(s.row);
        double prediction = 0, leverage = 0;
        for (std::size_t m = 0, i = 0; m < kModels.size(); ++m) {
            for (; i < kModels[m]; ++i) {
                prediction += y[i] * solution[i];
                leverage += s.weight * y[i] * y[i];
            }
            const double error = (s.z - prediction) / std::max(1 - leverage, kLeastFreedom);
            sums[m] += s.weight * error * error;
        }
    }
    return sums;
}

}  // namespace

Quadric fit_quadric(std::span<const Vec3> around, Vec3 normal) {
    Quadric quadric;
    quadric.gradient = normal;
    const std::size_t count = std::min(around.size(), kMostNeighbours);
    double size2 = 0;
    for (std::size_t i = 0; i < count; ++i) size2 += squared_norm(around[i]);
    if (count <= kModels[1] || !(size2 > 0)) return quadric;
    const double unit = std::sqrt(size2 / static_cast<double>(count));
    const Vec3 u = any_perpendicular(normal), v = cross(normal, u);

    std::array<Sample, kMostNeighbours> samples;
    std::array<Row, kTerms> matrix{};
    Row right{};
    for (std::size_t n = 0; n < count; ++n) {
        const Vec3 d = (1 / unit) * around[n];
        const double x = dot(d, u), y = dot(d, v), z = dot(d, normal), d2 = squared_norm(d);
        const double weight = d2 > 0 ? 1 / d2 : 0.0;
        samples[n] = {{x, y, x * x, x * y, y * y, x * z, y * z, z * z, 1}, z, weight};
        for (std::size_t i = 0; i < kTerms; ++i) {
            const double weighted = weight * samples[n].row[i];
            right[i] += weighted * z;
            for (std::size_t j = 0; j <= i; ++j) matrix[i][j] += weighted * samples[n].row[j];
        }
    }
    const Factor factor(matrix);
    const Row solution = factor.forward(right);
    const auto errors = prediction_errors({samples.data(), count}, factor, solution);
    std::size_t best = 1;
    if (count >= kTerms && errors[2] < errors[1]) best = 2;
    quadric.offset = unit * factor.backward(solution, kTerms)[kTerms - 1];
    if (!(errors[best] < errors[0])) return quadric;
    quadric.share = 1 - errors[best] / errors[0];

    const Row c = factor.backward(solution, kModels[best]);
    quadric.gradient = normal - c[0] * u - c[1] * v;
    const auto add = [&](double coefficient, Vec3 a, Vec3 b) {  // coefficient (a.w)(b.w), on the left-hand side
        const double f = -0.5 * coefficient / unit;
        for (int k = 0; k < 3; ++k) quadric.matrix[static_cast<std::size_t>(k)] += 2 * f * a[k] * b[k];
        quadric.matrix[3] += f * (a.x * b.y + a.y * b.x);
        quadric.matrix[4] += f * (a.x * b.z + a.z * b.x);
        quadric.matrix[5] += f * (a.y * b.z + a.z * b.y);
    };
    add(c[2], u, u);
    add(c[3], u, v);
    add(c[4], v, v);
    add(c[5], u, normal);
    add(c[6], v, normal);
    add(c[7], normal, normal);
    return quadric;
}

}  // namespace lumenline
