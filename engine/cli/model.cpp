#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "config/cohort.h"
#include "config/values.h"
#include "engine/cli/model_io.h"
#include "engine/cli/run.h"
#include "engine/cli/standard_output.h"
#include "engine/cli/table.h"
#include "engine/schedule/run_models.h"
#include "io/archive/commit.h"
#include "io/archive/model_file.h"

namespace lumenline {

namespace {

struct ModelArguments {
    ModelTask task;
    std::string output;
    std::vector<std::string> inlets, outlets;
    std::vector<EndpointMode> modes;
    std::string precision = "float32", fields = "all";
    int threads = 0;
    bool skip_self_intersections = false;
    bool skip_characterization = false;
};

const std::vector<std::pair<std::string, EndpointMode>> kModes{{"auto", EndpointMode::kAuto},
                                                               {"boundaries", EndpointMode::kBoundaries},
                                                               {"caps", EndpointMode::kCaps},
                                                               {"tips", EndpointMode::kTips},
                                                               {"points", EndpointMode::kPoints}};

Vec3 parse_point(const std::string& text, const std::string& option) {
    Vec3 p;
    char after = 0;
    // The trailing %c catches anything behind the third number.
    if (std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &p.x, &p.y, &p.z, &after) != 3 || !std::isfinite(p.x + p.y + p.z))
        throw CLI::ValidationError(option, "expected three numbers as X,Y,Z, got '" + text + "'");
    return p;
}

/// An inlet as a point or by rules.
void state_inlet(EndpointOptions& endpoints, const std::string& text) {
    if (!looks_like_rules(text)) {
        endpoints.inlets.push_back(parse_point(text, "--inlet"));
        return;
    }
    try {
        for (const InletRule& rule : parse_inlet_rules({{}, 0, "the rule"}, text))
            endpoints.inlet_rules.push_back(rule);
    } catch (const ConfigError& error) {
        const std::string sentence = error.what();
        throw CLI::ValidationError("--inlet", sentence.substr(std::min(sentence.find("the rule"), sentence.size())));
    }
}

template <class Enumeration>
std::vector<std::string> words_of(const std::vector<std::pair<std::string, Enumeration>>& words) {
    std::vector<std::string> known;
    for (const auto& [word, value] : words) known.push_back(word);
    return known;
}

void print_result(const ModelRecord& record, const std::string& output) {
    to_standard_output([&](std::ostream& out) {
        print_models(out, {summarize(record)});
        for (const Diagnostic& d : record.diagnostics)
            if (d.severity != Severity::kNote)
                out << fmt::format("{} ({}): {}\n", severity_name(d.severity), d.code, d.message);
        out << "model file: " << output << "\n";
    });
}

int run(ModelArguments arguments) {
    ModelTask& task = arguments.task;
    for (const std::string& text : arguments.inlets) state_inlet(task.options.endpoints, text);
    for (const std::string& text : arguments.outlets)
        task.options.endpoints.outlets.push_back(parse_point(text, "--outlet"));
    if (!arguments.modes.empty()) task.options.endpoints.mode = arguments.modes.front();
    for (const EndpointMode mode : arguments.modes) task.options.endpoints.mode |= mode;
    task.options.condition.check_self_intersections = !arguments.skip_self_intersections;
    task.options.characterize = !arguments.skip_characterization;
    task.identity.source_file = task.surface_path;
    task.identity.id = std::filesystem::path(arguments.output).stem().string();
    if (!(std::isfinite(task.scale) && task.scale > 0))
        throw CLI::ValidationError("--scale", "expected a positive number");
    std::error_code ignored;
    if (std::filesystem::equivalent(task.surface_path, arguments.output, ignored))
        throw CLI::ValidationError("--output", "this is the surface itself, which would be overwritten");
    const std::filesystem::path output = output_file(arguments.output);
    ArchiveOptions archive;
    archive.float32_fields = arguments.precision == "float32";
    for (const ArchiveFields fields : {ArchiveFields::kSurface, ArchiveFields::kLines})
        if (arguments.fields == fields_name(fields)) archive.fields = fields;

    const StopOnSignal stop;
    ScheduleOptions schedule;
    schedule.threads = arguments.threads;
    schedule.cancelled = StopOnSignal::flag();
    int status = kDone;
    const RunReport report = run_models({&task, 1}, schedule, load_task, [&](ModelRecord&& record) {
        record.identity.inputs_sha256 = inputs_digest(task, record.identity.source_sha256, archive);
        write_model_file(output, record, archive);
        if (record.failure) {
            fmt::print(stderr, "{}: failed in {}: {}\n", task.surface_path, stage_name(record.failure->stage),
                       record.failure->sentence);
            status = kModelFailed;
        } else {
            print_result(record, arguments.output);
        }
    });
    return report.interrupted + report.not_started > 0 ? kStopped : status;
}

/// An option whose values are words. CLI11's own transformer takes the numbers behind them too, and writes bytes into
/// its help for an enumeration of bytes.
template <class Enumeration>
CLI::Option* add_words(CLI::App& verb, const std::string& name, Enumeration& target, const std::string& help,
                       const std::vector<std::pair<std::string, Enumeration>>& words) {
    return verb
        .add_option_function<std::string>(
            name,
            [&target, words](const std::string& word) {
                for (const auto& [known, value] : words)
                    if (known == word) target = value;
            },
            help)
        ->check(CLI::IsMember(words_of(words)));
}

void add_stage_options(CLI::App& verb, ModelArguments& arguments) {
    PipelineOptions& o = arguments.task.options;
    verb.add_option_function<std::vector<std::string>>(
            "--mode",
            [&arguments](const std::vector<std::string>& words) {
                for (const std::string& word : words)
                    for (const auto& [known, mode] : kModes)
                        if (known == word) arguments.modes.push_back(mode);
            },
            "Where ends come from: auto, boundaries, caps, tips, points; several with commas between them")
        ->delimiter(',')
        ->check(CLI::IsMember(words_of(kModes)))
        ->default_str("auto");
    verb.add_option("--tip-length", o.endpoints.tip_length,
                    "Least length of a blind branch beyond the wall of its parent, in its radii")
        ->check(CLI::Range(1.0, 1000.0))
        ->capture_default_str();
    add_words(verb, "--refine", o.trace.refine,
              "Line: none (as traced), path (relaxed on the complex) or medial (moved off it to the smooth "
              "surface's axis)",
              {{"none", Refinement::kNone}, {"path", Refinement::kPath}, {"medial", Refinement::kMedial}})
        ->default_str("medial");
    add_words(verb, "--pairs", o.trace.pairs, "Trace each target from its nearest source, or from all",
              {{"nearest", Pairs::kNearest}, {"all", Pairs::kAll}})
        ->default_str("nearest");
    add_words(verb, "--join", o.trace.join, "End lines on the axis or at the centre of their openings",
              {{"axis", Join::kAxis}, {"centre", Join::kCentre}})
        ->default_str("axis");
    add_words(verb, "--topology", o.trace.topology,
              "Lumen with loops: tree (a line to each target) or network (and two around each loop)",
              {{"tree", Topology::kTree}, {"network", Topology::kNetwork}})
        ->default_str("tree");
    verb.add_option("--weld-tolerance", o.condition.weld_tolerance,
                    "Share of the diagonal within which vertices are one")
        ->check(CLI::Range(0.0, 0.01))
        ->capture_default_str();
    verb.add_option("--extension-radii", o.condition.extension_radii,
                    "Length of the extensions in radii of their opening")
        ->check(CLI::Range(0.0, 100.0))
        ->capture_default_str();
    verb.add_flag("--skip-self-intersections", arguments.skip_self_intersections, "Do not look for self-intersections");
    verb.add_flag("--skip-characterization", arguments.skip_characterization,
                  "Do not relate the surface's points to the centerlines");
    verb.add_flag("!--skip-branches", o.branches.enabled, "Do not split the lines into branches, nor measure them");
    verb.add_flag("!--keep-faces", o.condition.drop_faces, "Refuse degenerate and repeated triangles");
    verb.add_flag("!--keep-orientation", o.condition.orient_faces, "Refuse flipped triangles and inward components");
    verb.add_flag("!--keep-non-manifold", o.condition.split_non_manifold, "Refuse edges of more than two triangles");
    verb.add_flag("!--keep-holes", o.condition.fill_holes, "Take every boundary loop as an opening");
    verb.add_flag("!--keep-self-intersections", o.condition.repair_self_intersections,
                  "Report triangles that cross each other, repair none");
    verb.add_flag("!--keep-sampling", o.condition.refine_undersampled, "Add no sites where triangles are large");
    verb.add_option("--speck-share", o.condition.speck_share, "Remove components below this share of the area")
        ->check(CLI::Range(0.0, 0.5))
        ->capture_default_str();
    add_words(
        verb, "--components", o.condition.components, "Several components: fail, largest or each",
        {{"fail", ComponentPolicy::kFail}, {"largest", ComponentPolicy::kLargest}, {"each", ComponentPolicy::kEach}})
        ->default_str("each");
    verb.add_option("--decimate", o.condition.decimate, "Coarsen by at most this share of the diagonal; 0 = off")
        ->check(CLI::Range(0.0, 0.1))
        ->capture_default_str();
}

}  // namespace

