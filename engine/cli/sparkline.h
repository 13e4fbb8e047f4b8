#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace lumenline {

/// Characters that a curve is drawn with.
enum class SparkSet {
    kBlocks,  ///< Unicode's block elements, eight heights
    kAscii,   ///< _ . - : = + * #
};

/// What the locale of the process can show.
SparkSet spark_set();

/// A curve in one line of `cells` characters, each the least of the values in its part of the abscissa, as a share of
/// the largest value: a height of zero means zero, so that curves of different size tell of shape. A part without a
/// value has that of the place nearest before it.
/// @param at      abscissae, ascending, one per value
/// @param values  as many, not negative; what is no number is passed over
/// @returns       an empty text where there is nothing to draw
std::string sparkline(std::span<const double> at, std::span<const double> values, std::size_t cells, SparkSet set);

}  // namespace lumenline
