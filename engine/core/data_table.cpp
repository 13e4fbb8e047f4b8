#include "engine/core/data_table.h"

#include <charconv>
#include <system_error>

namespace lumenline {

bool is_missing(std::string_view text) { return text.empty() || text == "n/a"; }

std::optional<double> number_of(std::string_view text) {
    double number = 0;
    const char* const end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, number);
    return result.ec == std::errc() && result.ptr == end ? std::optional(number) : std::nullopt;
}

}  // namespace lumenline
