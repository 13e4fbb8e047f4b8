// SCHEMA.md, cohort.schema.json and the loader's list of keys are three tellings of one thing.

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "config/document.h"
#include "config/keys.h"
#include "tests/config/support.h"

namespace lumenline {
namespace {

using nlohmann::json;
using testing::Folder;
using testing::read_file;

const std::filesystem::path kConfig = std::filesystem::path(LUMENLINE_SOURCE_DIR) / "config";

/// Type cell of SCHEMA.md: the words of a choice, or the type and the words that may stand for it.
std::string type_cell(const KeyInfo& key) {
    std::string words;
    for (const std::string_view word : choice_words(key))
        words += (words.empty() ? "`" : ", `") + std::string(word) + "`";
    if (key.type == "choice") return words;
    return std::string(key.type) + (words.empty() ? "" : " or " + words);
}

/// Rows of the key table in SCHEMA.md, without the backticks that enclose whole cells.
std::vector<std::vector<std::string>> documented_keys(const std::string& markdown) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream in(markdown);
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with("| `")) continue;
        std::vector<std::string> cells;
        std::istringstream cells_in(line.substr(2));
        for (std::string cell; std::getline(cells_in, cell, '|');) {
            const std::size_t first = cell.find_first_not_of(' ');
            if (first == std::string::npos) continue;
            cells.push_back(cell.substr(first, cell.find_last_not_of(' ') - first + 1));
        }
        rows.push_back(cells);
    }
    return rows;
}

std::string without_ticks(const std::string& cell) {
    return cell.size() > 2 && cell.front() == '`' && cell.back() == '`' ? cell.substr(1, cell.size() - 2) : cell;
}

/// The fenced blocks of one language.
std::vector<std::string> blocks(const std::string& markdown, const std::string& language) {
    std::vector<std::string> found;
    const std::string open = "```" + language + "\n";
    for (std::size_t at = markdown.find(open); at != std::string::npos; at = markdown.find(open, at)) {
        at += open.size();
        const std::size_t end = markdown.find("```", at);
        found.push_back(markdown.substr(at, end - at));
    }
    return found;
}

/// What stands in the way of SCHEMA.md being the list of keys; empty when nothing does.
std::vector<std::string> markdown_faults(const std::string& markdown) {
    std::vector<std::string> faults;
    const auto rows = documented_keys(markdown);
    if (rows.size() != all_keys().size()) faults.emplace_back("number of keys");
    for (std::size_t i = 0; i < std::min(rows.size(), all_keys().size()); ++i) {
        const KeyInfo& key = all_keys()[i];
        const std::string path(key.path);
        if (rows[i].size() != 7) {
            faults.push_back(path + ": cells");
            continue;
        }
        if (without_ticks(rows[i][0]) != key.path) faults.push_back(path + ": path " + rows[i][0]);
        if (rows[i][1] != type_cell(key)) faults.push_back(path + ": type " + rows[i][1]);
        if (rows[i][2] != limits_text(key.limits)) faults.push_back(path + ": limits " + rows[i][2]);
        if (rows[i][3] != key.unit) faults.push_back(path + ": unit " + rows[i][3]);
        if (without_ticks(rows[i][4]) != key.default_value) faults.push_back(path + ": default " + rows[i][4]);
        const std::string name = path.substr(path.rfind('.') + 1);
        if (rows[i][6].find(name + ":") == std::string::npos) faults.push_back(path + ": example " + rows[i][6]);
    }
    return faults;
}

TEST(Schema, MarkdownListsTheLoadersKeys) {
    const std::string markdown = read_file(kConfig / "SCHEMA.md");
    EXPECT_EQ(markdown_faults(markdown), std::vector<std::string>{});
}

TEST(Schema, MarkdownCheckSeesFaults) {
    const std::string markdown = read_file(kConfig / "SCHEMA.md");
    auto edited = [&](const std::string& from, const std::string& to) {
        std::string text = markdown;
        return text.replace(text.find(from), from.size(), to);
    };
    EXPECT_FALSE(markdown_faults(edited("| `run.threads`", "| `run.treads`")).empty());
    EXPECT_FALSE(markdown_faults(edited("| 1 to 4096", "| 1 to 4097")).empty());
    EXPECT_FALSE(markdown_faults(edited("`1e-07`", "`1e-06`")).empty());
    EXPECT_FALSE(markdown_faults(edited("`LPS`, `RAS`", "`LPS`")).empty());
    EXPECT_FALSE(markdown_faults(edited("| opening radii", "| length")).empty());
    EXPECT_FALSE(markdown_faults(edited("\n| `archive.precision`", "\n `archive.precision`")).empty());
}

TEST(Schema, MarkdownExamplesLoad) {
    const std::string markdown = read_file(kConfig / "SCHEMA.md");
    const Folder folder;
    folder.write("surfaces/p01.stl", "");
    const auto tables = blocks(markdown, "tsv");
    ASSERT_EQ(tables.size(), 1U);
    folder.write("participants.tsv", tables[0]);
    const auto examples = blocks(markdown, "yaml");
    EXPECT_EQ(examples.size(), 3U);
    for (const std::string& yaml : examples) EXPECT_EQ(folder.error(yaml), "") << yaml;
}

