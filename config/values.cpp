// Text -> value, for YAML scalars and table cells alike. The number grammar is our own because
// yaml-cpp's conversions read 010 as 8, 0x10 as 16 and accept .inf.

#include "config/values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

#include "config/cohort.h"
#include "engine/core/text.h"

namespace lumenline {

namespace {

constexpr std::size_t kLongestId = 128;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

std::size_t skip_digits(std::string_view text, std::size_t i) {
    while (i < text.size() && is_digit(text[i])) ++i;
    return i;
}

/// [+-] digits [. digits] [e [+-] digits], without leading zeros.
bool is_decimal(std::string_view text) {
    std::size_t i = !text.empty() && (text[0] == '+' || text[0] == '-') ? 1 : 0;
    const std::size_t whole = i;
    i = skip_digits(text, i);
    const std::size_t whole_digits = i - whole;
    if (whole_digits > 1 && text[whole] == '0') return false;
    std::size_t fraction_digits = 0;
    if (i < text.size() && text[i] == '.') {
        const std::size_t fraction = i + 1;
        i = skip_digits(text, fraction);
        fraction_digits = i - fraction;
    }
    if (whole_digits + fraction_digits == 0) return false;
    if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
        ++i;
        if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
        const std::size_t exponent = i;
        i = skip_digits(text, i);
        if (i == exponent) return false;
    }
    return i == text.size();
}

double parse_decimal(const Place& place, std::string_view text) {
    if (!is_decimal(text))
        fail(place, fmt::format("must be a decimal number such as 12.5 or 1e-7, not {}", in_quotes(text)));
    if (text[0] == '+') text.remove_prefix(1);
    double value = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    if (result.ec == std::errc::result_out_of_range || !std::isfinite(value))
        fail(place, fmt::format("is beyond the range of a number in double precision: {}", in_quotes(text)));
    return value;
}

std::string limits_sentence(const Limits& limits) {
    if (limits.high != std::numeric_limits<double>::infinity())
        return fmt::format("must lie between {} and {}", short_text(limits.low), short_text(limits.high, 9));
    return fmt::format("must be {} {}", limits.low_excluded ? "greater than" : "at least", short_text(limits.low));
}

}  // namespace

void fail(const Place& place, const std::string& rest) {
    throw ConfigError(place.file, place.line, place.name + " " + rest);
}

std::string in_quotes(std::string_view text, std::size_t longest) {
    const bool cut = text.size() > longest;
    if (cut) {
        std::size_t end = longest;
        while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // keep UTF-8 whole
        text = text.substr(0, end);
    }
    std::string result = "'";
    for (const char c : text) result += static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? ' ' : c;
    return result + (cut ? "...'" : "'");
}

std::string path_in_quotes(const std::filesystem::path& path) {
    const std::string text = path.string();
    return in_quotes(text, text.size());
}

double parse_number(const Place& place, std::string_view text, const KeyInfo& key) {
    const double value = parse_decimal(place, text);
    if (!key.limits.contains(value))
        fail(place, fmt::format("{}, not {}", limits_sentence(key.limits), in_quotes(text)));
    return value;
}

int parse_integer(const Place& place, std::string_view text, const KeyInfo& key) {
    std::string expected = "must be a whole number";
    for (const std::string_view word : choice_words(key)) expected += fmt::format(" or '{}'", word);
    const std::string_view digits = text.starts_with('-') ? text.substr(1) : text;
    const bool plain = !digits.empty() && std::ranges::all_of(digits, is_digit) && (digits == "0" || digits[0] != '0');
    if (!plain) fail(place, fmt::format("{}, not {}", expected, in_quotes(text)));
    int value = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    if (result.ec != std::errc{} || !key.limits.contains(value))
        fail(place, fmt::format("{}, not {}", limits_sentence(key.limits), in_quotes(text)));
    return value;
}

Quantity parse_quantity(const Place& place, std::string_view text, std::span<const std::string_view> units) {
    const std::size_t digits = std::min(text.find_first_not_of("0123456789."), text.size());
    std::string_view unit = text.substr(digits);
    if (unit.starts_with(' ')) unit.remove_prefix(1);
    const bool known = std::ranges::find(units, unit) != units.end();
    if (digits == 0 || !known || !is_decimal(text.substr(0, digits)))
        fail(place, fmt::format("must be a number and a unit ({}), not {}", spoken_list(units), in_quotes(text)));
    const double number = parse_decimal(place, text.substr(0, digits));
    if (number <= 0) fail(place, fmt::format("must be above 0, not {}", in_quotes(text)));
    return {number, std::string(unit)};
}

double parse_coordinate(const Place& place, std::string_view text) { return parse_decimal(place, text); }

std::vector<Vec3> parse_points(const Place& place, std::string_view cell) {
    std::vector<Vec3> points;
    for (bool more = true; more;) {
        const std::size_t semicolon = std::min(cell.find(';'), cell.size());
        std::string_view point = cell.substr(0, semicolon);
        more = semicolon < cell.size();
        if (more) cell.remove_prefix(semicolon + 1);
        if (std::ranges::count(point, ',') != 2)
            fail(place,
                 fmt::format("must hold points as x,y,z with ';' between them, not {}", in_quotes(trimmed(point))));
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis) {
            const std::size_t comma = std::min(point.find(','), point.size());
            p[axis] = parse_coordinate(place, trimmed(point.substr(0, comma)));
            point.remove_prefix(std::min(comma + 1, point.size()));
        }
        points.push_back(p);
    }
    return points;
}

