#pragma once

#include <vector>

#include "engine/condition/opening_plan.h"
#include "engine/core/condition_options.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"

namespace lumenline {

/// The wall with everything that closes it.
struct ClosedSurface {
    Surface surface;                       ///< points, triangles, input_vertex, origin, cap, openings
    std::vector<std::uint32_t> component;  ///< (N) of each site
};

/// Closes all openings. Each is extended by `extension_radii` of its radii, half as far, or not at all,
/// whichever is the first that runs into nothing.
/// Warns (extension_shortened, extension_blocked, crooked_opening).
/// @param blocked  openings that must not be extended
/// @throws StageError kOpenBoundary for a loop that nothing closes; kTooLarge
ClosedSurface close_wall(const WallMesh& wall, const std::vector<std::uint32_t>& component,
                         const std::vector<OpeningPlan>& plans, double extension_radii,
                         const std::vector<char>& blocked, StageContext& context);

}  // namespace lumenline
