#pragma once

#include <functional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "engine/core/soup.h"

namespace lumenline::mutation {

/// What may become of a damaged surface.
struct Expected {
    bool repaired = false;           ///< exit 0 and the clean surface's lines, within the tolerance
    bool other_lines = false;        ///< exit 0, other lines, and a warning: damage that changes the lumen itself
    std::set<std::string> failures;  ///< failure codes that are right
};

/// One way to damage a surface, or a surface that is none.
struct Damage {
    std::string name;
    std::string format;  ///< extension of the file: stl, ply, obj, off, vtk, vtp
    Expected expected;
    /// The bytes of the damaged file.
    std::function<std::string(const TriangleSoup& clean, std::mt19937& random)> make;
};

/// All damages, at least forty. The same list for every surface.
const std::vector<Damage>& all_damages();

}  // namespace lumenline::mutation