namespace {

constexpr std::array<std::string_view, 7> kRuleWords{"largest", "smallest", "highest", "lowest",
                                                     "nearest", "boundary", "point"};

InletRule parse_inlet_rule(const Place& place, std::string_view text) {
    const std::size_t blank = std::min(text.find_first_of(" \t["), text.size());
    const std::string_view word = text.substr(0, blank);
    std::string_view rest = trimmed(text.substr(blank));
    const auto known = std::ranges::find(kRuleWords, word);
    if (known == kRuleWords.end()) {
        const std::string_view nearest = nearest_word(word, kRuleWords);
        const std::string hint = nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
        fail(place, fmt::format("must say {}, not {}{}", spoken_list(kRuleWords), in_quotes(text), hint));
    }
    InletRule rule;
    rule.kind = static_cast<InletRule::Kind>(known - kRuleWords.begin());
    switch (rule.kind) {
        case InletRule::Kind::kLargest:
        case InletRule::Kind::kSmallest:
            if (!rest.empty()) fail(place, fmt::format("'{}' takes nothing behind it, not {}", word, in_quotes(rest)));
            break;
        case InletRule::Kind::kHighest:
        case InletRule::Kind::kLowest:
            if (rest != "x" && rest != "y" && rest != "z")
                fail(place, fmt::format("'{}' takes an axis x, y or z, not {}", word, in_quotes(rest)));
            rule.axis = rest[0] - 'x';
            break;
        case InletRule::Kind::kBoundary: {
            constexpr KeyInfo kNumber{"", "integer", "", "", "", {1, 1e6, false}};
            rule.number = static_cast<std::size_t>(parse_integer(place, rest, kNumber));
            break;
        }
        case InletRule::Kind::kNearest:
        case InletRule::Kind::kPoint: {
            if (rest.size() < 2 || rest.front() != '[' || rest.back() != ']')
                fail(place, fmt::format("'{}' takes a point [x, y, z], not {}", word, in_quotes(rest)));
            rest.remove_prefix(1);
            rest.remove_suffix(1);
            const std::vector<Vec3> points = parse_points(place, rest);
            if (points.size() != 1) fail(place, fmt::format("'{}' takes one point, not {}", word, points.size()));
            rule.point = points[0];
            break;
        }
    }
    return rule;
}

}  // namespace

std::vector<InletRule> parse_inlet_rules(const Place& place, std::string_view text) {
    std::vector<InletRule> rules;
    for (bool more = true; more;) {
        const std::size_t semicolon = std::min(text.find(';'), text.size());
        rules.push_back(parse_inlet_rule(place, trimmed(text.substr(0, semicolon))));
        more = semicolon < text.size();
        if (more) text.remove_prefix(semicolon + 1);
    }
    return rules;
}

bool looks_like_rules(std::string_view text) {
    text = trimmed(text);
    return !text.empty() && is_letter(text[0]);
}

std::string parse_choice(const Place& place, std::string_view text, const KeyInfo& key) {
    const std::vector<std::string_view> words = choice_words(key);
    if (std::ranges::find(words, text) != words.end()) return std::string(text);
    const std::string_view nearest = nearest_word(text, words);
    const std::string hint = nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
    fail(place, fmt::format("must be {}, not {}{}", spoken_list(words), in_quotes(text), hint));
}

std::string parse_text(const Place& place, std::string_view text, bool required) {
    const bool control = std::ranges::any_of(text, [](unsigned char c) { return c < 0x20 || c == 0x7F; });
    if (control) fail(place, fmt::format("must be one line without control characters: {}", in_quotes(text)));
    if (required && trimmed(text).empty()) fail(place, "must not be empty");
    return std::string(text);
}

std::string parse_id(const Place& place, std::string_view text) {
    auto allowed = [](char c) { return is_letter(c) || is_digit(c) || c == '.' || c == '_' || c == '-'; };
    if (text.empty()) fail(place, "must not be empty");
    if (text.size() > kLongestId)
        fail(place, fmt::format("must not be longer than {} characters, but has {}", kLongestId, text.size()));
    if (!is_letter(text[0]) && !is_digit(text[0]))
        fail(place,
             fmt::format("must start with a letter A-Z, a-z or a digit, because it names a file: {}", in_quotes(text)));
    if (!std::ranges::all_of(text, allowed))
        fail(place, fmt::format("may hold only A-Z, a-z, 0-9, '.', '_' and '-', because it names a file: {}",
                                in_quotes(text)));
    return std::string(text);
}

std::string parse_covariate_name(const Place& place, std::string_view name) {
    parse_text(place, name, true);
    if (name.find('/') != std::string_view::npos || name == "." || name == "..")
        fail(place, "cannot name a covariate, because it becomes the name of a table column: no '/', no lone dots");
    if (trimmed(name) != name) fail(place, "must not start or end with a blank");
    for (const std::string_view field : key_names("models.list[]")) {
        if (lower_case(name) == field)
            fail(place, fmt::format("cannot name a covariate: every model has a field '{}' of its own", field));
    }
    return std::string(name);
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string lower_case(std::string_view text) {
    std::string result(text);
    for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return result;
}

}  // namespace lumenline
