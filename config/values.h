#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/keys.h"
#include "engine/core/options.h"
#include "engine/core/vec3.h"

namespace lumenline {

/// Where a value stands and what it is called in a message.
struct Place {
    std::filesystem::path file;
    std::size_t line = 0;  ///< 1-based; 0 = the file as a whole
    std::string name;      ///< "key 'scale'", "column 'scale'"
};

/// Throws the ConfigError "FILE:LINE: NAME REST".
[[noreturn]] void fail(const Place& place, const std::string& rest);

/// The text in single quotes for a message: on one line, cut after `longest` bytes.
std::string in_quotes(std::string_view text, std::size_t longest = 60);

/// A path in single quotes: on one line, never cut.
std::string path_in_quotes(const std::filesystem::path& path);

/// A decimal number such as 12, -0.5 or 1e-7 within the key's limits. Refused: 010 (which YAML 1.1
/// reads as 8), 0x10, .inf, .nan, 1_000, and what double cannot hold.
double parse_number(const Place& place, std::string_view text, const KeyInfo& key);

/// A whole number within the key's limits, in digits alone.
int parse_integer(const Place& place, std::string_view text, const KeyInfo& key);

/// A number and its unit, "12 GB" or "70%", without or with one blank between them.
struct Quantity {
    double number = 0;
    std::string unit;  ///< one of those allowed
};

/// A positive quantity in one of `units`.
Quantity parse_quantity(const Place& place, std::string_view text, std::span<const std::string_view> units);

/// One coordinate: a finite decimal number.
double parse_coordinate(const Place& place, std::string_view text);

/// Points of a table's cell: "x,y,z", several separated by ";".
std::vector<Vec3> parse_points(const Place& place, std::string_view cell);

/// Rules for inlets, ';' between them: largest, smallest, highest x|y|z, lowest x|y|z, nearest [x, y, z],
/// boundary N, point [x, y, z].
std::vector<InletRule> parse_inlet_rules(const Place& place, std::string_view text);

/// Whether a text is meant as rules: it starts with a letter, as no point does.
bool looks_like_rules(std::string_view text);

/// One of the key's choices; the hint names the nearest.
std::string parse_choice(const Place& place, std::string_view text, const KeyInfo& key);

/// The text itself, when it holds neither control characters nor, with `required`, nothing but blanks.
std::string parse_text(const Place& place, std::string_view text, bool required);

/// A model's id: [A-Za-z0-9][A-Za-z0-9._-]*, at most 128 characters.
std::string parse_id(const Place& place, std::string_view text);

/// A covariate's name: not empty, no "/" (it names a dataset), and no field that a model has anyway.
std::string parse_covariate_name(const Place& place, std::string_view name);

/// `text` without blanks at its ends.
std::string_view trimmed(std::string_view text);

/// `text` in ASCII lower case.
std::string lower_case(std::string_view text);

}  // namespace lumenline
