#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lumenline {

struct YamlNode;

/// One `key: value` of a map.
struct YamlEntry {
    std::string key;
    std::size_t line = 0;  ///< of the key, 1-based
    std::shared_ptr<const YamlNode> value;
};

/// A YAML document as a tree; aliases share their node.
struct YamlNode {
    enum class Kind : std::uint8_t { kNull, kScalar, kSequence, kMap };

    Kind kind = Kind::kNull;
    std::size_t line = 0;                                ///< 1-based
    bool is_quoted = false;                              ///< a scalar in quotes or a block scalar: text, never a number
    std::string text;                                    ///< of a scalar, unconverted
    std::vector<std::shared_ptr<const YamlNode>> items;  ///< of a sequence
    std::vector<YamlEntry> entries;                      ///< of a map, in the order written; keys are unique

    [[nodiscard]] const YamlEntry* find(std::string_view key) const;  ///< null when absent
};

/// Parses one YAML document.
/// @param text  UTF-8 without byte order mark
/// @param file  for messages
/// @throws ConfigError not YAML, empty, several documents, duplicate keys, keys that are no text, merge keys
///         (<<), tags, aliases to a node around them
std::shared_ptr<const YamlNode> parse_yaml(const std::string& text, const std::filesystem::path& file);

}  // namespace lumenline
