#pragma once

#include <span>

#include "engine/core/arrival_field.h"
#include "engine/core/endpoints.h"
#include "engine/core/stage_context.h"
#include "engine/core/voronoi_complex.h"
#include "engine/geometry/polygon_march.h"

namespace lumenline {

/// Every vertex of this number is looked at for the residual that a field carries.
inline constexpr std::size_t kResidualStride = 32;

/// Scratch of solve_eikonal; reusable from call to call, one per concurrent solve.
using EikonalWorkspace = MarchWorkspace;

/// First arrival time T of a front that leaves the seeds at speed R.
///
/// |grad T| = 1/R on the Voronoi polygons (Antiga et al. 2003, eq. 5) by Fast Marching extended to
/// polygonal non-manifolds: when a vertex is accepted, every polygon around it offers its other
/// vertices an arrival straight from it and across its two edges there (edge_update.h). Vertices whose
/// time is improved after they were accepted are taken up again, until the field is at the fixed
/// point of its update: up to 1e-7 of the time, up to 1e-4 among the tiny polygons on the axis of
/// exactly round tubes, where the start of a ray moves when an edge's end is improved.
/// @param complex  embedded Voronoi diagram
/// @param seeds    vertices with times >= 0, fixed before marching
/// @returns T per Voronoi vertex, dimensionless; +inf where unreachable; with the residual of the update
/// @throws StageError kNoSeed when seeds is empty
/// @cost O(V log V); 2-3 us per site
ArrivalField solve_eikonal(const VoronoiComplex& complex, std::span<const Seed> seeds, EikonalWorkspace& work,
                           StageContext& context);

/// How far a field is from the fixed point of its update: the largest |T(v) - U(v)| / T(v), U(v) the
/// least arrival that any earlier vertex or edge of a polygon around v offers, or the seed's time. A
/// time without a cause shows as much as one that is too late.
/// @param stride  looks at every stride-th vertex only
/// @cost half a march, divided by the stride
double eikonal_residual(const VoronoiComplex& complex, std::span<const double> time, std::span<const Seed> seeds,
                        std::size_t stride = 1);

}  // namespace lumenline
