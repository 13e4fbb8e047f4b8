#pragma once

#include <string_view>

namespace lumenline {

/// Version of the program, "major.minor.patch".
std::string_view version();

/// Short hash of the commit it was built from, "-dirty" appended where files differed; "unknown"
/// outside of a git checkout.
std::string_view build_commit();

/// Name and version of the compiler.
std::string_view build_compiler();

}  // namespace lumenline
