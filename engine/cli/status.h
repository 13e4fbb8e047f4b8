#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace lumenline {

/// Adds the verb `status COHORT.yaml`: what of a cohort is done, failed and left, and who computes.
void add_status(CLI::App& app, std::function<int()>& action);

/// Adds the verb `merge COHORT.yaml`: makes the index anew from the model files.
void add_merge(CLI::App& app, std::function<int()>& action);

}  // namespace lumenline
