#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace lumenline {

/// Adds the verb `export ARCHIVE --to vtp|csv -o DIR [--model ID]` to the command line.
void add_export(CLI::App& app, std::function<int()>& action);

}  // namespace lumenline
