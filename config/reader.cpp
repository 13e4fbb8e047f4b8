// A key that is not in the list of keys can neither be read nor be present: info() asserts the one,
// the constructor refuses the other.

#include "config/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "config/cohort.h"

namespace lumenline {

namespace {

/// What a misplaced key is told: where it belongs, or which key is meant.
std::string hint_for(std::string_view key, const std::string& path) {
    const std::vector<std::string_view> valid = key_names(path);
    const std::string_view before_colon = key.substr(0, key.find(':'));
    if (before_colon.size() < key.size() && std::ranges::find(valid, before_colon) != valid.end())
        return "write a blank after the ':'";
    const std::string_view nearest = nearest_word(key, valid);
    if (!nearest.empty()) return fmt::format("did you mean '{}'?", nearest);
    for (const KeyInfo& other : all_keys()) {
        const std::size_t dot = other.path.rfind('.');
        if (dot != std::string_view::npos && other.path.substr(dot + 1) == key)
            return fmt::format("it belongs below '{}'", other.path.substr(0, dot));
    }
    return fmt::format("valid keys are {}", spoken_list(valid));
}

}  // namespace

std::string_view kind_phrase(const YamlNode& node) {
    static constexpr std::array<std::string_view, 4> kPhrases{"nothing", "text", "a list", "a map"};
    return kPhrases.at(static_cast<std::size_t>(node.kind));
}

MapReader::MapReader(const std::filesystem::path& file, const YamlNode& map, std::string path, const std::string& name)
    : file_(file), map_(map), path_(std::move(path)) {
    if (map.kind != YamlNode::Kind::kMap)
        throw ConfigError(file, map.line, fmt::format("{} must be a map of keys, not {}", name, kind_phrase(map)));
    for (const YamlEntry& entry : map.entries) refuse_unknown(entry, name);
}

void MapReader::refuse_unknown(const YamlEntry& entry, const std::string& name) const {
    const std::vector<std::string_view> valid = key_names(path_);
    if (std::ranges::find(valid, entry.key) != valid.end()) return;
    throw ConfigError(file_, entry.line,
                      fmt::format("unknown key {} in {}; {}", in_quotes(entry.key), name, hint_for(entry.key, path_)));
}

const KeyInfo& MapReader::info(std::string_view key) const {
    return key_info(path_.empty() ? std::string(key) : path_ + "." + std::string(key));
}

Place MapReader::place(const YamlEntry& entry) const {
    return {file_, entry.value->line, fmt::format("key {}", in_quotes(entry.key))};
}

const YamlEntry* MapReader::find(std::string_view key) const {
    (void)info(key);
    const YamlEntry* entry = map_.find(key);
    if (entry != nullptr && entry->value->kind == YamlNode::Kind::kNull)
        fail({file_, entry->line, fmt::format("key '{}'", key)}, "has no value; give one or remove the key");
    return entry;
}

const YamlEntry& MapReader::require(std::string_view key) const {
    const YamlEntry* entry = find(key);
    if (entry == nullptr) fail({file_, map_.line, fmt::format("key '{}'", key)}, "is missing");
    return *entry;
}

MapReader MapReader::section(std::string_view key) const {
    static const YamlNode kEmpty{YamlNode::Kind::kMap, 0, false, {}, {}, {}};
    const YamlEntry* entry = find(key);
    return {file_, entry == nullptr ? kEmpty : *entry->value, std::string(info(key).path), fmt::format("'{}'", key)};
}

std::optional<bool> MapReader::instead_of_map(std::string_view key) const {
    const YamlEntry* entry = find(key);
    if (entry == nullptr || entry->value->kind == YamlNode::Kind::kMap) return std::nullopt;
    const std::string& value = unquoted(*entry, "true, false or a map of keys").text;
    if (value != "true" && value != "false")
        fail(place(*entry), fmt::format("must be true, false or a map of keys, not {}", in_quotes(value)));
    return value == "true";
}

const YamlNode& MapReader::scalar(const YamlEntry& entry, std::string_view expected) const {
    if (entry.value->kind != YamlNode::Kind::kScalar)
        fail(place(entry), fmt::format("must be {}, not {}", expected, kind_phrase(*entry.value)));
    return *entry.value;
}

const YamlNode& MapReader::unquoted(const YamlEntry& entry, std::string_view expected) const {
    const YamlNode& node = scalar(entry, expected);
    if (node.is_quoted)
        fail(place(entry), fmt::format("must be {} without quotes, not the text {}", expected, in_quotes(node.text)));
    return node;
}

std::optional<std::string> MapReader::text(std::string_view key) const {
    const YamlEntry* entry = find(key);
    if (entry == nullptr) return std::nullopt;
    const bool may_be_empty = info(key).default_value == "\"\"";
    return parse_text(place(*entry), scalar(*entry, "text").text, !may_be_empty);
}

std::optional<std::string> MapReader::choice(std::string_view key) const {
    const YamlEntry* entry = find(key);
    if (entry == nullptr) return std::nullopt;
    const KeyInfo& asked = info(key);
    return parse_choice(place(*entry), scalar(*entry, spoken_list(choice_words(asked))).text, asked);
}

std::vector<std::string> MapReader::choices(std::string_view key) const {
    const YamlEntry* entry = find(key);
    if (entry == nullptr) return {};
    if (entry->value->kind != YamlNode::Kind::kSequence) return {*choice(key)};
    const KeyInfo& asked = info(key);
    Place at_value = place(*entry);
    std::vector<std::string> found;
    for (const auto& item : entry->value->items) {
        at_value.line = item->line;
        if (item->kind != YamlNode::Kind::kScalar)
            fail(at_value, fmt::format("must list {}, not {}", spoken_list(choice_words(asked)), kind_phrase(*item)));
        std::string word = parse_choice(at_value, item->text, asked);
        if (std::ranges::find(found, word) != found.end()) fail(at_value, fmt::format("lists '{}' twice", word));
        found.push_back(std::move(word));
    }
    if (found.empty()) fail(at_value, fmt::format("must list at least one of {}", spoken_list(choice_words(asked))));
    return found;
}

std::optional<double> MapReader::number(std::string_view key) const {
    const YamlEntry* entry = find(key);
    if (entry == nullptr) return std::nullopt;
    return parse_number(place(*entry), unquoted(*entry, "a number").text, info(key));
}

std::optional<double> MapReader::number_or_word(std::string_view key) const {
    const YamlEntry* entry = find(key);
    if (entry == nullptr) return std::nullopt;
    const KeyInfo& asked = info(key);
    const std::vector<std::string_view> words = choice_words(asked);
    if (std::ranges::find(words, scalar(*entry, "a number").text) != words.end()) return 0;
    return parse_number(place(*entry), unquoted(*entry, "a number").text, asked);
}

std::optional<bool> MapReader::boolean(std::string_view key) const {
    const YamlEntry* entry = find(key);
    if (entry == nullptr) return std::nullopt;
    const std::string& value = unquoted(*entry, "true or false").text;
    if (value != "true" && value != "false")
        fail(place(*entry), fmt::format("must be true or false, not {}", in_quotes(value)));
    return value == "true";
}

std::optional<int> MapReader::integer_or_word(std::string_view key) const {
    const YamlEntry* entry = find(key);
    if (entry == nullptr) return std::nullopt;
    const KeyInfo& asked = info(key);
    const YamlNode& node = scalar(*entry, "a whole number");
    const std::vector<std::string_view> words = choice_words(asked);
    if (std::ranges::find(words, node.text) != words.end()) return 0;
    return parse_integer(place(*entry), unquoted(*entry, "a whole number").text, asked);
}

std::optional<Quantity> MapReader::quantity_or_word(std::string_view key,
                                                    std::span<const std::string_view> units) const {
    const YamlEntry* entry = find(key);
    if (entry == nullptr) return std::nullopt;
    const YamlNode& node = scalar(*entry, "a number and a unit");
    const std::vector<std::string_view> words = choice_words(info(key));
    if (std::ranges::find(words, node.text) != words.end()) return Quantity{};
    return parse_quantity(place(*entry), node.text, units);
}

std::vector<Vec3> MapReader::points(std::string_view key) const {
    const YamlEntry* entry = find(key);
    if (entry == nullptr) return {};
    constexpr std::string_view kShape = "must be a list of points [[x, y, z], ...]";
    Place at_value = place(*entry);
    if (entry->value->kind != YamlNode::Kind::kSequence)
        fail(at_value, fmt::format("{}, not {}", kShape, kind_phrase(*entry->value)));
    std::vector<Vec3> points;
    for (const auto& item : entry->value->items) {
        at_value.line = item->line;
        if (item->kind != YamlNode::Kind::kSequence)
            fail(at_value,
                 fmt::format("{}, not a list of {}", kShape,
                             item->kind == YamlNode::Kind::kScalar ? in_quotes(item->text) : kind_phrase(*item)));
        if (item->items.size() != 3)
            fail(at_value,
                 fmt::format("{}, but point {} has {} coordinates", kShape, points.size() + 1, item->items.size()));
        Vec3 point;
        for (int axis = 0; axis < 3; ++axis) {
            const YamlNode& value = *item->items[static_cast<std::size_t>(axis)];
            if (value.kind != YamlNode::Kind::kNull) at_value.line = value.line;
            if (value.kind != YamlNode::Kind::kScalar || value.is_quoted)
                fail(at_value, fmt::format("{}, but a coordinate of point {} is {}", kShape, points.size() + 1,
                                           value.is_quoted ? "in quotes" : kind_phrase(value)));
            point[axis] = parse_coordinate(at_value, value.text);
        }
        points.push_back(point);
    }
    return points;
}

std::pair<std::vector<Vec3>, std::vector<InletRule>> MapReader::points_or_rules(std::string_view key) const {
    const YamlEntry* entry = find(key);
    const bool rules =
        entry != nullptr && entry->value->kind == YamlNode::Kind::kScalar && looks_like_rules(entry->value->text);
    if (rules) return {{}, parse_inlet_rules(place(*entry), entry->value->text)};
    return {points(key), {}};
}

}  // namespace lumenline
