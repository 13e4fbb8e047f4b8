#pragma once

#include <functional>
#include <string>
#include <vector>

#include "config/cohort.h"
#include "engine/core/model_record.h"
#include "engine/schedule/run_isolated.h"

namespace CLI {
class App;
}

namespace lumenline {

/// Arguments that make this program a worker of a run.
std::vector<std::string> worker_arguments(const RunOptions& run);

/// What a worker is told of a model: all that it needs, so that it reads no configuration.
std::string worker_request(const CohortConfig& config, const ModelTask& task, int threads);

/// Row of a model that a worker has computed and stored. For one that it has not, the failure is stored here.
ModelSummary settle(const IsolatedResult& result, const ModelTask& task, const ArchiveSettings& archive);

/// Adds the verb `worker`, which no one but a run calls.
void add_worker(CLI::App& app, std::function<int()>& action);

}  // namespace lumenline
