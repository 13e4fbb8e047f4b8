// Rows are added one by one; each takes the shortest path of alternating steps to a free column, and potentials keep
// the reduced costs from falling below zero (Jonker & Volgenant 1987). A square matrix with a place "without" for every
// element of both sides makes it the problem that the textbook knows. Boost's matchings are of general graphs, and
// build one for each call; here there are ten thousand calls of two by two.
#include "engine/population/assignment.h"

#include <limits>
#include <numeric>

namespace lumenline {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Column of each row of a square matrix.
std::vector<std::size_t> solve(const std::vector<double>& cost, std::size_t n) {
    // Row and column 0 stand for "none yet".
    std::vector<double> row_potential(n + 1, 0), column_potential(n + 1, 0);
    std::vector<std::size_t> row_of(n + 1, 0), before(n + 1, 0);
    for (std::size_t row = 1; row <= n; ++row) {
        row_of[0] = row;
        std::size_t column = 0;
        std::vector<double> distance(n + 1, kInfinity);
        std::vector<bool> done(n + 1, false);
        do {
            done[column] = true;
            const std::size_t from = row_of[column];
            std::size_t next = 0;
            double least = kInfinity;
            for (std::size_t c = 1; c <= n; ++c) {
                if (done[c]) continue;
                const double reduced = cost[(from - 1) * n + c - 1] - row_potential[from] - column_potential[c];
                if (reduced < distance[c]) {
                    distance[c] = reduced;
                    before[c] = column;
                }
                if (distance[c] < least) {
                    least = distance[c];
                    next = c;
                }
            }
            for (std::size_t c = 0; c <= n; ++c) {
                if (done[c]) {
                    row_potential[row_of[c]] += least;
                    column_potential[c] -= least;
                } else {
                    distance[c] -= least;
                }
            }
            column = next;
        } while (row_of[column] != 0);
        for (; column != 0; column = before[column]) row_of[column] = row_of[before[column]];
    }
    std::vector<std::size_t> column_of(n);
    for (std::size_t c = 1; c <= n; ++c) column_of[row_of[c] - 1] = c - 1;
    return column_of;
}

/// More than all sides without partners cost together.
double prohibitive(const std::vector<double>& without_a, const std::vector<double>& without_b) {
    return 1 + 2 * std::accumulate(without_b.begin(), without_b.end(),
                                   std::accumulate(without_a.begin(), without_a.end(), 0.0));
}

}  // namespace

Assignment assign(const std::vector<double>& pair, const std::vector<double>& without_a,
                  const std::vector<double>& without_b) {
    const std::size_t a = without_a.size(), b = without_b.size(), n = a + b;
    const double never = prohibitive(without_a, without_b);
    std::vector<double> cost(n * n, 0);
    for (std::size_t i = 0; i < a; ++i) {
        for (std::size_t j = 0; j < b; ++j) cost[i * n + j] = std::min(pair[i * b + j], never);
        for (std::size_t k = 0; k < a; ++k) cost[i * n + b + k] = k == i ? without_a[i] : never;
    }
    for (std::size_t j = 0; j < b; ++j)
        for (std::size_t k = 0; k < b; ++k) cost[(a + j) * n + k] = k == j ? without_b[j] : never;
    const std::vector<std::size_t> column = solve(cost, n);
    Assignment result;
    for (std::size_t i = 0; i < n; ++i) result.cost += cost[i * n + column[i]];
    for (std::size_t i = 0; i < a; ++i) result.partner.push_back(column[i] < b ? column[i] : Assignment::kNone);
    return result;
}

Assignment assign_otherwise(std::vector<double> pair, const std::vector<double>& without_a,
                            const std::vector<double>& without_b, std::size_t i, std::size_t j) {
    pair[i * without_b.size() + j] = prohibitive(without_a, without_b);
    return assign(pair, without_a, without_b);
}

}  // namespace lumenline
