#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/model_record.h"
#include "engine/schedule/run_models.h"

namespace lumenline {

/// What became of a model in a worker.
struct IsolatedResult {
    std::string reply;               ///< what the worker said when it was done
    std::optional<Failure> failure;  ///< it did not get so far: its process crashed or was ended
    std::string source_sha256 = {};  ///< of the surface that a process that failed had read; empty = it had not
    double seconds = 0;              ///< since the model was given to the worker
};

/// How the models of a run reach its workers. All are called by the calling thread.
struct IsolatedHandlers {
    std::vector<std::string> worker;  ///< arguments that make this program a worker
    /// What a worker is to be told of a model, and how many threads it may use.
    std::function<std::string(const ModelTask&, int threads)> request;
    /// Takes what became of a model, in the order of completion. What it throws ends the run.
    std::function<ModelStatus(const ModelTask&, IsolatedResult&&)> done;
};

/// As run_models, but each model is computed and stored by a worker process. A worker that crashes fails its model with
/// the code kCrashed, and one whose model is beyond `model_timeout` is ended and fails it with kTimeout, whatever it
/// does at that moment; the other models complete. As many models are computed at once as there are threads; a model
/// that has few or none beside it gets the threads that are left. Workers that write have no share in this. When the
/// run is stopped, workers are ended at once. To be called from a thread that lives as long as the process: workers end
/// with it.
/// @param options  model_memory and on_stage are for the workers to heed
/// @throws std::system_error if workers cannot be started; what the handlers throw
RunReport run_isolated(std::span<const ModelTask> tasks, const ScheduleOptions& options,
                       const IsolatedHandlers& handlers);

}  // namespace lumenline
