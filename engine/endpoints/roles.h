#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/core/endpoints.h"
#include "engine/core/options.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline {

/// The candidate that a rule picks; none where the rule asks for an opening that is not among them. Equal
/// candidates go by position.
/// @param candidates  indices into `ends`, at least one; the rule is not of kind kPoint
/// Warns inlet_not_clear when the largest is less than 1.2 times the second.
std::optional<std::size_t> pick_inlet(const Endpoints& ends, const std::vector<std::size_t>& candidates,
                                      const InletRule& rule, StageContext& context);

/// Length of the way along the wall's edges to each endpoint from the nearest inlet; +inf = none. An opening
/// is reached at its loop, any other end at the sites around its anchor.
/// @cost O(N log N), a fifth of that of paths over the complex
std::vector<double> wall_distances(const Surface& surface, const Endpoints& inlets, const Endpoints& ends);

/// Cost of the path to each endpoint from the nearest inlet; +inf = unreached.
std::vector<double> costs_from(const VoronoiComplex& complex, const Endpoints& inlets, const Endpoints& ends,
                               StageContext& context);

/// Puts endpoints in the order that does not depend on the mesh: by cost, then radius, then position.
void sort_by_cost(Endpoints& endpoints, const std::vector<double>& cost);

}  // namespace lumenline
