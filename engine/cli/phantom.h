#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace lumenline {

/// Adds the verb `phantom KIND -o FILE` to the command line. When it is given, parsing sets
/// `action` to what is to run afterwards: it writes the surface (and the truth) and returns the
/// exit status, 0, 1 when a file could not be written, or 2, after one sentence on standard error,
/// when an option does not belong to the kind or the geometry is impossible.
void add_phantom(CLI::App& app, std::function<int()>& action);

}  // namespace lumenline
