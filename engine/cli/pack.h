#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace lumenline {

/// Adds the verb `pack ARCHIVE -o FILE` (an archive in one file) to the command line.
void add_pack(CLI::App& app, std::function<int()>& action);

}  // namespace lumenline
