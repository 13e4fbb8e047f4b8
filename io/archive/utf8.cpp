// UTF-8 is decoded by RFC 3629: overlong forms, surrogates and values above U+10FFFF are invalid.
// Each invalid byte is replaced on its own, so one bad byte never swallows its neighbours.

#include "io/archive/utf8.h"

#include <algorithm>

namespace lumenline {

namespace {

struct Decoded {
    char32_t code = 0;
    std::size_t length = 0;  ///< bytes; 0 = invalid
};

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

Decoded decode(std::string_view text) {
    const auto lead = static_cast<unsigned char>(text.front());
    if (lead < 0x80) return {lead, 1};
    const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC2 ? 2 : 0;
    if (length == 0 || lead > 0xF4 || text.size() < length) return {};
    char32_t code = lead & (0xFFU >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        if (!is_continuation(text[i])) return {};
        code = (code << 6U) | (static_cast<unsigned char>(text[i]) & 0x3FU);
    }
    constexpr char32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
    if (code < kSmallest[length] || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) return {};
    return {code, length};
}

bool turns_direction(char32_t c) {
    return c == 0x200E || c == 0x200F || c == 0x061C || (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
}

bool is_control(char32_t c) {
    return c < 0x20 || (c >= 0x7F && c < 0xA0) || c == 0x2028 || c == 0x2029 || turns_direction(c);
}

template <class Rejected>
std::string replaced(std::string_view text, std::string_view substitute, Rejected rejected) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const Decoded next = decode(text);
        const std::size_t length = std::max<std::size_t>(next.length, 1);
        result.append(next.length == 0 || rejected(next.code) ? substitute : text.substr(0, length));
        text.remove_prefix(length);
    }
    return result;
}

}  // namespace

std::string valid_text(std::string_view text) {
    return replaced(text, "\xEF\xBF\xBD", [](char32_t c) { return c == 0; });
}

std::string printable(std::string_view text) { return replaced(text, "?", is_control); }

std::size_t code_points(std::string_view text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return !is_continuation(c); }));
}

std::string_view cut_text(std::string_view text, std::size_t limit) {
    if (text.size() <= limit) return text;
    while (limit > 0 && is_continuation(text[limit])) --limit;
    return text.substr(0, limit);
}

}  // namespace lumenline
