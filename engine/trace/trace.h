#pragma once

#include <memory>
#include <span>

#include "engine/core/arrival_field.h"
#include "engine/core/centerlines.h"
#include "engine/core/endpoints.h"
#include "engine/core/options.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline {

/// Centerlines of all targets by steepest descent of the arrival times (Antiga et al. 2003, end of
/// section 2.1), relaxed on the complex, moved to the axis of the curved surface, cut at the openings'
/// planes, and verified. A refined line that leaves the lumen or is no better by its own measure is
/// dropped for its path, with the note line_not_refined.
///
/// On a surface of genus > 0 the loops of the lumen are found (loops.h) and reported: loop_not_covered for a tree. For
/// a network each gets two lines from its source, down its two sides to one common point, made like the others; if one
/// of them has to be left out both are.
///
/// A target that no front reached, and a line that would leave the lumen, are errors of that target
/// (diagnostics target_unreached, line_leaves_lumen): the line is left out, never replaced. What of
/// the lumen and of the inlets has no line is a warning (coverage.h).
/// @param fields  one per source, each with its source set
/// @returns lines ordered by target, then source; after them those of loops, in the order of the loops
/// @throws StageError kNoLineTraced when not one target has a line
/// @cost O(path length) per line, and one distance query per point
Centerlines trace_centerlines(const Surface& surface, const VoronoiComplex& complex, const Endpoints& endpoints,
                              std::span<const std::shared_ptr<const ArrivalField>> fields, const TraceOptions& options,
                              StageContext& context);

}  // namespace lumenline
