#include "engine/core/size_note.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string_view>

#include "engine/core/text.h"

// The median is the size of a model, never the mean of two: half of a small cohort may be ten times too large, and
// the mean would belong to neither half. Sizes within a factor three of the median are one cohort; a
// ratio beyond that is explained by the factor nearest to it in the logarithm, if it is within that spread.

namespace lumenline {
namespace {

constexpr double kSpread = 3;  // ratio of sizes that anatomy alone may give
constexpr std::size_t kFewestSizes = 3;

struct Factor {
    double ratio;
    std::string_view larger;  // what the larger file is probably in, if the others are in ...
    std::string_view smaller;
};

constexpr std::array<Factor, 4> kFactors{{{10, "mm", "cm"}, {25.4, "mm", "inch"}, {100, "cm", "m"}, {1000, "mm", "m"}}};

// The factor nearest to `ratio` > 1; null if none explains it.
const Factor* nearest_factor(double ratio) {
    const Factor* best = nullptr;
    double least = std::log(kSpread) / 2;  // the factors themselves lie a factor 2.5 apart
    for (const Factor& f : kFactors)
        if (const double off = std::fabs(std::log(ratio / f.ratio)); off < least) {
            least = off;
            best = &f;
        }
    return best;
}

bool is_known(double size) { return size > 0 && std::isfinite(size); }

std::string sentence(double size, double median, const std::string& unit) {
    const double ratio = size / median;
    const bool larger = ratio > 1;
    if ((larger ? ratio : 1 / ratio) <= kSpread) return "";
    std::string text = "its size of " + short_text(size) + " is " + short_text(larger ? ratio : 1 / ratio, 3) +
                       (larger ? " times" : " times below") + " the cohort's median of " + short_text(median);
    const Factor* factor = nearest_factor(larger ? ratio : 1 / ratio);
    if (factor == nullptr) return text + ", which no change of unit explains: check the model";
    const std::string_view own = larger ? factor->larger : factor->smaller;
    const std::string_view others = larger ? factor->smaller : factor->larger;
    text += ": is it in another unit, as ";
    if (unit == others)
        text.append(own).append(" where the others are in ").append(others);
    else
        text.append(own).append(" beside ").append(others);
    return text + "? `scale: " + short_text(larger ? 1 / factor->ratio : factor->ratio, 6) + "` would mend that";
}

}  // namespace

std::vector<std::string> size_notes(std::span<const double> sizes, const std::string& unit) {
    std::vector<std::string> notes(sizes.size());
    std::vector<double> known;
    std::copy_if(sizes.begin(), sizes.end(), std::back_inserter(known), is_known);
    if (known.size() < kFewestSizes) return notes;
    const auto middle = known.begin() + static_cast<std::ptrdiff_t>((known.size() - 1) / 2);
    std::nth_element(known.begin(), middle, known.end());
    for (std::size_t i = 0; i < sizes.size(); ++i)
        if (is_known(sizes[i])) notes[i] = sentence(sizes[i], *middle, unit);
    return notes;
}

}  // namespace lumenline
