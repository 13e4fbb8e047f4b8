#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/document.h"
#include "config/keys.h"
#include "config/values.h"

namespace lumenline {

/// Typed access to one map of the document. Every method throws ConfigError, with the line of the
/// offending value, when the value is not what the key asks for.
class MapReader {
public:
    /// @param path  of the map in the key list, "" for the top; every key of `map` must be listed below it
    /// @param name  of the map in messages
    MapReader(const std::filesystem::path& file, const YamlNode& map, std::string path, const std::string& name);

    /// The entry of that key, which must be listed; null when it is absent. A key without value is an error.
    [[nodiscard]] const YamlEntry* find(std::string_view key) const;
    /// The same, but absence is an error.
    [[nodiscard]] const YamlEntry& require(std::string_view key) const;

    /// The map below `key`, or an empty one.
    [[nodiscard]] MapReader section(std::string_view key) const;
    /// Of a key that may be true or false instead of a map: which of them; empty where it is a map or absent.
    [[nodiscard]] std::optional<bool> instead_of_map(std::string_view key) const;

    [[nodiscard]] std::optional<std::string> text(std::string_view key) const;  ///< scalar as written
    [[nodiscard]] std::optional<std::string> choice(std::string_view key) const;
    [[nodiscard]] std::vector<std::string> choices(std::string_view key) const;  ///< one or a list; empty when absent
    [[nodiscard]] std::optional<double> number(std::string_view key) const;
    /// A number; the key's word for "none" gives 0.
    [[nodiscard]] std::optional<double> number_or_word(std::string_view key) const;
    [[nodiscard]] std::optional<bool> boolean(std::string_view key) const;
    /// A whole number; the key's word for "let the program choose" gives 0.
    [[nodiscard]] std::optional<int> integer_or_word(std::string_view key) const;
    /// A number with one of `units`; the key's word for "none" gives the number 0.
    [[nodiscard]] std::optional<Quantity> quantity_or_word(std::string_view key,
                                                           std::span<const std::string_view> units) const;
    [[nodiscard]] std::vector<Vec3> points(std::string_view key) const;  ///< [[x, y, z], ...]; empty when absent
    /// Points or, where the value is a text that starts with a letter, rules; both empty when absent.
    [[nodiscard]] std::pair<std::vector<Vec3>, std::vector<InletRule>> points_or_rules(std::string_view key) const;

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    [[nodiscard]] Place place(const YamlEntry& entry) const;  ///< of the entry's value

private:
    [[nodiscard]] const KeyInfo& info(std::string_view key) const;
    [[nodiscard]] const YamlNode& scalar(const YamlEntry& entry, std::string_view expected) const;
    [[nodiscard]] const YamlNode& unquoted(const YamlEntry& entry, std::string_view expected) const;
    void refuse_unknown(const YamlEntry& entry, const std::string& name) const;

    const std::filesystem::path& file_;
    const YamlNode& map_;
    std::string path_;
};

/// "a list", "a map", "text", "nothing": what a node is, for messages.
std::string_view kind_phrase(const YamlNode& node);

}  // namespace lumenline
