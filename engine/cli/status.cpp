// Status asks the model files alone, so it is the same while runs write, between them, and from any machine; the index
// saves opening those that have not changed since it was made. It does not read surfaces: that one has changed since is
// for the next run (or its --dry-run) to find.
#include "engine/cli/status.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>

#include "config/cohort.h"
#include "engine/cli/estimates.h"
#include "engine/cli/lease_wait.h"
#include "engine/cli/make_index.h"
#include "engine/cli/model_io.h"
#include "engine/cli/plan.h"
#include "engine/cli/run.h"
#include "engine/cli/slurm.h"
#include "engine/cli/standard_output.h"
#include "engine/cli/table.h"
#include "engine/core/text.h"
#include "engine/schedule/run_models.h"
#include "io/archive/index.h"
#include "io/archive/model_file.h"

namespace lumenline {

namespace {

struct FailedModel {
    std::string id;
    Failure failure;
};

struct PendingModel {
    std::string id, reason;
};

struct Status {
    std::map<ModelStatus, std::size_t> counts;
    std::vector<FailedModel> failed;
    std::vector<PendingModel> pending;
    std::vector<LeaseHolder> runs;
    std::vector<SlurmTask> slurm;  ///< in its queue
    double seconds_left = 0;       ///< of work, in one thread
};

ModelState state_of(const ModelSummary& row) {
    return {row.identity.id, row.status, row.identity.source_sha256, row.identity.inputs_sha256,
            row.failure,     row.seconds};
}

/// Why a model has no result that stands, as far as its file tells; empty = it has one.
std::string pending_reason(const CohortConfig& config, const ModelTask& task, const std::optional<ModelState>& state) {
    if (!state) return "no file yet";
    if (state->id != task.identity.id) return "its file is that of another model";
    if (inputs_digest(task, state->source_sha256, config.archive.options) != state->inputs_sha256)
        return "options, format or program have changed";
    if (state->failure && is_transient(*state->failure))
        return fmt::format("failed in {} ({}), to be tried again", stage_name(state->failure->stage),
                           error_name(state->failure->code));
    return "";
}

/// Work on the models that are left, by what those that are done have taken.
double seconds_left(const std::vector<const ModelTask*>& left, const std::vector<const ModelTask*>& done,
                    double seconds_of_done) {
    if (left.empty()) return 0;
    const double estimated_left = Estimates(left).total(left, {}).seconds;
    const double estimated_done = Estimates(done).total(done, {}).seconds;
    return estimated_done > 0 ? estimated_left * seconds_of_done / estimated_done : estimated_left;
}

Status read_status(const CohortConfig& config) {
    Status status;
    std::vector<const ModelTask*> left, done;
    double seconds_of_done = 0;
    const std::map<std::string, ModelSummary> unchanged = read_unchanged_rows(config.archive.directory);
    for (const ModelTask& task : config.tasks) {
        const std::string& id = task.identity.id;
        std::optional<ModelState> state;
        std::string reason;
        try {
            const auto known = unchanged.find(id);
            state = known != unchanged.end() && !known->second.failure
                        ? state_of(known->second)
                        : read_state(model_path(config.archive.directory, id));
            reason = pending_reason(config, task, state);
        } catch (const ArchiveError& error) {
            reason = fmt::format("its file cannot be used: {}", error.what());
        }
        if (!reason.empty()) {
            status.pending.push_back({id, reason});
            left.push_back(&task);
            continue;
        }
        ++status.counts[state->status];
        if (state->failure) status.failed.push_back({id, *state->failure});
        done.push_back(&task);
        seconds_of_done += state->seconds;
    }
    status.runs = read_leases(config.archive.directory);
    status.slurm = queued_tasks(config.archive.directory);
    status.seconds_left = seconds_left(left, done, seconds_of_done);
    return status;
}

int exit_status(const Status& status) {
    if (!status.pending.empty()) return kStopped;
    return status.failed.empty() ? kDone : kModelFailed;
}

void print_json(std::ostream& out, const CohortConfig& config, Status& status) {
    using nlohmann::ordered_json;
    ordered_json json{{"cohort", config.name},
                      {"archive", config.archive.directory.string()},
                      {"models", config.tasks.size()},
                      {"ok", status.counts[ModelStatus::kOk]},
                      {"warning", status.counts[ModelStatus::kWarning]},
                      {"failed", status.failed.size()},
                      {"pending", status.pending.size()},
                      {"seconds_left", status.seconds_left},
                      {"runs", ordered_json::array()},
                      {"slurm", ordered_json::array()},
                      {"failures", ordered_json::array()},
                      {"pending_models", ordered_json::array()}};
    for (const LeaseHolder& run : status.runs)
        json["runs"].push_back({{"shard", run.shard.index},
                                {"of", run.shard.count},
                                {"host", run.host},
                                {"process", run.process},
                                {"since", run.since},
                                {"heartbeat_age", run.heartbeat_age},
                                {"alive", run.alive}});
    for (const SlurmTask& task : status.slurm)
        json["slurm"].push_back({{"job", task.job},
                                 {"shard", task.shard},
                                 {"state", task.state},
                                 {"reason", task.reason},
                                 {"node", task.node}});
    for (const FailedModel& model : status.failed)
        json["failures"].push_back({{"id", model.id},
                                    {"stage", stage_name(model.failure.stage)},
                                    {"code", error_name(model.failure.code)},
                                    {"sentence", model.failure.sentence}});
    for (const PendingModel& model : status.pending)
        json["pending_models"].push_back({{"id", model.id}, {"reason", model.reason}});
    // What is no UTF-8 is replaced: file names may hold anything.
    out << json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
}

/// A line for each of the first jobs in Slurm's queue.
void print_queue(std::ostream& out, const std::vector<SlurmTask>& tasks) {
    constexpr std::size_t kShown = 20;
    for (std::size_t i = 0; i < std::min(tasks.size(), kShown); ++i) {
        const SlurmTask& task = tasks[i];
        out << fmt::format("slurm job {}, {}: {}{}{}\n", task.job,
                           task.shard > 0 ? fmt::format("shard {}", task.shard) : "merge", task.state,
                           task.reason.empty() ? "" : " (" + task.reason + ")",
                           task.node.empty() ? "" : " on " + task.node);
    }
    if (tasks.size() > kShown) out << fmt::format("and {} more jobs\n", tasks.size() - kShown);
}

void print_text(std::ostream& out, const CohortConfig& config, Status& status) {
    out << fmt::format("{}: {} ok, {} with warnings, {} failed, {} pending of {}\n", config.name,
                       status.counts[ModelStatus::kOk], status.counts[ModelStatus::kWarning], status.failed.size(),
                       status.pending.size(), counted(config.tasks.size(), "model"));
    for (const LeaseHolder& run : status.runs)
        out << fmt::format("{} {}/{}: process {} on {} since {}, last sign of life {:.0f} s ago\n",
                           run.alive ? "running" : "dead run", run.shard.index, run.shard.count, run.process, run.host,
                           run.since, run.heartbeat_age);
    print_queue(out, status.slurm);
    if (!status.pending.empty())
        out << fmt::format("left: about {} in one thread, {} in all of this machine\n",
                           duration_text(status.seconds_left),
                           duration_text(status.seconds_left / available_threads()));
    if (!status.failed.empty()) {
        TextTable table;
        for (const char* heading : {"failed", "stage", "code", "why"})
            table.add_column(heading, TextTable::Align::kLeft);
        for (const FailedModel& model : status.failed)
            table.add_row({model.id, std::string(stage_name(model.failure.stage)),
                           std::string(error_name(model.failure.code)), model.failure.sentence});
        out << '\n';
        table.print(out);
    }
    if (!status.pending.empty()) {
        constexpr std::size_t kShown = 20;
        TextTable table;
        for (const char* heading : {"pending", "why"}) table.add_column(heading, TextTable::Align::kLeft);
        for (std::size_t i = 0; i < std::min(status.pending.size(), kShown); ++i)
            table.add_row({status.pending[i].id, status.pending[i].reason});
        out << '\n';
        table.print(out);
        if (status.pending.size() > kShown) out << fmt::format("and {} more\n", status.pending.size() - kShown);
    }
}

int show_status(const std::string& cohort, bool json) {
    const CohortConfig config = load_cohort(cohort);
    Status status = read_status(config);
    to_standard_output([&](std::ostream& out) {
        if (json)
            print_json(out, config, status);
        else
            print_text(out, config, status);
    });
    return exit_status(status);
}

int merge(const std::string& cohort, bool wait) {
    const CohortConfig config = load_cohort(cohort);
    const StopOnSignal stop;
    // A right to all of it: the index is not to be made while someone still writes what belongs into it.
    const std::unique_ptr<Lease> lease = take_lease(config.archive.directory, Shard{}, wait);
    if (!lease) return kStopped;
    std::vector<ModelSummary> rows;
    std::map<ModelStatus, std::size_t> counts;
    for (const ModelTask& task : config.tasks) {
        std::optional<ModelSummary> row = index_row(config.archive, task);
        if (!row) continue;
        ++counts[row->status];
        rows.push_back(std::move(*row));
    }
    make_index(config, rows);
    const std::size_t missing = config.tasks.size() - rows.size();
    to_standard_output([&](std::ostream& out) {
        out << fmt::format("{} ok, {} with warnings, {} failed, {} missing\narchive: {}\n", counts[ModelStatus::kOk],
                           counts[ModelStatus::kWarning], counts[ModelStatus::kFailed], missing,
                           config.archive.directory.string());
    });
    if (missing > 0) return kStopped;
    return counts[ModelStatus::kFailed] > 0 ? kModelFailed : kDone;
}

}  // namespace

void add_status(CLI::App& app, std::function<int()>& action) {
    struct Arguments {
        std::string cohort;
        bool json = false;
    };
    auto arguments = std::make_shared<Arguments>();
    CLI::App* verb = app.add_subcommand("status", "Say what of a cohort is done, failed and left, also while it runs");
    verb->add_option("COHORT", arguments->cohort, "The cohort's YAML file (config/SCHEMA.md)")->required();
    verb->add_flag("--json", arguments->json, "As JSON");
    verb->footer(
        "Looks at the model files and leases of the archive, and reads no surface; after `submit`, also at Slurm's\n"
        "queue.\n"
        "Exit status: 0 all models done, 1 at least one failed, 2 usage or configuration error, 3 some are left.");
    verb->callback(
        [arguments, &action] { action = [arguments] { return show_status(arguments->cohort, arguments->json); }; });
}

void add_merge(CLI::App& app, std::function<int()>& action) {
    struct Arguments {
        std::string cohort;
        bool wait = false;
    };
    auto arguments = std::make_shared<Arguments>();
    CLI::App* verb = app.add_subcommand("merge", "Make the index of an archive anew from its model files");
    verb->add_option("COHORT", arguments->cohort, "The cohort's YAML file (config/SCHEMA.md)")->required();
    verb->add_flag("--wait", arguments->wait, "Wait while runs hold the archive, instead of stopping");
    verb->footer(
        "The last step after shards; harmless at any time that no run holds the archive.\n"
        "Exit status: 0 all models ok or warning, 1 at least one failed, 2 usage or configuration error (also: a run\n"
        "holds the archive), 3 at least one has no file.");
    verb->callback(
        [arguments, &action] { action = [arguments] { return merge(arguments->cohort, arguments->wait); }; });
}

}  // namespace lumenline
