// The stage's steps in order; each is a function of its own.
#include "engine/branches/branches.h"

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
    return result;
}

}  // namespace lumenline
