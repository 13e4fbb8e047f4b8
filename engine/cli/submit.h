#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace lumenline {

/// Adds the verb `submit COHORT.yaml --tasks N`: a Slurm array of shards and a merge behind it.
void add_submit(CLI::App& app, std::function<int()>& action);

}  // namespace lumenline
