#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace lumenline {

/// Adds `table` to the verb `phantom`: measures lines through phantoms against their truth and prints
/// the paper's Tables 1 and 2 beside Lumenline's figures, and tables of noise and of the characterization
/// of the wall. Parsing sets `action`.
void add_phantom_table(CLI::App& phantom, std::function<int()>& action);

}  // namespace lumenline
