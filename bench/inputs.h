#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/options.h"
#include "engine/core/soup.h"
#include "engine/phantom/phantom.h"

namespace lumenline::bench {

/// A surface to measure on.
struct Input {
    std::string name;
    TriangleSoup soup;
    PipelineOptions options;
    std::optional<PhantomTruth> truth;  ///< of phantoms
    double edge_length = 0;             ///< of phantoms [length]
};

/// Names that find_input knows: cylinder_3k to cylinder_400k, and the surfaces of examples/.
std::vector<std::string> known_inputs();

/// What is measured when nothing is named: the surface of LUMENLINE_BENCH_SURFACE if that is set,
/// else all known inputs; those above 100,000 sites only if LUMENLINE_BENCH_LARGE is set.
std::vector<std::string> default_inputs();

/// A known input, or else the surface file of that path, its endpoints found by themselves. Either is
/// subdivided LUMENLINE_BENCH_SUBDIVIDE times (0 to 3).
/// @throws StageError when the file cannot be read; std::runtime_error for a bad number of subdivisions
Input find_input(const std::string& name);

/// `soup` with every coordinate moved by a thousandth of the mean edge at most: another model of equal cost.
TriangleSoup jittered(const TriangleSoup& soup, std::uint64_t seed);

}  // namespace lumenline::bench
