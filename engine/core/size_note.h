#pragma once

#include <span>
#include <string>
#include <vector>

namespace lumenline {

/// What a model's size says of its unit, beside the other models of its cohort. Nothing is rescaled.
///
/// A model whose size is 10, 25.4, 100 or 1000 times the median or a part of it, within a factor that the sizes
/// of one organ may differ by, has probably been written in another unit.
/// @param sizes  of all models, such as diagonals of bounding boxes; 0 or NaN = not known, and left out [length]
/// @param unit   of the lengths, "unknown" if not stated
/// @returns      a sentence for each model, "" where its size is not unusual or fewer than three sizes are known
/// @cost O(n log n)
std::vector<std::string> size_notes(std::span<const double> sizes, const std::string& unit);

}  // namespace lumenline
