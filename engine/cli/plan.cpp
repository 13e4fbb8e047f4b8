// The archive's files are read one after the other, since HDF5 admits one thread; the surfaces, which are many times
// larger, are hashed on all of them. A surface whose model has no file is not read at all.

#include "engine/cli/plan.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <set>
#include <utility>

#include "engine/cli/model_io.h"
#include "engine/schedule/parallel_each.h"
#include "io/archive/model_file.h"
#include "io/mesh/sha256.h"

namespace lumenline {

namespace {

/// What can be said without the surface's bytes; `reason` stays empty where they decide.
void look_at_file(const ArchiveSettings& archive, PlannedModel& model) {
    const std::string& id = model.task->identity.id;
    try {
        model.state = read_state(model_path(archive.directory, id));
        if (!model.state) model.reason = "it has no file yet";
    } catch (const ArchiveError& error) {
        model.reason = fmt::format("its file cannot be used: {}", error.what());
    }
    if (model.state && model.state->id != id)
        model.reason = fmt::format("its file is that of the model '{}'", model.state->id);
}

void compare(const ArchiveSettings& archive, bool retry_failed, PlannedModel& model) {
    const ModelState& state = *model.state;
    if (inputs_digest(*model.task, model.source_sha256, archive.options) != state.inputs_sha256) {
        model.reason = model.source_sha256 != state.source_sha256 ? "its surface has changed"
                                                                  : "options, format or program have changed";
        return;
    }
    if (!state.failure) {
        model.action = PlannedModel::Action::kDone;
        return;
    }
    const std::string failed =
        fmt::format("it failed in {} ({})", stage_name(state.failure->stage), error_name(state.failure->code));
    if (is_transient(*state.failure)) {
        model.reason = failed + ", which need not happen again";
    } else if (retry_failed) {
        model.reason = failed + " and is to be tried again";
    } else {
        model.reason = failed;
        model.action = PlannedModel::Action::kFailed;
    }
}

}  // namespace

std::vector<PlannedModel> plan_models(const ArchiveSettings& archive, std::span<const ModelTask* const> tasks,
                                      bool retry_failed, int threads) {
    std::vector<PlannedModel> plan(tasks.size());
    std::vector<PlannedModel*> to_compare;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        plan[i].task = tasks[i];
        look_at_file(archive, plan[i]);
        if (plan[i].reason.empty()) to_compare.push_back(&plan[i]);
    }
    parallel_each(threads, to_compare.size(), [&](std::size_t i) {
        if (StopOnSignal::flag()->load()) return;
        to_compare[i]->source_sha256 = sha256_of_file(to_compare[i]->task->surface_path);
    });
    for (PlannedModel* model : to_compare) compare(archive, retry_failed, *model);
    return plan;
}

std::vector<const ModelTask*> select_tasks(const CohortConfig& config, const std::vector<std::string>& only) {
    const std::set<std::string> wanted(only.begin(), only.end());
    std::set<std::string> found;
    std::vector<const ModelTask*> chosen;
    for (const ModelTask& task : config.tasks) {
        if (!only.empty() && !wanted.contains(task.identity.id)) continue;
        found.insert(task.identity.id);
        chosen.push_back(&task);
    }
    for (const std::string& id : wanted)
        if (!found.contains(id)) throw CLI::ValidationError("--only", "the cohort has no model '" + id + "'");
    return chosen;
}

std::optional<ModelSummary> index_row(const ArchiveSettings& archive, const ModelTask& task) {
    const std::filesystem::path file = model_path(archive.directory, task.identity.id);
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return std::nullopt;
    try {
        ModelSummary row = read_summary(file);
        if (row.identity.id == task.identity.id) return with_labels(std::move(row), task);
        fmt::print(stderr, "{}: its file is that of the model '{}'; it is left out of the index\n", task.identity.id,
                   row.identity.id);
    } catch (const std::exception& damaged) {
        fmt::print(stderr, "{}: {}; it is left out of the index\n", task.identity.id, damaged.what());
    }
    return std::nullopt;
}

ModelSummary with_labels(ModelSummary row, const ModelTask& task) {
    ModelIdentity who = task.identity;
    // What the file's numbers were made from.
    who.source_sha256 = row.identity.source_sha256;
    who.inputs_sha256 = row.identity.inputs_sha256;
    who.length_unit = row.identity.length_unit;
    who.coordinate_system = row.identity.coordinate_system;
    row.identity = std::move(who);
    return row;
}

}  // namespace lumenline