void add_model(CLI::App& app, std::function<int()>& action) {
    auto arguments = std::make_shared<ModelArguments>();
    ModelTask& task = arguments->task;
    CLI::App* verb = app.add_subcommand("model", "Compute one surface into one model file");
    verb->add_option("SURFACE", task.surface_path, "Triangle surface: STL, PLY, OBJ, OFF, VTP, legacy VTK")->required();
    verb->add_option("-o,--output", arguments->output, "Model file to write; .hdf opens in ParaView")->required();
    verb->add_option("--inlet", arguments->inlets, "Inlet point X,Y,Z, or a rule such as 'highest z'; may be repeated")
        ->take_all();
    verb->add_option("--outlet", arguments->outlets, "Outlet point X,Y,Z; may be repeated")->take_all();
    verb->add_option("--scale", task.scale, "Factor for the file's coordinates")->capture_default_str();
    verb->add_option("--length-unit", task.identity.length_unit, "Unit after scaling, for the archive")
        ->capture_default_str();
    verb->add_option("--coordinate-system", task.identity.coordinate_system, "LPS, RAS or unknown")
        ->check(CLI::IsMember({"LPS", "RAS", "unknown"}))
        ->capture_default_str();
    verb->add_option("--precision", arguments->precision, "Of scalar fields in the file: float32 or float64")
        ->check(CLI::IsMember({"float32", "float64"}))
        ->capture_default_str();
    verb->add_option("--fields", arguments->fields,
                     "What goes into the file: all, surface (no Voronoi diagram), lines (nor the surface)")
        ->check(CLI::IsMember({"all", "surface", "lines"}))
        ->capture_default_str();
    verb->add_option("--threads", arguments->threads, "Threads to use; all if not given")->check(CLI::Range(1, 4096));
    add_stage_options(*verb, *arguments);
    verb->footer(
        "Points are in the unit after scaling. Write negative coordinates as --inlet=-1,2,3.\n"
        "Rules for inlets: largest, smallest, highest x|y|z, lowest x|y|z, nearest [x,y,z], boundary N, point "
        "[x,y,z].\n"
        "Exit status: 0 ok or warning, 1 the model failed, 2 usage error, 3 stopped.");
    verb->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace lumenline