TEST(Schema, MarkdownExampleOfEveryKeyLoads) {
    const Folder folder;
    folder.write("surfaces/p01.stl", "");
    folder.write("participants.tsv", "id\tsurface\np01\tsurfaces/p01.stl\n");
    folder.write("labels.tsv", "id\tbranch_id\tbranch_label\na\t0\taorta\n");
    const std::map<std::string, std::string> kFrames{
        {"models", "cohort: c\nmodels: {@}\n"},
        {"models.list[]", "cohort: c\nmodels:\n  - {id: a, surface: a.stl, @}\n"},
        {"", "cohort: c\nmodels: [{id: a, surface: a.stl}]\n@\n"},
    };
    for (const auto& row : documented_keys(read_file(kConfig / "SCHEMA.md"))) {
        const std::string path = without_ticks(row.at(0));
        const std::string example = without_ticks(row.at(6));
        const std::size_t dot = path.rfind('.');
        const std::string parent = dot == std::string::npos ? "" : path.substr(0, dot);
        const auto frame = kFrames.find(parent);
        std::string yaml = frame != kFrames.end()
                               ? frame->second
                               : "cohort: c\nmodels: [{id: a, surface: a.stl}]\n" + parent + ": {@}\n";
        // The frame's own line for the key gives way to the example.
        const std::string name = path.substr(dot == std::string::npos ? 0 : dot + 1);
        for (const std::string own : {"id: a, ", "surface: a.stl, ", "cohort: c\n"}) {
            if (own.starts_with(name + ":") && yaml.find(own) != std::string::npos)
                yaml.erase(yaml.find(own), own.size());
        }
        if (path == "models") yaml = "cohort: c\n@\n";
        yaml.replace(yaml.find('@'), 1, example);
        EXPECT_EQ(folder.error(yaml), "") << yaml;
    }
}

TEST(Schema, DefaultsOfTheListAreTheLoadersDefaults) {
    const Folder folder;
    const std::string text = resolved_text(folder.load(testing::with("")));
    const auto document = parse_yaml(text, "resolved.yaml");
    for (const KeyInfo& key : all_keys()) {
        // What these name stands in the list of models.
        if (key.path == "models.table" || key.path == "models.glob" || key.path == "population.label_table") continue;
        const YamlNode* node = document.get();
        std::istringstream parts{std::string(key.path)};
        for (std::string part; std::getline(parts, part, '.');) {
            const bool is_list = part.ends_with("[]");
            const YamlEntry* entry = node->find(is_list ? part.substr(0, part.size() - 2) : part);
            ASSERT_NE(entry, nullptr) << key.path << " is not in\n" << text;
            node = is_list ? entry->value->items.at(0).get() : entry->value.get();
        }
        if (key.default_value == "required" || key.default_value == "-") continue;
        if (key.default_value == "[]") {
            EXPECT_TRUE(node->kind == YamlNode::Kind::kSequence && node->items.empty()) << key.path;
        } else if (key.default_value == "{}") {
            EXPECT_EQ(node->kind, YamlNode::Kind::kMap) << key.path;
        } else {
            EXPECT_EQ(node->text, key.default_value == "\"\"" ? "" : key.default_value) << key.path;
        }
    }
}

// ---- cohort.schema.json

/// Collects what a JSON Schema says of every key, under the paths of the key list.
class SchemaWalk {
public:
    explicit SchemaWalk(const json& root) : root_(root) { visit(root, ""); }

    std::map<std::string, json> keys;
    std::set<std::string> required;
    std::set<std::string> open_objects;  ///< that accept keys of any name

private:
    void visit(const json& node, const std::string& path) {
        if (node.contains("$ref")) {
            const std::string ref = node["$ref"];
            visit(root_.at(json::json_pointer(ref.substr(1))), path);
        }
        for (const json& form : node.value("oneOf", json::array())) {
            // A list directly under `models` is the list form and has the same keys.
            const bool is_list = path == "models" && form.contains("$ref");
            if (!is_list) visit(form, path);
        }
        if (node.contains("items") && node["items"].value("$ref", "") == "#/$defs/model")
            visit(node["items"], path + "[]");
        if (node.value("type", json()) != json("object")) return;
        if (node.value("additionalProperties", json(true)) != json(false)) open_objects.insert(path);
        const std::string prefix = path.empty() ? "" : path + ".";
        const json properties = node.value("properties", json::object());
        for (const auto& [name, value] : properties.items()) {
            keys[prefix + name] = value;
            visit(value, prefix + name);
        }
        for (const json& name : node.value("required", json::array()))
            required.insert(prefix + name.get<std::string>());
    }

    const json& root_;
};

json default_json(const KeyInfo& key) {
    if (key.default_value == "[]") return json::array();
    if (key.default_value == "{}") return json::object();
    if (key.default_value == "\"\"") return "";
    if ((key.type == "number" || key.type == "integer") && key.choices.empty()) return std::stod(std::string(key.default_value));
    if (key.type == "boolean") return key.default_value == "true";
    return std::string(key.default_value);
}

