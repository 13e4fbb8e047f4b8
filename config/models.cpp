// Three spellings of one thing. Each reader makes tasks one by one and hands them to a ModelCollector,
// which guards what they must have in common: unique ids and one set of covariates.

#include "config/models.h"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "config/cohort.h"
#include "config/labels.h"
#include "config/table.h"
#include "config/text_file.h"

namespace lumenline {

namespace {

constexpr std::string_view kMissing = "n/a";  // BIDS's word for a missing value
constexpr std::string_view kModel = "models.list[]";

/// Gathers tasks and guards the cohort's promises about them.
class ModelCollector {
public:
    /// @param id_place  of the task's id, for messages
    /// @param origin    where the id comes from, for the message about its double
    void add(ModelTask task, const Place& id_place, const std::string& origin) {
        const auto [first, is_new] = seen_.try_emplace(lower_case(task.identity.id), Seen{task.identity.id, origin});
        if (!is_new)
            fail(id_place, fmt::format("gives the id {} a second time; the first is {} {} (ids differ by more than "
                                       "case)",
                                       in_quotes(task.identity.id), in_quotes(first->second.id), first->second.origin));
        for (const auto& [name, value] : task.identity.covariates) {
            if (covariate_index_.try_emplace(name, covariates_.size()).second) covariates_.push_back(name);
        }
        tasks_.push_back(std::move(task));
    }

    /// The tasks, each with all covariates of the cohort in order of first appearance.
    std::vector<ModelTask> finish() && {
        for (ModelTask& task : tasks_) {
            std::vector<std::pair<std::string, std::string>> all;
            all.reserve(covariates_.size());
            for (const std::string& name : covariates_) all.emplace_back(name, kMissing);
            for (auto& [name, value] : task.identity.covariates) all[covariate_index_.at(name)].second = value;
            task.identity.covariates = std::move(all);
        }
        return std::move(tasks_);
    }

private:
    struct Seen {
        std::string id, origin;
    };

