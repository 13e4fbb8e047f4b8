#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/model_record.h"
#include "engine/core/options.h"

namespace lumenline::examples {

/// The repository's examples/.
std::filesystem::path folder();

/// Tasks of examples/cohort.yaml.
std::vector<ModelTask> example_tasks();

/// All stages of a task, in this thread.
ModelRecord compute(const ModelTask& task);

/// The example of that id, computed.
ModelRecord compute(const std::string& id);

}  // namespace lumenline::examples