/// The part of a key's schema that holds enum, limits and type, for one that may be a word or a number.
json branch_with(const json& schema, const std::string& member) {
    for (const json& form : schema.value("oneOf", json::array()))
        if (form.contains(member)) return form;
    return schema;
}

std::string type_fault(const KeyInfo& key, const json& schema) {
    const std::map<std::string_view, json> kTypes{
        {"text", {"string", "number", "boolean"}},
        {"path", "string"},
        {"number", "number"},
        {"integer", "integer"},
        {"map", "object"},
        {"map of texts", "object"},
        {"boolean or map", "boolean"},
        {"boolean", "boolean"},
        {"size", "string"},
        {"duration", "string"},
    };
    if (key.type == "points") return schema.value("$ref", "") == "#/$defs/points" ? "" : "type";
    if (key.type == "points or text") return schema.value("$ref", "") == "#/$defs/inlets" ? "" : "type";
    if (key.type == "list") return schema.value("$ref", "") == "#/$defs/list" ? "" : "type";
    if (!kTypes.contains(key.type)) return "";
    return branch_with(schema, "type").value("type", json()) == kTypes.at(key.type) ? "" : "type";
}

std::vector<std::string> json_faults(const json& schema) {
    std::vector<std::string> faults;
    const SchemaWalk walk(schema);
    std::set<std::string> listed;
    for (const KeyInfo& key : all_keys()) {
        const std::string path(key.path);
        listed.insert(path);
        if (!walk.keys.contains(path)) {
            faults.push_back(path + ": absent");
            continue;
        }
        const json& found = walk.keys.at(path);
        if ((key.default_value == "required") != walk.required.contains(path)) faults.push_back(path + ": required");
        const bool has_default = key.default_value != "required" && key.default_value != "-";
        if (has_default != found.contains("default") || (has_default && found["default"] != default_json(key)))
            faults.push_back(path + ": default");
        json words = json::array();
        for (const std::string_view word : choice_words(key)) words.push_back(word);
        if (branch_with(found, "enum").value("enum", json::array()) != words) faults.push_back(path + ": enum");
        const json limited = branch_with(found, "type");
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        const double low = limited.value(key.limits.low_excluded ? "exclusiveMinimum" : "minimum", -kInfinity);
        if (low != key.limits.low || limited.value("maximum", kInfinity) != key.limits.high)
            faults.push_back(path + ": limits");
        if (const std::string fault = type_fault(key, found); !fault.empty()) faults.push_back(path + ": " + fault);
        if (!found.contains("description") && key.type != "list") faults.push_back(path + ": description");
    }
    for (const auto& [path, found] : walk.keys)
        if (!listed.contains(path)) faults.push_back(path + ": unknown");
    if (walk.open_objects != std::set<std::string>{"models.list[].covariates"}) faults.emplace_back("open objects");
    return faults;
}

json load_schema() { return json::parse(read_file(kConfig / "cohort.schema.json")); }

TEST(Schema, JsonSchemaAgreesWithTheLoadersKeys) {
    const json schema = load_schema();
    EXPECT_EQ(schema.at("$schema"), "https://json-schema.org/draft/2020-12/schema");
    EXPECT_EQ(json_faults(schema), std::vector<std::string>{});
}

TEST(Schema, JsonCheckSeesFaults) {
    const std::vector<json> patches{
        {{"op", "remove"}, {"path", "/properties/run/properties/threads"}},
        {{"op", "add"}, {"path", "/properties/run/properties/cores"}, {"value", {{"type", "string"}}}},
        {{"op", "replace"}, {"path", "/properties/coordinate_system/enum"}, {"value", {"LPS", "RAS"}}},
        {{"op", "replace"}, {"path", "/properties/condition/properties/weld_tolerance/default"}, {"value", 1e-6}},
        {{"op", "replace"}, {"path", "/properties/condition/properties/weld_tolerance/type"}, {"value", "integer"}},
        {{"op", "remove"}, {"path", "/$defs/model/properties/scale/exclusiveMinimum"}},
        {{"op", "replace"}, {"path", "/$defs/model/required"}, {"value", {"id"}}},
        {{"op", "remove"}, {"path", "/properties/archive/additionalProperties"}},
    };
    for (const json& patch : patches)
        EXPECT_FALSE(json_faults(load_schema().patch(json::array({patch}))).empty()) << patch;
}

// ---- hints

TEST(EditDistance, CountsEditsAndTranspositionsWithoutCase) {
    EXPECT_EQ(edit_distance("", "abc"), 3U);
    EXPECT_EQ(edit_distance("threads", "Threads"), 0U);
    EXPECT_EQ(edit_distance("refien", "refine"), 1U);
    EXPECT_EQ(edit_distance("sesion", "session"), 1U);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
    for (const KeyInfo& a : all_keys()) {
        for (const KeyInfo& b : all_keys()) EXPECT_EQ(edit_distance(a.path, b.path), edit_distance(b.path, a.path));
    }
}

}  // namespace
}  // namespace lumenline