    std::vector<ModelTask> tasks_;
    std::unordered_map<std::string, Seen> seen_;
    std::vector<std::string> covariates_;
    std::unordered_map<std::string, std::size_t> covariate_index_;
};

void set_surface(ModelTask& task, const std::string& given, const std::filesystem::path& folder) {
    task.identity.source_file = given;
    task.surface_path = (folder / given).string();
}

/// What a model states of its inlets stands instead of what the cohort states.
void state_inlets(ModelTask& task, std::vector<Vec3> inlets, std::vector<InletRule> rules) {
    if (inlets.empty() && rules.empty()) return;
    task.options.endpoints.inlets = std::move(inlets);
    task.options.endpoints.inlet_rules = std::move(rules);
}

std::string_view or_missing(std::string_view text) { return text.empty() ? kMissing : text; }

// ---- list

std::vector<std::pair<std::string, std::string>> read_covariates(const MapReader& model) {
    std::vector<std::pair<std::string, std::string>> covariates;
    const YamlEntry* entry = model.find("covariates");
    if (entry == nullptr) return covariates;
    const YamlNode& map = *entry->value;
    if (map.kind != YamlNode::Kind::kMap)
        fail(model.place(*entry), fmt::format("must be a map of names and values, not {}", kind_phrase(map)));
    for (const YamlEntry& covariate : map.entries) {
        const Place at_name{model.file(), covariate.line, fmt::format("key {}", in_quotes(covariate.key))};
        const std::string name = parse_covariate_name(at_name, covariate.key);
        const YamlNode& value = *covariate.value;
        if (value.kind == YamlNode::Kind::kSequence || value.kind == YamlNode::Kind::kMap)
            fail(model.place(covariate), fmt::format("must be one value, not {}", kind_phrase(value)));
        covariates.emplace_back(name, or_missing(parse_text(model.place(covariate), value.text, false)));
    }
    return covariates;
}

void read_list(const YamlNode& list, const std::filesystem::path& file, const ModelTask& prototype,
               const std::filesystem::path& folder, ModelCollector& collector) {
    for (std::size_t i = 0; i < list.items.size(); ++i) {
        const MapReader model(file, *list.items[i], std::string(kModel), fmt::format("model {} of the list", i + 1));
        ModelTask task = prototype;
        const YamlEntry& id = model.require("id");
        (void)model.text("id");
        task.identity.id = parse_id(model.place(id), id.value->text);
        (void)model.require("surface");
        set_surface(task, *model.text("surface"), folder);
        task.identity.subject = model.text("subject").value_or("");
        task.identity.session = model.text("session").value_or("");
        task.identity.side = model.text("side").value_or("");
        task.identity.structure = model.text("structure").value_or("");
        task.identity.group = model.text("group").value_or("");
        auto [inlets, rules] = model.points_or_rules("inlets");
        state_inlets(task, std::move(inlets), std::move(rules));
        task.options.endpoints.outlets = model.points("outlets");
        task.scale = model.number("scale").value_or(task.scale);
        task.identity.branch_labels = read_branch_labels(model);
        task.identity.covariates = read_covariates(model);
        collector.add(std::move(task), model.place(id), fmt::format("in line {}", id.value->line));
    }
}

// ---- table

/// A column's field of the model, or "" for a covariate; the singular names of points are accepted.
std::string_view field_of(std::string_view column) {
    if (column == "inlet") return "inlets";
    if (column == "outlet") return "outlets";
    for (const std::string_view field : key_names(kModel)) {
        if (column == field && field != "covariates") return field;
    }
    return {};
}

/// A misspelt `scale` would silently become a covariate: names this close to a field's are refused.
void refuse_near_miss(const Place& place, std::string_view column) {
    constexpr std::size_t kShortest = 5;  // shorter words ("age", "size") are near too many others
    std::vector<std::string_view> fields = key_names(kModel);
    fields.insert(fields.end(), {"inlet", "outlet"});
    for (const std::string_view field : fields) {
        const std::size_t limit = field.size() >= kShortest ? 1 : 0;
        if (column != field && edit_distance(column, field) <= limit)
            fail(place,
                 fmt::format("is too close to '{}'; write '{}', or give the covariate another name", field, field));
    }
}

/// Position of each field's column; covariates come under their own names in `covariates`.
struct Columns {
    std::map<std::string_view, std::size_t> fields;
    std::vector<std::size_t> covariates;
};

Columns sort_columns(const DelimitedTable& table, std::size_t header_line) {
    Columns columns;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const std::string& name = table.columns[i];
        const Place place{table.file, header_line, fmt::format("column {}", in_quotes(name))};
        const std::string_view field = field_of(name);
        if (field.empty()) {
            refuse_near_miss(place, name);
            parse_covariate_name(place, name);
            columns.covariates.push_back(i);
        } else if (!columns.fields.try_emplace(field, i).second) {
            fail(place, fmt::format("and column {} mean the same; keep one",
                                    in_quotes(table.columns[columns.fields.at(field)])));
        }
    }
    for (const std::string_view field : {"id", "surface"}) {
        if (!columns.fields.contains(field))
            fail({table.file, header_line, fmt::format("column '{}'", field)},
                 fmt::format("is missing; the table has {} ({}-separated)", fmt::join(table.columns, ", "),
                             lower_case(table.file.extension().string()) == ".csv" ? "comma" : "tab"));
    }
    return columns;
}

ModelTask read_row(const DelimitedTable& table, const DelimitedTable::Row& row, const Columns& columns,
                   const ModelTask& prototype, const std::filesystem::path& folder) {
    // The cell of a field as a place and a text; empty when missing.
    auto cell = [&](std::string_view field) -> std::pair<Place, std::string_view> {
        const auto found = columns.fields.find(field);
        if (found == columns.fields.end()) return {};
        const std::string& text = row.cells[found->second];
        return {{table.file, row.line, fmt::format("column {}", in_quotes(table.columns[found->second]))},
                text == kMissing ? std::string_view{} : std::string_view(text)};
    };
    auto text = [&](std::string_view field, bool required) {
        const auto [place, value] = cell(field);
        return parse_text(place, value, required);
    };
    auto points = [&](std::string_view field) {
        const auto [place, value] = cell(field);
        return value.empty() ? std::vector<Vec3>{} : parse_points(place, value);
    };
    ModelTask task = prototype;
    task.identity.id = parse_id(cell("id").first, cell("id").second);
    set_surface(task, text("surface", true), folder);
    task.identity.subject = text("subject", false);
    task.identity.session = text("session", false);
    task.identity.side = text("side", false);
    task.identity.structure = text("structure", false);
    task.identity.group = text("group", false);
    if (const auto [place, value] = cell("inlets"); looks_like_rules(value))
        state_inlets(task, {}, parse_inlet_rules(place, value));
    else
        state_inlets(task, points("inlets"), {});
    task.options.endpoints.outlets = points("outlets");
    const auto [labels_place, labels] = cell("branch_labels");
    task.identity.branch_labels = parse_branch_labels(labels_place, labels);
    const auto [scale_place, scale] = cell("scale");
    if (!scale.empty()) task.scale = parse_number(scale_place, scale, key_info("models.list[].scale"));
    for (const std::size_t i : columns.covariates) {
        const Place place{table.file, row.line, fmt::format("column {}", in_quotes(table.columns[i]))};
        task.identity.covariates.emplace_back(table.columns[i], or_missing(parse_text(place, row.cells[i], false)));
    }
    return task;
}

void read_table_models(const std::filesystem::path& file, const Place& asked_by, const ModelTask& prototype,
                       const std::filesystem::path& folder, ModelCollector& collector) {
    const DelimitedTable table = read_table(file, asked_by);
    const Columns columns = sort_columns(table, table.header_line);
    const std::string id_column = fmt::format("column '{}'", table.columns[columns.fields.at("id")]);
    for (const DelimitedTable::Row& row : table.rows) {
        collector.add(read_row(table, row, columns, prototype, folder), {file, row.line, id_column},
                      fmt::format("in line {}", row.line));
    }
}

// ---- glob

/// glob(3) as a list of paths in byte order, so that neither locale nor file system shows.
std::vector<std::string> matches(const std::string& pattern, const Place& place) {
    const auto release = [](glob_t* g) {
        globfree(g);
        delete g;
    };
    const std::unique_ptr<glob_t, decltype(release)> found(new glob_t{}, release);
    // A folder that is not there matches nothing; one that cannot be read must not look the same.
    const auto is_fatal = [](const char* /*folder*/, int reason) {
        return reason == ENOENT || reason == ENOTDIR ? 0 : 1;
    };
    const int status = ::glob(pattern.c_str(), GLOB_NOSORT, is_fatal, found.get());
    if (status != 0 && status != GLOB_NOMATCH) fail(place, "reaches a folder that cannot be read");
    std::vector<std::string> paths;
    for (std::size_t i = 0; i < found->gl_pathc; ++i) {
        std::error_code ignored;
        if (!std::filesystem::is_directory(found->gl_pathv[i], ignored)) paths.emplace_back(found->gl_pathv[i]);
    }
    std::ranges::sort(paths);
    return paths;
}

/// `text` with the characters that mean something to glob(3) taken literally.
std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (std::string_view("*?[\\").find(c) != std::string_view::npos) result += '\\';
        result += c;
    }
    return result;
}

