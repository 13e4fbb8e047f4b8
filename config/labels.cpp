// Labels given by hand come from three places (a list's map, a table's cell, a table of their own) and end with the
// models' identities: they name rows of results and are no part of what determines them.
#include "config/labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "config/table.h"

namespace lumenline {

namespace {

constexpr std::string_view kMissing = "n/a";
constexpr std::array kRules{LabelRule::kPosition, LabelRule::kGiven, LabelRule::kTemplate, LabelRule::kNone};

std::size_t parse_branch(const Place& place, std::string_view text) {
    static constexpr KeyInfo kNumber{"branch", "integer", "", "-", "-", {0, std::numeric_limits<int>::max(), false}};
    return static_cast<std::size_t>(parse_integer(place, text, kNumber));
}

void add_label(const Place& place, std::size_t branch, std::string_view label, GivenLabels& labels) {
    if (std::ranges::any_of(labels, [branch](const auto& known) { return known.first == branch; }))
        fail(place, fmt::format("labels the branch {} a second time", branch));
    labels.emplace_back(branch, parse_text(place, trimmed(label), true));
}

/// Adds the rows of a table with the columns id, branch_id and branch_label.
void read_label_table(const std::filesystem::path& file, const Place& asked_by, std::vector<ModelTask>& tasks) {
    const DelimitedTable table = read_table(file, asked_by);
    const auto column = [&](std::string_view name) {
        const auto found = std::ranges::find(table.columns, name);
        if (found == table.columns.end())
            fail({table.file, table.header_line, fmt::format("column '{}'", name)},
                 "is missing: a table of labels has the columns id, branch_id and branch_label");
        return static_cast<std::size_t>(found - table.columns.begin());
    };
    const std::size_t id = column("id"), branch = column("branch_id"), label = column("branch_label");
    std::map<std::string_view, GivenLabels*> labels_of;
    for (ModelTask& task : tasks) labels_of.emplace(task.identity.id, &task.identity.branch_labels);
    for (const DelimitedTable::Row& row : table.rows) {
        const auto at_column = [&](std::size_t c) {
            return Place{table.file, row.line, fmt::format("column '{}'", table.columns[c])};
        };
        const auto model = labels_of.find(row.cells[id]);
        if (model == labels_of.end())
            fail(at_column(id), fmt::format("names {}, which is no model of the cohort", in_quotes(row.cells[id])));
        const std::string& text = row.cells[label];
        if (trimmed(text).empty() || text == kMissing) continue;
        add_label(at_column(label), parse_branch(at_column(branch), row.cells[branch]), text, *model->second);
    }
}

}  // namespace

GivenLabels parse_branch_labels(const Place& place, std::string_view cell) {
    GivenLabels labels;
    for (bool more = !cell.empty(); more;) {
        const std::size_t semicolon = std::min(cell.find(';'), cell.size());
        const std::string_view item = cell.substr(0, semicolon);
        more = semicolon < cell.size();
        if (more) cell.remove_prefix(semicolon + 1);
        const std::size_t equals = item.find('=');
        if (equals == std::string_view::npos)
            fail(place, fmt::format("must hold labels as NUMBER=LABEL with ';' between them, not {}",
                                    in_quotes(trimmed(item))));
        add_label(place, parse_branch(place, trimmed(item.substr(0, equals))), item.substr(equals + 1), labels);
    }
    return labels;
}

GivenLabels read_branch_labels(const MapReader& model) {
    GivenLabels labels;
    const YamlEntry* entry = model.find("branch_labels");
    if (entry == nullptr) return labels;
    const YamlNode& map = *entry->value;
    if (map.kind != YamlNode::Kind::kMap)
        fail(model.place(*entry), fmt::format("must be a map of branch numbers and labels, not {}", kind_phrase(map)));
    for (const YamlEntry& label : map.entries) {
        if (label.value->kind != YamlNode::Kind::kScalar)
            fail(model.place(label), fmt::format("must be one label, not {}", kind_phrase(*label.value)));
        const Place at_number{model.file(), label.line, fmt::format("key {}", in_quotes(label.key))};
        add_label(model.place(label), parse_branch(at_number, label.key), label.value->text, labels);
    }
    return labels;
}

LabelOptions read_population(const MapReader& top, const std::filesystem::path& folder, std::vector<ModelTask>& tasks) {
    const MapReader section = top.section("population");
    LabelOptions options;
    const std::string rule = section.choice("labels").value_or(std::string(label_rule_name(options.rule)));
    options.rule = *std::ranges::find(kRules, rule, label_rule_name);
    options.template_model = section.text("template").value_or("");
    options.axes = section.choice("directions").value_or("angles") == "axes";
    const YamlEntry* named = section.find("template");
    const auto is_template = [&](const ModelTask& task) { return task.identity.id == options.template_model; };
    if (!options.template_model.empty() && std::ranges::none_of(tasks, is_template))
        fail(section.place(*named),
             fmt::format("names {}, which is no model of the cohort", in_quotes(options.template_model)));
    if (options.rule == LabelRule::kTemplate && options.template_model.empty())
        fail(section.place(*section.find("labels")), "'template' needs the key 'template', a model's id");
    if (const YamlEntry* table = section.find("label_table"))
        read_label_table(folder / *section.text("label_table"), section.place(*table), tasks);
    return options;
}

std::string_view label_rule_name(LabelRule rule) {
    static constexpr std::array<std::string_view, 4> kNames{"position", "given", "template", "none"};
    return kNames.at(static_cast<std::size_t>(rule));
}

}  // namespace lumenline
