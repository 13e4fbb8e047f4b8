#pragma once

#include "engine/core/model_record.h"
#include "io/archive/writer.h"

namespace lumenline {

/// Writes `/VTKHDF`: the surface's triangles, if it is to have them, and the centerlines as one unstructured grid that
/// ParaView 5.11 and VTK 9.1 open. Writes nothing where there is neither.
/// @throws hdf::Error
void write_vtkhdf(hdf::Writer& writer, const ModelRecord& record, bool with_surface);

}  // namespace lumenline
