#include "engine/population/agreement.h"

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <vector>

#include "engine/population/describe.h"

namespace lumenline {

namespace {

constexpr double kLimits = 1.96;  // standard deviations: 95 % of normal differences
constexpr double kRaters = 2;

}  // namespace

Agreement agreement(std::span<const double> first, std::span<const double> second, double confidence) {
    Agreement result;
    result.count = first.size();
    if (first.size() < 3) return result;
    namespace math = boost::math;
    const auto n = static_cast<double>(first.size());
    std::vector<double> difference, middle;
    for (std::size_t i = 0; i < first.size(); ++i) {
        difference.push_back(second[i] - first[i]);
        middle.push_back(0.5 * (first[i] + second[i]));
    }
    const Description d = describe(difference), m = describe(middle);
    const double t = math::quantile(math::students_t(n - 1), 0.5 + 0.5 * confidence);
    const auto around = [](double value, double half) { return Interval{value, value - half, value + half}; };
    result.sd = d.sd;
    result.bias = around(d.mean, t * d.sd / std::sqrt(n));
    const double limit_error = d.sd * std::sqrt(1 / n + kLimits * kLimits / (2 * (n - 1)));
    result.lower_limit = around(d.mean - kLimits * d.sd, t * limit_error);
    result.upper_limit = around(d.mean + kLimits * d.sd, t * limit_error);

    // Mean squares of the two-way analysis of variance: subjects, sessions, residual.
    const double subjects = kRaters * m.sd * m.sd, sessions = 0.5 * n * d.mean * d.mean, residual = 0.5 * d.sd * d.sd;
    const double k = kRaters, whole = subjects + (k - 1) * residual + k / n * (sessions - residual);
    if (!(whole > 0)) return result;
    const double icc = (subjects - residual) / whole;
    result.icc.value = icc;
    if (!(icc < 1) || !(residual > 0)) return result;
    // Interval of McGraw & Wong (1996), table 7, with Satterthwaite's degrees of freedom.
    const double a = k * icc / (n * (1 - icc)), b = 1 + k * icc * (n - 1) / (n * (1 - icc));
    const double sum = a * sessions + b * residual;
    const double freedom =
        sum * sum / (a * a * sessions * sessions / (k - 1) + b * b * residual * residual / ((n - 1) * (k - 1)));
    if (!(freedom > 0)) return result;
    const double upper = 0.5 + 0.5 * confidence;
    const double f_low = math::quantile(math::fisher_f(n - 1, freedom), upper);
    const double f_high = math::quantile(math::fisher_f(freedom, n - 1), upper);
    const double rest = k * sessions + (k * n - k - n) * residual;
    result.icc.low = n * (subjects - f_low * residual) / (f_low * rest + n * subjects);
    result.icc.high = n * (f_high * subjects - residual) / (rest + n * f_high * subjects);
    return result;
}

}  // namespace lumenline
