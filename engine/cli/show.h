#pragma once

#include <iosfwd>

#include "io/archive/read.h"

namespace lumenline {

/// Prints who a model is and what was found: attributes, endpoints, lines, the radius along each branch,
/// characterization and diagnostics.
/// @throws ArchiveError where parts of the file contradict each other
void show_model(const ArchiveFile& file, std::ostream& out);

}  // namespace lumenline