void read_glob(const std::string& pattern, const Place& place, const ModelTask& prototype,
               const std::filesystem::path& folder, ModelCollector& collector) {
    if (pattern.find("**") != std::string::npos)
        fail(place, fmt::format("must not hold '**'; '*' matches within one folder: {}", in_quotes(pattern)));
    // The folder with the '/' that joins it to the pattern; nothing for a pattern that is absolute.
    const std::string prefix = std::filesystem::path(pattern).is_absolute() ? "" : (folder / "").string();
    const std::vector<std::string> paths = matches(escaped(prefix) + pattern, place);
    if (paths.empty()) fail(place, fmt::format("matches no file: {}", path_in_quotes(prefix + pattern)));
    for (const std::string& path : paths) {
        if (valid_utf8_prefix(path) != path.size())
            fail(place, fmt::format("matches a file whose name is not UTF-8: {}", path_in_quotes(path)));
        const std::string given = path.substr(prefix.size());
        const Place at_file{place.file, place.line, fmt::format("{}: the file {}", place.name, path_in_quotes(given))};
        ModelTask task = prototype;
        set_surface(task, given, folder);
        task.identity.id =
            parse_id({place.file, place.line,
                      fmt::format("{}: the id that the file name {} makes", place.name, path_in_quotes(given))},
                     std::filesystem::path(path).stem().string());
        collector.add(std::move(task), at_file, fmt::format("of the file {}", path_in_quotes(given)));
    }
}

}  // namespace

std::vector<ModelTask> read_models(const MapReader& top, const ModelTask& prototype,
                                   const std::filesystem::path& folder) {
    constexpr std::string_view kOneOf = "must hold exactly one of list, table and glob";
    const YamlEntry& models = top.require("models");
    ModelCollector collector;
    auto list = [&](const YamlEntry& entry) {
        if (entry.value->kind != YamlNode::Kind::kSequence)
            fail(top.place(entry), fmt::format("must be a list of models, not {}", kind_phrase(*entry.value)));
        if (entry.value->items.empty()) fail(top.place(entry), "holds no model; a cohort needs at least one");
        read_list(*entry.value, top.file(), prototype, folder, collector);
    };
    if (models.value->kind == YamlNode::Kind::kSequence) {
        list(models);
        return std::move(collector).finish();
    }
    if (models.value->kind != YamlNode::Kind::kMap)
        fail(top.place(models), fmt::format("must be a list of models or a map with one of list, table and glob, "
                                            "not {}",
                                            in_quotes(models.value->text)));
    const MapReader forms = top.section("models");
    if (models.value->entries.empty()) fail(top.place(models), fmt::format("{}, but is empty", kOneOf));
    if (models.value->entries.size() > 1)
        fail({top.file(), models.value->entries[1].line, "key 'models'"},
             fmt::format("{}, but has both {} and {}", kOneOf, in_quotes(models.value->entries[0].key),
                         in_quotes(models.value->entries[1].key)));
    if (const YamlEntry* entry = forms.find("list")) list(*entry);
    if (const YamlEntry* entry = forms.find("table"))
        read_table_models(folder / *forms.text("table"), forms.place(*entry), prototype, folder, collector);
    if (const YamlEntry* entry = forms.find("glob"))
        read_glob(*forms.text("glob"), forms.place(*entry), prototype, folder, collector);
    return std::move(collector).finish();
}

}  // namespace lumenline
