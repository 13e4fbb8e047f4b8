#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace lumenline {

/// Adds the verb `stats` (statistics of an archive's tables by group) to the command line.
void add_stats(CLI::App& app, std::function<int()>& action);

}  // namespace lumenline
