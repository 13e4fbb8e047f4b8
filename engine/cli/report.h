#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace lumenline {

/// Adds the verb `report ARCHIVE -o report.html` to the command line.
void add_report(CLI::App& app, std::function<int()>& action);

}  // namespace lumenline
