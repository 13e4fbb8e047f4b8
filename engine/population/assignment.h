#pragma once

#include <cstddef>
#include <vector>

namespace lumenline {

/// Partners of least total cost between two sets, where either side may stay without.
struct Assignment {
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
    std::vector<std::size_t> partner;  ///< per element of the first set; kNone = without
    double cost = 0;
};

/// Optimal assignment (Kuhn 1955, by shortest augmenting paths).
///
/// @param pair       (a x b) cost of each pair, row by row; all finite
/// @param without_a  cost of an element of the first set that stays without, >= 0
/// @param without_b  the same of the second set
/// @returns at equal costs always the same one
/// @cost O((a + b)^3)
Assignment assign(const std::vector<double>& pair, const std::vector<double>& without_a,
                  const std::vector<double>& without_b);

/// The same, but element `i` of the first set does not get `j` of the second.
Assignment assign_otherwise(std::vector<double> pair, const std::vector<double>& without_a,
                            const std::vector<double>& without_b, std::size_t i, std::size_t j);

}  // namespace lumenline
