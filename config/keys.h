#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lumenline {

/// What the numbers of a key may be.
struct Limits {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool low_excluded = false;

    [[nodiscard]] bool contains(double value) const {
        return (low_excluded ? value > low : value >= low) && value <= high;
    }
};

/// One key of the configuration. SCHEMA.md and cohort.schema.json say the same; a test compares them.
struct KeyInfo {
    std::string_view path;           ///< dotted; "[]" marks the elements of a list
    std::string_view type;           ///< text, path, choice, number, integer, boolean, size, duration, points (or text), list, map, boolean or map
    std::string_view choices;        ///< words that stand for a value, separated by '|'
    std::string_view unit;           ///< "-" = none
    std::string_view default_value;  ///< as in YAML; "required"; "-" = without the key there is nothing
    Limits limits{};
};

/// All keys, in the order in which they are documented and written.
std::span<const KeyInfo> all_keys();

/// The key of that path. It must exist.
const KeyInfo& key_info(std::string_view path);

/// Names of the keys directly below `path`; "" stands for the top.
std::vector<std::string_view> key_names(std::string_view path);

/// The words of a key's `choices`.
std::vector<std::string_view> choice_words(const KeyInfo& key);

/// "> 0", "0 to 0.01", "any"; as in SCHEMA.md.
std::string limits_text(const Limits& limits);

/// Damerau-Levenshtein distance (adjacent transpositions count one) without regard to ASCII case.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The word nearest to `word`; empty where none is nearer than a third of its letters plus one.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> words);

/// "a, b or c".
std::string spoken_list(std::span<const std::string_view> words);

}  // namespace lumenline
