#pragma once

#include <span>
#include <string>
#include <vector>

#include "config/cohort.h"
#include "io/archive/index.h"

namespace lumenline {

/// What a run has to do with a model, and why.
struct PlannedModel {
    enum class Action {
        kRun,     ///< it has no result that stands
        kDone,    ///< its file stands with the same inputs
        kFailed,  ///< the same inputs failed before, and would again
    };
    const ModelTask* task = nullptr;
    Action action = Action::kRun;
    std::string reason;               ///< for kRun and kFailed; a part of a sentence
    std::string source_sha256;        ///< of the surface's file now; empty if it was not asked for, or cannot be read
    std::optional<ModelState> state;  ///< of the model's file, where it can be read
};

/// Holds each task against the archive. A model is done if its file has the same `inputs_sha256`; times of files play
/// no part. A failure stands like a result, unless it is transient or `retry_failed` is set.
/// @cost reads and hashes the surfaces of the models that have a file, on `threads` threads (0 = all cores)
std::vector<PlannedModel> plan_models(const ArchiveSettings& archive, std::span<const ModelTask* const> tasks,
                                      bool retry_failed, int threads);

/// The tasks of a cohort named by `only` in the order of the cohort; all if it is empty.
/// @throws CLI::ValidationError if there is no such model
std::vector<const ModelTask*> select_tasks(const CohortConfig& config, const std::vector<std::string>& only);

/// Row of a model in the index: the numbers of its file, and what the configuration says of it now.
/// Empty if there is no file, or (with a line on standard error) it cannot be used.
std::optional<ModelSummary> index_row(const ArchiveSettings& archive, const ModelTask& task);

/// `row` with subject, group, covariates and the like as `task` states them.
ModelSummary with_labels(ModelSummary row, const ModelTask& task);

}  // namespace lumenline
