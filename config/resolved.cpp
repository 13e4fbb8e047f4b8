// Texts are always written in quotes: an id `null` or `1e3` must come back as the same text. Tasks share
// every option but their inlets and outlets, so the first task speaks for all.

#include <yaml-cpp/emitter.h>
#include <yaml-cpp/emittermanip.h>
#include <yaml-cpp/yaml.h>

#include <cassert>
#include <sstream>
#include <string>
#include <string_view>

#include "config/cohort.h"
#include "config/labels.h"
#include "engine/core/text.h"

namespace lumenline {

namespace {

void write(YAML::Emitter& out, const char* key, std::string_view word) {
    out << YAML::Key << key << YAML::Value << std::string(word);
}

void write_text(YAML::Emitter& out, const std::string& key, const std::string& text) {
    out << YAML::Key << YAML::DoubleQuoted << key << YAML::Value << YAML::DoubleQuoted << text;
}

void write_quoted(YAML::Emitter& out, const char* key, const std::string& text) {
    out << YAML::Key << key << YAML::Value << YAML::DoubleQuoted << text;
}

void write_points(YAML::Emitter& out, const char* key, const std::vector<Vec3>& points) {
    out << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const Vec3& p : points)
        out << YAML::Flow << YAML::BeginSeq << exact_text(p.x) << exact_text(p.y) << exact_text(p.z) << YAML::EndSeq;
    out << YAML::EndSeq;
}

void write_modes(YAML::Emitter& out, EndpointModes modes) {
    std::string text = modes_text(modes);
    if (text.find(',') == std::string::npos) return write(out, "mode", text);
    out << YAML::Key << "mode" << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (std::size_t comma = 0; comma != std::string::npos; text.erase(0, comma + 1)) {
        comma = text.find(',');
        out << text.substr(0, comma);
        if (comma == std::string::npos) break;
    }
    out << YAML::EndSeq;
}

void write_section(YAML::Emitter& out, const char* key) { out << YAML::Key << key << YAML::Value << YAML::BeginMap; }

void write_model(YAML::Emitter& out, const ModelTask& task) {
    const ModelIdentity& who = task.identity;
    out << YAML::BeginMap;
    write_quoted(out, "id", who.id);
    write_quoted(out, "surface", who.source_file);
    write_quoted(out, "subject", who.subject);
    write_quoted(out, "session", who.session);
    write_quoted(out, "side", who.side);
    write_quoted(out, "structure", who.structure);
    write_quoted(out, "group", who.group);
    std::string rules;
    for (const InletRule& rule : task.options.endpoints.inlet_rules)
        rules.append(rules.empty() ? "" : "; ").append(rule_text(rule));
    if (rules.empty())
        write_points(out, "inlets", task.options.endpoints.inlets);
    else
        write_quoted(out, "inlets", rules);
    write_points(out, "outlets", task.options.endpoints.outlets);
    write(out, "scale", exact_text(task.scale));
    write_section(out, "branch_labels");
    for (const auto& [branch, label] : who.branch_labels) write_text(out, std::to_string(branch), label);
    out << YAML::EndMap;
    write_section(out, "covariates");
    for (const auto& [name, value] : who.covariates) write_text(out, name, value);
    out << YAML::EndMap << YAML::EndMap;
}

/// The archive's directory as the YAML file would name it: relative to the file's folder, unless it is
/// an absolute path to somewhere else.
std::string directory_text(const CohortConfig& config) {
    const std::filesystem::path& directory = config.archive.directory;
    const std::filesystem::path folder = config.file.parent_path();
    const std::filesystem::path relative = directory.lexically_relative(folder);
    return (folder / relative == directory ? relative : directory).string();
}

std::string count_or(int count, const char* word) { return count == 0 ? word : std::to_string(count); }

}  // namespace

