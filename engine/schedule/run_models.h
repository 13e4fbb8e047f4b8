#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "engine/core/model_record.h"
#include "engine/core/options.h"
#include "engine/schedule/model_job.h"

namespace lumenline {

/// Options of run_models. They never change a result.
struct ScheduleOptions {
    int threads = 0;                               ///< 0 = all cores this process may use
    int models_in_flight = 0;                      ///< models in memory at once; 0 = one more than twice the threads
    const std::atomic<bool>* cancelled = nullptr;  ///< set from outside to stop the run
    /// Bytes for the models in flight, by their estimates; 0 = no bound. A model that needs more runs alone.
    double memory = 0;
    std::function<double(const ModelTask&)> memory_of;  ///< estimated need of a model [bytes]; null = nothing
    /// The same of a model of so many sites, put in its place when they are known; null = the estimate stands.
    std::function<double(double)> refined_memory_of;
    double model_timeout = 0;  ///< work on one model after which no further stage of it begins [s]; 0 = none
    double model_memory = 0;   ///< estimated need after conditioning with which a model fails [bytes]; 0 = none
    std::function<void(const ModelTask&, Stage)> on_stage;  ///< called as each stage begins, from any thread
};

/// Takes a finished record, in the order of completion; called by one thread at a time. What it
/// throws ends the run.
using Sink = std::function<void(ModelRecord&&)>;

/// What became of the models of a run.
struct RunReport {
    std::size_t ok = 0, warning = 0, failed = 0;  ///< handed to the sink
    std::size_t interrupted = 0;                  ///< started, but the run was stopped
    std::size_t not_started = 0;                  ///< the run was stopped before
    double seconds = 0;
    int threads = 1;
};

/// Computes all models on a oneTBB flow graph: a node per stage, a task per source, bounds on number and memory of
/// the models in flight, one serial writer. Models are started in the order given (longest first makes the tail
/// short), but while one waits for memory, smaller ones behind it may start, until it has been passed by as many as
/// may be in flight. A model that fails is a record with its failure and harms no
/// other. Results do not depend on the number of threads.
/// @throws std::logic_error if a model got lost (a broken promise of ours), and what the sink throws
RunReport run_models(std::span<const ModelTask> tasks, const ScheduleOptions& options, const Loader& loader,
                     const Sink& sink);

/// Estimated memory of each task; nothing without an estimate [bytes].
std::vector<double> needs_of(std::span<const ModelTask> tasks, const ScheduleOptions& options);

/// The number of threads that `threads` = 0 stands for.
int available_threads();

}  // namespace lumenline
