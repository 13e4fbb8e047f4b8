// Quantiles are of the piecewise linear distribution that passes half of each value's weight at the value.
#include "engine/branches/robust.h"

#include <algorithm>
#include <cmath>

namespace lumenline {

namespace {

constexpr std::size_t kMostPoints = 96;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double quantile(std::span<const std::pair<double, double>> sorted, double total, double share) {
    const double wanted = share * total;
    double passed = 0, before = 0;
    for (std::size_t k = 0; k < sorted.size(); ++k) {
        const double here = passed + 0.5 * sorted[k].second;
        if (here >= wanted) {
            if (k == 0) return sorted[0].first;
            const double t = here > before ? (wanted - before) / (here - before) : 1.0;
            return std::lerp(sorted[k - 1].first, sorted[k].first, t);
        }
        before = here;
        passed += sorted[k].second;
    }
    return sorted.back().first;
}

}  // namespace

double median_of(std::vector<double>& values) {
    if (values.empty()) return kNaN;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

StraightFit repeated_median(std::span<const double> x, std::span<const double> y) {
    std::vector<double> px, py;
    const std::size_t n = std::min(x.size(), kMostPoints);
    for (std::size_t k = 0; k < n; ++k) {
        const std::size_t i = n > 1 ? k * (x.size() - 1) / (n - 1) : 0;
        px.push_back(x[i]);
        py.push_back(y[i]);
    }
    std::vector<double> medians, slopes;
    for (std::size_t i = 0; i < n; ++i) {
        slopes.clear();
        for (std::size_t j = 0; j < n; ++j)
            if (px[j] != px[i]) slopes.push_back((py[j] - py[i]) / (px[j] - px[i]));
        if (!slopes.empty()) medians.push_back(median_of(slopes));
    }
    const double slope = median_of(medians);
    std::vector<double> rests;
    for (std::size_t i = 0; i < n; ++i) rests.push_back(py[i] - slope * px[i]);
    return {slope, median_of(rests)};
}

Distribution distribution_of(std::vector<std::pair<double, double>> weighted) {
    std::erase_if(weighted, [](const auto& v) { return std::isnan(v.first) || !(v.second > 0); });
    Distribution d;
    if (weighted.empty()) return d;
    std::sort(weighted.begin(), weighted.end());
    double total = 0, sum = 0, squares = 0;
    for (const auto& [value, weight] : weighted) {
        total += weight;
        sum += weight * value;
    }
    d.mean = sum / total;
    for (const auto& [value, weight] : weighted) squares += weight * (value - d.mean) * (value - d.mean);
    if (weighted.size() > 1) d.sd = std::sqrt(squares / total);
    d.min = weighted.front().first;
    d.max = weighted.back().first;
    d.p05 = quantile(weighted, total, 0.05);
    d.p25 = quantile(weighted, total, 0.25);
    d.median = quantile(weighted, total, 0.5);
    d.p75 = quantile(weighted, total, 0.75);
    d.p95 = quantile(weighted, total, 0.95);
    return d;
}

}  // namespace lumenline
