#pragma once

#include "engine/core/soup.h"

namespace lumenline::bench {

/// `soup` after `levels` steps of Loop subdivision (OpenMesh), four times the triangles each.
/// @throws std::runtime_error when the triangles are no oriented manifold
TriangleSoup loop_subdivided(const TriangleSoup& soup, int levels);

}  // namespace lumenline::bench
