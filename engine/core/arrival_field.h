#pragma once

#include <cstddef>
#include <vector>

#include "engine/core/ids.h"

namespace lumenline {

/// First arrival time T of a front that left one source (Antiga et al. 2003, eq. 5).
struct ArrivalField {
    EndpointId source;
    std::vector<double> time;  ///< (V) T, dimensionless: cost 1/R [1/length] times length; +inf = unreached
    std::size_t reached = 0;   ///< vertices with a finite time
    /// Largest |T(v) - U(v)| / T(v), U(v) the best update of v from its polygons: how far the field is
    /// from the fixed point of its update. Over every 32nd vertex: looking at all costs half a march.
    double residual = 0;
};

}  // namespace lumenline
