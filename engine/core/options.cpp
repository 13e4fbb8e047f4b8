#include "engine/core/options.h"

#include <array>

#include "engine/core/archive_options.h"
#include "engine/core/text.h"

namespace lumenline {

std::string_view components_name(ComponentPolicy policy) {
    static constexpr std::array<std::string_view, 3> kNames{"fail", "largest", "each"};
    return kNames.at(static_cast<std::size_t>(policy));
}

std::string_view mode_name(EndpointMode mode) {
    static constexpr std::array<std::string_view, 5> kNames{"auto", "boundaries", "caps", "tips", "points"};
    return kNames.at(static_cast<std::size_t>(mode));
}

std::string modes_text(EndpointModes modes) {
    std::string text;
    for (const EndpointMode mode : {EndpointMode::kAuto, EndpointMode::kBoundaries, EndpointMode::kCaps,
                                    EndpointMode::kTips, EndpointMode::kPoints})
        if (modes.has(mode)) text.append(text.empty() ? "" : ",").append(mode_name(mode));
    return text;
}

std::string rule_text(const InletRule& rule) {
    const auto bracketed = [](std::string word, Vec3 p) {
        for (int i = 0; i < 3; ++i) word.append(i == 0 ? " [" : ", ").append(exact_text(p[i]));
        return word.append("]");
    };
    const char axis = "xyz"[rule.axis];
    switch (rule.kind) {
        case InletRule::Kind::kLargest: return "largest";
        case InletRule::Kind::kSmallest: return "smallest";
        case InletRule::Kind::kHighest: return std::string("highest ") + axis;
        case InletRule::Kind::kLowest: return std::string("lowest ") + axis;
        case InletRule::Kind::kNearest: return bracketed("nearest", rule.point);
        case InletRule::Kind::kBoundary: return "boundary " + std::to_string(rule.number);
        case InletRule::Kind::kPoint: return bracketed("point", rule.point);
    }
    return "";
}

std::string_view refinement_name(Refinement refinement) {
    static constexpr std::array<std::string_view, 3> kNames{"none", "path", "medial"};
    return kNames.at(static_cast<std::size_t>(refinement));
}

std::string_view pairs_name(Pairs pairs) { return pairs == Pairs::kNearest ? "nearest" : "all"; }

std::string_view join_name(Join join) { return join == Join::kAxis ? "axis" : "centre"; }
std::string_view topology_name(Topology topology) { return topology == Topology::kTree ? "tree" : "network"; }

namespace {

/// Raised whenever a change of a stage's algorithm can change its result.
constexpr std::string_view kAlgorithmVersions =
    "condition.version=3\nvoronoi.version=4\nendpoints.version=2\neikonal.version=1\ntrace.version=4\n"
    "characterize.version=1\nbranches.version=2\n";

std::string points_text(const std::vector<Vec3>& points) {
    std::string text;
    for (const Vec3& p : points) text += exact_text(p.x) + "," + exact_text(p.y) + "," + exact_text(p.z) + ";";
    return text;
}

}  // namespace

std::string canonical_text(const ModelTask& task) {
    const PipelineOptions& o = task.options;
    std::string text(kAlgorithmVersions);
    auto line = [&text](std::string_view key, std::string_view value) {
        text.append(key).append("=").append(value).append("\n");
    };
    line("scale", exact_text(task.scale));
    line("condition.weld_tolerance", exact_text(o.condition.weld_tolerance));
    line("condition.extension_radii", exact_text(o.condition.extension_radii));
    const auto flag = [&line](std::string_view key, bool value) { line(key, value ? "true" : "false"); };
    flag("condition.check_self_intersections", o.condition.check_self_intersections);
    flag("condition.drop_faces", o.condition.drop_faces);
    flag("condition.orient_faces", o.condition.orient_faces);
    flag("condition.split_non_manifold", o.condition.split_non_manifold);
    flag("condition.fill_holes", o.condition.fill_holes);
    flag("condition.repair_self_intersections", o.condition.repair_self_intersections);
    line("condition.speck_share", exact_text(o.condition.speck_share));
    line("condition.components", components_name(o.condition.components));
    flag("condition.refine_undersampled", o.condition.refine_undersampled);
    line("condition.decimate", exact_text(o.condition.decimate));
    line("voronoi.merge_tolerance", exact_text(o.voronoi.merge_tolerance));
    line("endpoints.mode", modes_text(o.endpoints.mode));
    line("endpoints.inlets", points_text(o.endpoints.inlets));
    line("endpoints.outlets", points_text(o.endpoints.outlets));
    std::string rules;
    for (const InletRule& rule : o.endpoints.inlet_rules) rules += rule_text(rule) + ";";
    line("endpoints.inlet", rules);
    line("endpoints.tip_length", exact_text(o.endpoints.tip_length));
    line("centerlines.refine", refinement_name(o.trace.refine));
    line("centerlines.pairs", pairs_name(o.trace.pairs));
    line("centerlines.join", join_name(o.trace.join));
    line("centerlines.topology", topology_name(o.trace.topology));
    line("characterize", o.characterize ? "true" : "false");
    flag("branches.enabled", o.branches.enabled);
    line("branches.step", exact_text(o.branches.step));
    line("branches.smoothing", exact_text(o.branches.smoothing));
    line("branches.section_step", exact_text(o.branches.section_step));
    line("branches.patches_along", std::to_string(o.branches.patches_along));
    line("branches.patches_around", std::to_string(o.branches.patches_around));
    return text;
}

std::string_view fields_name(ArchiveFields fields) {
    return fields == ArchiveFields::kAll ? "all" : fields == ArchiveFields::kSurface ? "surface" : "lines";
}

}  // namespace lumenline
