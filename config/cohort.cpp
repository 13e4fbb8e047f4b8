// The document's top level: each section in turn, the models last because they share the options.

#include "config/cohort.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "config/document.h"
#include "config/labels.h"
#include "config/models.h"
#include "config/reader.h"
#include "config/text_file.h"
#include "config/values.h"

namespace lumenline {

namespace {

std::string message(const std::filesystem::path& file, std::size_t line, const std::string& sentence) {
    return line == 0 ? fmt::format("{}: {}", file.string(), sentence)
                     : fmt::format("{}:{}: {}", file.string(), line, sentence);
}

/// The value among `values` whose name is the one read; `fallback` when the key is absent.
template <class Enum, std::size_t N, class NameOf>
Enum enumerated(const std::optional<std::string>& name, Enum fallback, const std::array<Enum, N>& values,
                NameOf name_of) {
    if (name) {
        for (const Enum value : values) {
            if (name_of(value) == *name) return value;
        }
    }
    return fallback;
}

PipelineOptions read_options(const MapReader& top) {
    PipelineOptions options;
    const MapReader endpoints = top.section("endpoints");
    std::optional<EndpointModes> modes;
    for (const std::string& name : endpoints.choices("mode")) {
        const EndpointMode mode =
            enumerated(name, EndpointMode::kAuto,
                       std::array{EndpointMode::kAuto, EndpointMode::kBoundaries, EndpointMode::kCaps,
                                  EndpointMode::kTips, EndpointMode::kPoints},
                       mode_name);
        modes = modes ? *modes | mode : EndpointModes(mode);
    }
    options.endpoints.mode = modes.value_or(options.endpoints.mode);
    if (const auto rule = endpoints.text("inlet"))
        options.endpoints.inlet_rules = parse_inlet_rules(endpoints.place(*endpoints.find("inlet")), *rule);
    if (options.endpoints.inlet_rules == std::vector<InletRule>(1)) options.endpoints.inlet_rules.clear();
    options.endpoints.tip_length = endpoints.number("tip_length").value_or(options.endpoints.tip_length);

    const MapReader condition = top.section("condition");
    ConditionOptions& c = options.condition;
    c.weld_tolerance = condition.number("weld_tolerance").value_or(c.weld_tolerance);
    c.extension_radii = condition.number("extension_radii").value_or(c.extension_radii);
    for (const auto& [name, member] : std::initializer_list<std::pair<const char*, bool ConditionOptions::*>>{
             {"check_self_intersections", &ConditionOptions::check_self_intersections},
             {"drop_faces", &ConditionOptions::drop_faces},
             {"orient_faces", &ConditionOptions::orient_faces},
             {"split_non_manifold", &ConditionOptions::split_non_manifold},
             {"fill_holes", &ConditionOptions::fill_holes},
             {"repair_self_intersections", &ConditionOptions::repair_self_intersections},
             {"refine_undersampled", &ConditionOptions::refine_undersampled}})
        c.*member = condition.boolean(name).value_or(c.*member);
    c.speck_share = condition.number("speck_share").value_or(c.speck_share);
    c.components = enumerated(condition.choice("components"), c.components,
                              std::array{ComponentPolicy::kFail, ComponentPolicy::kLargest, ComponentPolicy::kEach},
                              components_name);
    c.decimate = condition.number_or_word("decimate").value_or(c.decimate);

    const MapReader centerlines = top.section("centerlines");
    TraceOptions& t = options.trace;
    t.refine = enumerated(centerlines.choice("refine"), t.refine,
                          std::array{Refinement::kNone, Refinement::kPath, Refinement::kMedial}, refinement_name);
    t.pairs = enumerated(centerlines.choice("pairs"), t.pairs, std::array{Pairs::kNearest, Pairs::kAll}, pairs_name);
    t.join = enumerated(centerlines.choice("join"), t.join, std::array{Join::kAxis, Join::kCentre}, join_name);
    t.topology = enumerated(centerlines.choice("topology"), t.topology, std::array{Topology::kTree, Topology::kNetwork},
                            topology_name);
    options.characterize = top.boolean("characterize").value_or(options.characterize);
    BranchOptions& b = options.branches;
    if (const auto enabled = top.instead_of_map("branches")) {
        b.enabled = *enabled;
        return options;
    }
    const MapReader branches = top.section("branches");
    b.enabled = branches.boolean("enabled").value_or(b.enabled);
    b.step = branches.number("step").value_or(b.step);
    b.smoothing = branches.number("smoothing").value_or(b.smoothing);
    b.section_step = branches.number("section_step").value_or(b.section_step);
    b.patches_along = branches.integer_or_word("patches_along").value_or(b.patches_along);
    b.patches_around = branches.integer_or_word("patches_around").value_or(b.patches_around);
    return options;
}

double bytes_of(const Quantity& size) {
    constexpr double kByteStep = 1000;
    return size.number * std::pow(kByteStep, size.unit == "MB" ? 2 : size.unit == "GB" ? 3 : 4);
}

void read_limits(const MapReader& run, RunOptions& options) {
    static constexpr std::array<std::string_view, 4> kSizes{"%", "MB", "GB", "TB"};
    if (const auto memory = run.quantity_or_word("memory", kSizes)) {
        const YamlEntry& entry = *run.find("memory");
        if (memory->unit == "%" && memory->number > 100) fail(run.place(entry), "must be 100% or less");
        if (memory->unit == "%")
            options.memory_percent = memory->number;
        else
            options.memory_bytes = bytes_of(*memory);
    }
    static constexpr std::array<std::string_view, 3> kBytes{"MB", "GB", "TB"};
    if (const auto memory = run.quantity_or_word("model_memory", kBytes)) options.model_memory = bytes_of(*memory);
    options.isolation = enumerated(run.choice("isolation"), options.isolation,
                                   std::array{Isolation::kNone, Isolation::kProcess}, isolation_name);
    static constexpr std::array<std::string_view, 3> kTimes{"s", "min", "h"};
    if (const auto timeout = run.quantity_or_word("model_timeout", kTimes))
        options.model_timeout = timeout->number * (timeout->unit == "h" ? 3600 : timeout->unit == "min" ? 60 : 1);
}

}  // namespace

ConfigError::ConfigError(const std::filesystem::path& file, std::size_t line, const std::string& sentence)
    : std::runtime_error(message(file, line, sentence)), file_(file), line_(line) {}

std::string_view isolation_name(Isolation isolation) { return isolation == Isolation::kNone ? "none" : "process"; }

CohortConfig load_cohort(const std::filesystem::path& yaml) {
    TextFile file = read_text_file(yaml, {yaml, 0, "the configuration file"});
    CohortConfig config = parse_cohort(file.text, yaml);
    config.text = std::move(file.raw);
    return config;
}

CohortConfig parse_cohort(const std::string& text, const std::filesystem::path& yaml) {
    CohortConfig config;
    config.file = yaml;
    config.text = text;
    const std::shared_ptr<const YamlNode> document = parse_yaml(text, yaml);

    const MapReader top(yaml, *document, "", "the configuration");
    const std::filesystem::path folder = yaml.parent_path();
    (void)top.require("cohort");
    config.name = *top.text("cohort");

    const MapReader run = top.section("run");
    config.run.threads = run.integer_or_word("threads").value_or(config.run.threads);
    config.run.models_in_flight = run.integer_or_word("models_in_flight").value_or(config.run.models_in_flight);
    read_limits(run, config.run);

    const MapReader archive = top.section("archive");
    config.archive.directory = folder / archive.text("directory").value_or("results");
    config.archive.options.float32_fields = archive.choice("precision").value_or("float32") == "float32";
    config.archive.options.fields =
        enumerated(archive.choice("fields"), ArchiveFields::kAll,
                   std::array{ArchiveFields::kAll, ArchiveFields::kSurface, ArchiveFields::kLines}, fields_name);

    ModelTask prototype;
    prototype.identity.length_unit = top.text("length_unit").value_or(prototype.identity.length_unit);
    prototype.identity.coordinate_system =
        top.choice("coordinate_system").value_or(prototype.identity.coordinate_system);
    prototype.options = read_options(top);
    config.tasks = read_models(top, prototype, folder);
    config.labels = read_population(top, folder, config.tasks);
    return config;
}

}  // namespace lumenline
