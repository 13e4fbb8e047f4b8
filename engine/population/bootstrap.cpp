// The generator and the way of drawing are fixed by the standard (mt19937_64) and by us (the high half of a product),
// since the standard's distributions differ between libraries.
#include "engine/population/bootstrap.h"

#include <algorithm>
#include <numeric>
#include <random>

#include "engine/population/describe.h"

namespace lumenline {

namespace {

struct Total {
    double sum = 0, count = 0;
};

std::vector<Total> totals(std::span<const Cluster> clusters) {
    std::vector<Total> result;
    for (const Cluster& c : clusters)
        result.push_back({std::accumulate(c.begin(), c.end(), 0.0), static_cast<double>(c.size())});
    return result;
}

double mean_of(std::span<const Total> clusters) {
    Total whole;
    for (const Total& t : clusters) whole = {whole.sum + t.sum, whole.count + t.count};
    return whole.sum / whole.count;
}

double drawn_mean(std::span<const Total> clusters, std::mt19937_64& random) {
    Total whole;
    for (std::size_t i = 0; i < clusters.size(); ++i) {
        const Total& t = clusters[(random() >> 32U) * clusters.size() >> 32U];
        whole = {whole.sum + t.sum, whole.count + t.count};
    }
    return whole.sum / whole.count;
}

}  // namespace

Interval bootstrap_difference(std::span<const Cluster> a, std::span<const Cluster> b, double confidence,
                              std::size_t draws, std::uint64_t seed) {
    Interval result;
    if (a.empty() || b.empty()) return result;
    const std::vector<Total> ta = totals(a), tb = totals(b);
    result.value = mean_of(ta) - mean_of(tb);
    if (a.size() < 2 || b.size() < 2) return result;
    std::mt19937_64 random(seed);
    std::vector<double> differences(draws);
    for (double& d : differences) {
        const double of_a = drawn_mean(ta, random);
        d = of_a - drawn_mean(tb, random);
    }
    std::sort(differences.begin(), differences.end());
    result.low = quantile(differences, 0.5 - 0.5 * confidence);
    result.high = quantile(differences, 0.5 + 0.5 * confidence);
    return result;
}

}  // namespace lumenline
