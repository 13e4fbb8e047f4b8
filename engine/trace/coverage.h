#pragma once

#include <memory>
#include <span>

#include "engine/core/arrival_field.h"
#include "engine/core/centerlines.h"
#include "engine/core/endpoints.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline {

/// Warns of what has no line: inlets that are the source of none (inlet_without_line); parts of the lumen that no front
/// reached (wall_unreached), and vessels that one reached but no line comes near (wall_without_line), both from half a
/// percent of the wall on. Of a lumen without any line only the second is said.
/// @cost sites times points of the lines a radius apart
void report_coverage(const Surface& surface, const VoronoiComplex& complex, const Endpoints& endpoints,
                     std::span<const std::shared_ptr<const ArrivalField>> fields, const Centerlines& lines,
                     StageContext& context);

}  // namespace lumenline
