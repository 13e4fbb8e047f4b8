// Distributions come from Boost.Math; what stands here is the arithmetic that leads to them.
#include "engine/population/hypothesis.h"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>

#include "engine/population/describe.h"

namespace lumenline {

namespace {

namespace math = boost::math;

constexpr std::size_t kMostExact = 8;  // values of the smaller sample

double two_sided(double t, double freedom) {
    return 2 * math::cdf(math::complement(math::students_t(freedom), std::fabs(t)));
}

/// Numbers of ways in which a sample of `m` beside one of `n` has U = 0, 1, ..., m n, by the recurrence of Mann and
/// Whitney: the largest value belongs to either sample.
std::vector<double> ways_of_u(std::size_t m, std::size_t n) {
    // ways[j] holds, for i values of the first sample and j of the second, the counts of each U.
    std::vector<std::vector<double>> ways(n + 1, {1.0});
    for (std::size_t i = 1; i <= m; ++i)
        for (std::size_t j = 0; j <= n; ++j) {
            std::vector<double> count(i * j + 1, 0.0);
            for (std::size_t u = 0; u < ways[j].size(); ++u) count[u + j] += ways[j][u];  // the largest is of the first
            if (j > 0)
                for (std::size_t u = 0; u < ways[j - 1].size(); ++u) count[u] += ways[j - 1][u];
            ways[j] = std::move(count);
        }
    return ways[n];
}

CorrelationResult correlation(std::span<const double> x, std::span<const double> y, double confidence) {
    CorrelationResult result;
    const std::size_t n = x.size();
    if (n < 3) return result;
    const Description dx = describe(x), dy = describe(y);
    double product = 0;
    for (std::size_t i = 0; i < n; ++i) product += (x[i] - dx.mean) * (y[i] - dy.mean);
    const double scale = static_cast<double>(n - 1) * dx.sd * dy.sd;
    if (!(scale > 0)) return result;
    const double r = std::clamp(product / scale, -1.0, 1.0), freedom = static_cast<double>(n) - 2;
    result.coefficient.value = r;
    result.p = std::fabs(r) < 1 ? two_sided(r * std::sqrt(freedom / (1 - r * r)), freedom) : 0.0;
    if (n > 3) {
        const double z = std::atanh(r),
                     half = math::quantile(math::normal(), 0.5 + 0.5 * confidence) / std::sqrt(n - 3.0);
        result.coefficient.low = std::tanh(z - half);
        result.coefficient.high = std::tanh(z + half);
    }
    return result;
}

}  // namespace

WelchResult welch_test(std::span<const double> a, std::span<const double> b, double confidence) {
    WelchResult result;
    if (a.empty() || b.empty()) return result;
    const Description da = describe(a), db = describe(b);
    result.difference.value = da.mean - db.mean;
    if (a.size() < 2 || b.size() < 2) return result;
    const double na = static_cast<double>(a.size()), nb = static_cast<double>(b.size());
    const double va = da.sd * da.sd / na, vb = db.sd * db.sd / nb, variance = va + vb;
    if (!(variance > 0)) return result;
    result.freedom = variance * variance / (va * va / (na - 1) + vb * vb / (nb - 1));
    const double error = std::sqrt(variance);
    result.test = {result.difference.value / error, two_sided(result.difference.value / error, result.freedom)};
    const double half = error * math::quantile(math::students_t(result.freedom), 0.5 + 0.5 * confidence);
    result.difference.low = result.difference.value - half;
    result.difference.high = result.difference.value + half;
    return result;
}

TestResult mann_whitney_test(std::span<const double> a, std::span<const double> b) {
    if (a.empty() || b.empty()) return {};
    std::vector<double> all(a.begin(), a.end());
    all.insert(all.end(), b.begin(), b.end());
    const std::vector<double> rank = ranks(all);
    const double na = static_cast<double>(a.size()), nb = static_cast<double>(b.size()), n = na + nb;
    const double sum = std::accumulate(rank.begin(), rank.begin() + static_cast<std::ptrdiff_t>(a.size()), 0.0);
    const double u = sum - 0.5 * na * (na + 1), extreme = std::max(u, na * nb - u);
    std::map<double, double> shared;
    for (const double r : rank) ++shared[r];
    double ties = 0;
    for (const auto& [r, count] : shared) ties += count * count * count - count;
    if (ties == 0 && std::min(a.size(), b.size()) <= kMostExact) {
        const std::vector<double> ways = ways_of_u(a.size(), b.size());
        const double whole = std::accumulate(ways.begin(), ways.end(), 0.0);
        const double tail = std::accumulate(ways.begin() + static_cast<std::ptrdiff_t>(extreme), ways.end(), 0.0);
        return {u, std::min(1.0, 2 * tail / whole)};
    }
    const double variance = na * nb / 12 * (n + 1 - ties / (n * (n - 1)));
    if (!(variance > 0)) return {u, std::numeric_limits<double>::quiet_NaN()};
    const double z = (extreme - 0.5 * na * nb - 0.5) / std::sqrt(variance);
    return {u, std::min(1.0, 2 * math::cdf(math::complement(math::normal(), z)))};
}

TestResult brown_forsythe_test(std::span<const std::vector<double>> groups) {
    std::vector<std::vector<double>> spread;
    double total = 0, count = 0;
    for (const std::vector<double>& group : groups) {
        if (group.size() < 2) continue;
        const double median = describe(group).median;
        std::vector<double>& distances = spread.emplace_back();
        for (const double v : group) distances.push_back(std::fabs(v - median));
        total = std::accumulate(distances.begin(), distances.end(), total);
        count += static_cast<double>(group.size());
    }
    if (spread.size() < 2) return {};
    double between = 0, within = 0;
    for (const std::vector<double>& distances : spread) {
        const double mean = describe(distances).mean, from_all = mean - total / count;
        between += static_cast<double>(distances.size()) * from_all * from_all;
        for (const double d : distances) within += (d - mean) * (d - mean);
    }
    const double between_freedom = static_cast<double>(spread.size()) - 1;
    const double within_freedom = count - static_cast<double>(spread.size());
    if (!(within > 0 && within_freedom > 0)) return {};
    const double f = between / between_freedom / (within / within_freedom);
    return {f, math::cdf(math::complement(math::fisher_f(between_freedom, within_freedom), f))};
}

std::vector<double> benjamini_hochberg(std::span<const double> p) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < p.size(); ++i)
        if (!std::isnan(p[i])) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
    std::vector<double> q(p.size(), std::numeric_limits<double>::quiet_NaN());
    double least = 1;
    for (std::size_t k = order.size(); k-- > 0;) {
        least = std::min(least, p[order[k]] * static_cast<double>(order.size()) / static_cast<double>(k + 1));
        q[order[k]] = least;
    }
    return q;
}

CorrelationResult pearson_correlation(std::span<const double> x, std::span<const double> y, double confidence) {
    return correlation(x, y, confidence);
}

CorrelationResult spearman_correlation(std::span<const double> x, std::span<const double> y, double confidence) {
    return correlation(ranks(x), ranks(y), confidence);
}

}  // namespace lumenline
