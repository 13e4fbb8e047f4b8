#pragma once

#include <memory>
#include <vector>

#include "bench/inputs.h"
#include "engine/core/arrival_field.h"
#include "engine/core/branch_tables.h"
#include "engine/core/centerlines.h"
#include "engine/core/endpoints.h"
#include "engine/core/surface.h"
#include "engine/core/surface_character.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline::bench {

using Fields = std::vector<std::shared_ptr<const ArrivalField>>;

/// All that the stages make of one surface.
struct Solved {
    VoronoiComplex complex;
    Endpoints endpoints;
    Fields fields;
    Centerlines lines;
    SurfaceCharacter character;  ///< empty until characterize is called
};

/// The stages, one after the other in this thread, as the scheduler calls them.
Surface condition(const Input& input);
VoronoiComplex voronoi(const Surface& surface, const PipelineOptions& options);
Endpoints endpoints(const Surface& surface, const VoronoiComplex& complex, const PipelineOptions& options);
Fields eikonal(const VoronoiComplex& complex, const Endpoints& ends);
Centerlines trace(const Surface& surface, const Solved& solved, const PipelineOptions& options);
SurfaceCharacter characterize(const Surface& surface, const Solved& solved);
Branches branches(const Surface& surface, const Solved& solved, const PipelineOptions& options);
Solved solve(const Surface& surface, const PipelineOptions& options);

/// Is the answer worth timing? Every outlet has its line, every field is at the fixed point of its
/// update, and a phantom's lines keep within one edge of its axis.
/// @throws std::runtime_error that names what is wrong
void verify(const Input& input, const Solved& solved);

}  // namespace lumenline::bench
