// The stage's steps in order; each is a function of its own.
#include "engine/branches/branches.h"

#include <algorithm>
#include <cmath>

#include "engine/branches/axes.h"
#include "engine/branches/calibre.h"
#include "engine/branches/graph.h"
#include "engine/branches/junctions.h"
#include "engine/branches/measures.h"
#include "engine/branches/partings.h"
#include "engine/branches/sections.h"
#include "engine/branches/split.h"
#include "engine/branches/wall.h"
#include "engine/core/text.h"

namespace lumenline {

namespace {

void report(const Split& split, const Branches& found, StageContext& context) {
    std::size_t contained = 0, without = 0;
    for (const ContainedLine& c : split.contained) contained += c.in != ContainedLine::kNone ? 1 : 0;
    for (const double length : found.table.own_length) without += length > 0 ? 0 : 1;
    if (contained > 0)
        context.note(
            "line_within_another",
            counted(contained, "line") + " run to their end in the tube of another one and have no branch of their own",
            static_cast<double>(contained));
    if (without > 0)
        context.note("branch_without_own_part",
                     counted(without, "branch") +
                         " lie in junctions from end to end: their measures along the axis are not known",
                     static_cast<double>(without));
}

std::size_t missing(const std::vector<double>& values) {
    return static_cast<std::size_t>(
        std::count_if(values.begin(), values.end(), [](double v) { return std::isnan(v); }));
}

std::vector<double> means(const std::vector<Distribution>& values) {
    std::vector<double> result;
    for (const Distribution& d : values) result.push_back(d.mean);
    return result;
}

/// What is NaN for want of something, not by its definition (as the torsion of a straight vessel is).
void report_missing(const Branches& found, StageContext& context) {
    std::size_t total = 0;
    std::string text;
    const auto count = [&](const std::vector<double>& values, const char* measure, const char* why) {
        const std::size_t rows = missing(values);
        if (rows == 0) return;
        total += rows;
        text.append(text.empty() ? "" : ", ").append(measure).append(" ").append(std::to_string(rows));
        text.append(" (").append(why).append(")");
    };
    const BranchTable& t = found.table;
    count(means(t.radius), "radius", "no own part");
    count(t.taper, "taper", "own part of fewer than two points");
    count(means(t.area), "area", "no closed section");
    count(means(t.curvature), "curvature", "no own part");
    if (!found.surface.branch.empty()) count(t.volume, "volume and means over the wall", "no wall belongs to it");
    count(found.stenoses.ecst_diameter, "ECST degree and dilation", "own part too short for a fit");
    count(found.stenoses.nascet_diameter, "NASCET degree", "nothing distal to the narrowest place");
    count(found.bifurcations.planarity, "planarity", "children without own part, or straight on from each other");
    count(found.bifurcations.area_ratio, "area ratio", "a branch without own part");
    count(found.bifurcations.murray_exponent, "Murray exponent", "a child as wide as its parent");
    if (total > 0) context.note("measures_not_known", "not known and NaN: " + text, static_cast<double>(total));
}

}  // namespace

Branches find_branches(const Surface& surface, const Centerlines& centerlines, const SurfaceCharacter* character,
                       const BranchOptions& options, StageContext& context) {
    const std::vector<LineView> views = views_of(centerlines);
    const Split split = split_lines(centerlines, views, context);
    GraphDraft draft = make_graph(split, centerlines, views);
    Branches result;
    result.lines = make_axes(draft, views, options);
    result.points = branches_of_points(draft.pieces, result.lines, views);
    result.table = measure_axes(draft, result.lines);
    measure_junctions(draft, result.lines, result.bifurcations, result.children);
    result.graph = std::move(draft.graph);
    result.pieces = std::move(draft.pieces);
    if (character != nullptr) {
        result.surface = coordinates_of(surface, *character, result, context);
        measure_wall(surface, *character, result, result.surface, result.table);
        result.patches = measure_patches(surface, *character, result, result.surface, options);
    }
    result.sections = cut_sections(surface, result, result.surface, options, context);
    measure_areas(result.sections, result.table);
    result.stenoses = find_stenoses(result, result.sections);
    result.dilations = find_dilations(result);
    report(split, result, context);
    report_missing(result, context);
    return result;
}

}  // namespace lumenline
