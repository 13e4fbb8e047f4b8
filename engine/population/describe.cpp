#include "engine/population/describe.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lumenline {

double quantile(std::span<const double> sorted, double share) {
    const double place = share * static_cast<double>(sorted.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), sorted.size() - 1);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

Description describe(std::span<const double> values) {
    Description d;
    d.count = values.size();
    if (values.empty()) return d;
    const auto n = static_cast<double>(values.size());
    d.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    if (values.size() > 1) {
        double squares = 0;
        for (const double v : values) squares += (v - d.mean) * (v - d.mean);
        d.sd = std::sqrt(squares / (n - 1));
    }
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    d.median = quantile(sorted, 0.5);
    d.lower_quartile = quantile(sorted, 0.25);
    d.upper_quartile = quantile(sorted, 0.75);
    d.least = sorted.front();
    d.largest = sorted.back();
    return d;
}

std::vector<double> ranks(std::span<const double> values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    std::vector<double> result(values.size());
    for (std::size_t i = 0; i < order.size();) {
        std::size_t j = i;
        while (j < order.size() && values[order[j]] == values[order[i]]) ++j;
        for (std::size_t k = i; k < j; ++k) result[order[k]] = 0.5 * static_cast<double>(i + 1 + j);
        i = j;
    }
    return result;
}

}  // namespace lumenline