std::string resolved_text(const CohortConfig& config) {
    assert(!config.tasks.empty());
    const ModelTask& first = config.tasks.front();
    const PipelineOptions& options = first.options;
    YAML::Emitter out;
    out << YAML::BeginMap;
    write_quoted(out, "cohort", config.name);
    write_quoted(out, "length_unit", first.identity.length_unit);
    write(out, "coordinate_system", first.identity.coordinate_system);
    write_section(out, "models");
    out << YAML::Key << "list" << YAML::Value << YAML::BeginSeq;
    for (const ModelTask& task : config.tasks) write_model(out, task);
    out << YAML::EndSeq << YAML::EndMap;
    write_section(out, "endpoints");
    write_modes(out, options.endpoints.mode);
    write(out, "inlet", "largest");  // what differs stands with the models
    write(out, "tip_length", exact_text(options.endpoints.tip_length));
    out << YAML::EndMap;
    write_section(out, "condition");
    write(out, "weld_tolerance", exact_text(options.condition.weld_tolerance));
    write(out, "extension_radii", exact_text(options.condition.extension_radii));
    const ConditionOptions& c = options.condition;
    const auto flag = [&out](const char* key, bool value) { write(out, key, value ? "true" : "false"); };
    flag("check_self_intersections", c.check_self_intersections);
    flag("drop_faces", c.drop_faces);
    flag("orient_faces", c.orient_faces);
    flag("split_non_manifold", c.split_non_manifold);
    flag("fill_holes", c.fill_holes);
    flag("repair_self_intersections", c.repair_self_intersections);
    write(out, "speck_share", exact_text(c.speck_share));
    write(out, "components", components_name(c.components));
    flag("refine_undersampled", c.refine_undersampled);
    write(out, "decimate", c.decimate > 0 ? exact_text(c.decimate) : "off");
    out << YAML::EndMap;
    write_section(out, "centerlines");
    write(out, "refine", refinement_name(options.trace.refine));
    write(out, "pairs", pairs_name(options.trace.pairs));
    write(out, "join", join_name(options.trace.join));
    write(out, "topology", topology_name(options.trace.topology));
    out << YAML::EndMap;
    write(out, "characterize", options.characterize ? "true" : "false");
    write_section(out, "branches");
    const BranchOptions& b = options.branches;
    flag("enabled", b.enabled);
    write(out, "step", exact_text(b.step));
    write(out, "smoothing", exact_text(b.smoothing));
    write(out, "section_step", exact_text(b.section_step));
    write(out, "patches_along", std::to_string(b.patches_along));
    write(out, "patches_around", std::to_string(b.patches_around));
    out << YAML::EndMap;
    write_section(out, "population");
    write(out, "labels", label_rule_name(config.labels.rule));
    write_quoted(out, "template", config.labels.template_model);
    write(out, "directions", config.labels.axes ? "axes" : "angles");
    out << YAML::EndMap;
    write_section(out, "run");
    write(out, "threads", count_or(config.run.threads, "all"));
    write(out, "models_in_flight", count_or(config.run.models_in_flight, "auto"));
    write(out, "memory", config.run.memory_bytes > 0 ? exact_text(config.run.memory_bytes / 1e6) + " MB"
                                                     : exact_text(config.run.memory_percent) + "%");
    write(out, "model_timeout", config.run.model_timeout > 0 ? exact_text(config.run.model_timeout) + " s" : "off");
    write(out, "model_memory",
          config.run.model_memory > 0 ? exact_text(config.run.model_memory / 1e6) + " MB" : "off");
    write(out, "isolation", isolation_name(config.run.isolation));
    out << YAML::EndMap;
    write_section(out, "archive");
    write_quoted(out, "directory", directory_text(config));
    write(out, "fields", fields_name(config.archive.options.fields));
    write(out, "precision", config.archive.options.float32_fields ? "float32" : "float64");
    out << YAML::EndMap << YAML::EndMap;
    return std::string(out.c_str()) + "\n";
}

// One line is read and not the text, which lists every model.
std::string cohort_name(const std::string& resolved) {
    std::istringstream text(resolved);
    for (std::string line; std::getline(text, line);) {
        if (!line.starts_with("cohort: ")) continue;
        try {
            return YAML::Load(line)["cohort"].as<std::string>();
        } catch (const YAML::Exception&) {
            break;
        }
    }
    return "cohort";
}

}  // namespace lumenline
