#pragma once

#include <string>

#include "engine/core/centerlines.h"
#include "engine/core/model_record.h"

namespace lumenline::test {

/// What a network breaks of its promises: each loop has two lines, which end in its point, whose lines start at
/// different sides of it, the first at its source; every other line has a target; all within the lumen.
/// @returns empty if nothing
std::string network_fault(const Centerlines& lines);

/// Largest distance from a site of the wall to the lines, in the radius of the line there: about 1 for tubes whose
/// every part has a line. Sites of extensions, caps and end zones are left out.
double largest_distance_to_lines(const ModelRecord& record);

}  // namespace lumenline::test
