// The least value of each cell is drawn and not its mean, since the narrow place is what one looks for.

#include "engine/cli/sparkline.h"

#include <langinfo.h>

#include <algorithm>
#include <array>
#include <clocale>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

namespace lumenline {

namespace {

constexpr std::array<const char*, 8> kBlocks{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
constexpr std::array<const char*, 8> kAscii{"_", ".", "-", ":", "=", "+", "*", "#"};

}  // namespace

SparkSet spark_set() {
    // Asked for here alone: the rest of the program must not follow the locale, whose numbers may have commas.
    const locale_t locale = ::newlocale(LC_CTYPE_MASK, "", nullptr);
    if (locale == nullptr) return SparkSet::kAscii;
    const bool is_utf8 = std::string_view(::nl_langinfo_l(CODESET, locale)) == "UTF-8";
    ::freelocale(locale);
    return is_utf8 ? SparkSet::kBlocks : SparkSet::kAscii;
}

std::string sparkline(std::span<const double> at, std::span<const double> values, std::size_t cells, SparkSet set) {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    std::vector<double> least(cells, kNone);
    double largest = 0;
    const double from = at.empty() ? 0 : at.front(), length = at.empty() ? 0 : at.back() - from;
    for (std::size_t k = 0; k < std::min(at.size(), values.size()); ++k) {
        if (!std::isfinite(values[k])) continue;
        const double place = length > 0 ? (at[k] - from) / length * static_cast<double>(cells) : 0;
        if (!(place >= 0 && place <= static_cast<double>(cells))) continue;
        double& cell = least[std::min(static_cast<std::size_t>(place), cells - 1)];
        cell = std::min(cell, values[k]);
        largest = std::max(largest, values[k]);
    }
    if (!(largest > 0)) return "";
    std::string line;
    double value = *std::find_if(least.begin(), least.end(), [](double v) { return v < kNone; });
    for (const double own : least) {
        if (own < kNone) value = own;
        const double height = std::clamp(value / largest, 0.0, 1.0) * kBlocks.size();
        const auto step = std::min(static_cast<std::size_t>(height), kBlocks.size() - 1);
        line += set == SparkSet::kBlocks ? kBlocks[step] : kAscii[step];
    }
    return line;
}

}  // namespace lumenline
