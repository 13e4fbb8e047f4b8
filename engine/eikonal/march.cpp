// Symbols of the paper: T = time, F = 1/R = the cost, R = ball radius (eq. 5). The march itself is shared with
// |grad T| = 1: geometry/polygon_march.h.
#include "engine/eikonal/eikonal.h"
#include "engine/geometry/polygon_march.h"

namespace lumenline {

ArrivalField solve_eikonal(const VoronoiComplex& complex, std::span<const Seed> seeds, EikonalWorkspace& work,
                           StageContext& context) {
    if (seeds.empty())
        throw StageError(Stage::kEikonal, ErrorCode::kNoSeed, "a front needs at least one vertex to start from");
    PolygonMarch<InverseRadiusMetric> march(complex, work);
    for (const Seed& s : seeds) march.seed(s.vertex, s.time);
    ArrivalField field;
    field.reached = march.run(context);
    field.time = work.time;
    field.residual = eikonal_residual(complex, field.time, seeds, kResidualStride);
    return field;
}

}  // namespace lumenline
