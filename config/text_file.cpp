// Everything that a parser further down would misread is refused here: yaml-cpp takes the byte 0x04
// for the end of the file and passes invalid UTF-8 on, which HDF5 strings must not hold.

#include "config/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <system_error>

#include "config/cohort.h"

namespace lumenline {

namespace {

std::size_t line_at(std::string_view text, std::size_t position) {
    return 1 + static_cast<std::size_t>(std::ranges::count(text.substr(0, position), '\n'));
}

std::string read_bytes(const std::filesystem::path& file, const Place& asked_by) {
    auto unreadable = [&](const std::string& reason) {
        fail(asked_by, fmt::format("{} cannot be read: {}", path_in_quotes(file), reason));
    };
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) unreadable("it is a folder");
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    if (!in) unreadable(errno != 0 ? std::generic_category().message(errno) : "it cannot be opened");
    std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    if (in.bad()) unreadable("reading it failed");
    return bytes;
}

std::string with_line_feeds(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\r') {
            result += text[i];
        } else if (i + 1 == text.size() || text[i + 1] != '\n') {
            result += '\n';
        }
    }
    return result;
}

}  // namespace

std::size_t valid_utf8_prefix(std::string_view text) {
    auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<std::uint8_t>(text[i]) : std::uint8_t{0}; };
    std::size_t i = 0;
    while (i < text.size()) {
        const std::uint32_t lead = byte(i);
        const std::size_t length = lead < 0x80 ? 1 : lead >> 5 == 6 ? 2 : lead >> 4 == 14 ? 3 : lead >> 3 == 30 ? 4 : 0;
        if (length == 0) return i;
        std::uint32_t code = length == 1 ? lead : lead & (0x7FU >> length);
        for (std::size_t k = 1; k < length; ++k) {
            if (byte(i + k) >> 6 != 2) return i;
            code = code << 6 | (byte(i + k) & 0x3FU);
        }
        // Overlong forms, surrogates, and what lies beyond Unicode.
        static constexpr std::array<std::uint32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
        if (code < kLeast.at(length) || (code >= 0xD800 && code <= 0xDFFF) || code > 0x10FFFF) return i;
        i += length;
    }
    return i;
}

TextFile read_text_file(const std::filesystem::path& file, const Place& asked_by) {
    TextFile result;
    result.raw = read_bytes(file, asked_by);
    std::string_view rest = result.raw;
    if (rest.starts_with("\xFF\xFE") || rest.starts_with("\xFE\xFF"))
        throw ConfigError(file, 1, "the file is UTF-16; save it as UTF-8");
    if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
    result.text = with_line_feeds(rest);

    const std::string& text = result.text;
    const auto control = std::ranges::find_if(text, [](char c) {
        const auto b = static_cast<unsigned char>(c);
        return (b < 0x20 && c != '\n' && c != '\t') || b == 0x7F;
    });
    const auto control_at = static_cast<std::size_t>(control - text.begin());
    const std::size_t valid = valid_utf8_prefix(text);
    if (valid < control_at)
        throw ConfigError(file, line_at(text, valid),
                          fmt::format("the byte 0x{:02X} is not valid UTF-8; save the file as UTF-8",
                                      static_cast<unsigned char>(text[valid])));
    if (control_at < text.size())
        throw ConfigError(file, line_at(text, control_at),
                          fmt::format("the control character 0x{:02X} does not belong in a text file; remove it",
                                      static_cast<unsigned char>(text[control_at])));
    return result;
}

}  // namespace lumenline
