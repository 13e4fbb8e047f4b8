#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace lumenline {

/// Adds the verb `validate-archive ARCHIVE` to the command line.
void add_validate_archive(CLI::App& app, std::function<int()>& action);

}  // namespace lumenline
