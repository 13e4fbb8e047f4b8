#pragma once

#include <span>
#include <vector>

#include "engine/core/surface.h"
#include "engine/core/surface_character.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline {

/// A third of the area of the wall's triangles around each site [length^2].
std::vector<double> wall_area_per_site(const Surface& surface);

/// Distribution of `values` weighted by `weights`; sites with weight 0 or value NaN do not count.
/// @cost O(N log N)
AreaStatistics area_statistics(std::span<const double> values, std::span<const double> weights);

/// Fills wall_area, wall_sites, unreached and the statistics from the arrays per site and the zones.
void summarize_wall(const Surface& surface, SurfaceCharacter& character);

/// Counts the jumps (JumpCounts) along the edges of the wall. @cost O(triangles)
JumpCounts count_jumps(const Surface& surface, const VoronoiComplex& complex, const SurfaceCharacter& character);

}  // namespace lumenline
