// A run: hold its part of the archive, see what is to be done, compute it, write the index. Two things reach in from
// other threads: the ticker, which shows that the run lives and ends it when stages do not heed a signal, and the
// scheduler's writer. Both hold `mutex_` while they touch files, so that HDF5 is entered once at a time and no file
// is left half written by an end in between.
#include "engine/cli/run.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <ostream>

#include "config/cohort.h"
#include "engine/cli/estimates.h"
#include "engine/cli/isolated.h"
#include "engine/cli/lease_wait.h"
#include "engine/cli/make_index.h"
#include "engine/cli/model_io.h"
#include "engine/cli/plan.h"
#include "engine/cli/progress.h"
#include "engine/cli/shards.h"
#include "engine/cli/standard_output.h"
#include "engine/cli/store.h"
#include "engine/cli/table.h"
#include "engine/core/text.h"
#include "engine/schedule/memory.h"
#include "engine/schedule/run_models.h"
#include "engine/schedule/ticker.h"
#include "io/archive/commit.h"
#include "io/archive/index.h"
#include "io/archive/index_names.h"
#include "io/archive/lease.h"
#include "io/archive/model_file.h"

namespace lumenline {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Action = PlannedModel::Action;

struct RunArguments {
    std::string cohort;
    std::optional<int> threads;
    std::vector<std::string> only;
    std::string shard;
    bool wait = false;
    bool retry_failed = false;
    bool dry_run = false;
    std::string isolation;
};

/// How long the models in flight may take to heed a signal.
constexpr std::chrono::seconds kGrace{5};

/// How the models of a run ended.
using Counts = std::map<ModelStatus, std::size_t>;

class Run {
public:
    Run(const RunArguments& arguments, const CohortConfig& config)
        : arguments_(arguments), config_(config), tasks_(select_tasks(config, arguments.only)) {
        if (!arguments.shard.empty()) shard_ = parse_shard(arguments.shard);
    }

    int compute() {
        const StopOnSignal stop;
        make_directories(config_.archive.directory / "models");
        lease_ = take_lease(config_.archive.directory, shard_, arguments_.wait);
        if (!lease_) return kStopped;
        keep_own_shard();
        remove_left_overs();
        const Ticker ticker(std::chrono::milliseconds(250), [this] { tick(); });
        make_plan();
        const RunReport report = run_planned();
        const std::lock_guard lock(mutex_);
        ended_ = true;
        return finish(report);
    }

private:
    void keep_own_shard() {
        if (shard_.count == 1) return;
        const std::vector<const ModelTask*> own = tasks_of_shard(config_.archive.directory, config_.tasks, shard_);
        std::erase_if(tasks_, [&](const ModelTask* task) { return std::ranges::find(own, task) == own.end(); });
    }

    /// Removes what killed runs left of the models of this run: nobody else writes them while we hold the lease.
    void remove_left_overs() const {
        std::error_code ignored;
        for (const ModelTask* task : tasks_)
            fs::remove(temporary_of(model_path(config_.archive.directory, task->identity.id)), ignored);
        if (shard_.count == 1) fs::remove(temporary_of(config_.archive.directory / names::kIndexFile), ignored);
    }

    void make_plan() {
        const int threads = arguments_.threads.value_or(config_.run.threads);
        std::vector<const ModelTask*> left;
        for (const PlannedModel& model : plan_models(config_.archive, tasks_, arguments_.retry_failed, threads)) {
            if (model.action == Action::kRun) {
                left.push_back(model.task);
                task_of_[model.task->identity.id] = model.task;
            } else {
                ++counts_[model.state->status];
                ++done_before_;
            }
        }
        estimates_.emplace(left);
        for (const ModelTask* task : estimates_->longest_first(left)) to_run_.push_back(*task);
    }

    RunReport run_planned() {
        Progress progress(to_run_.size());
        ScheduleOptions schedule;
        schedule.threads = arguments_.threads.value_or(config_.run.threads);
        schedule.models_in_flight = config_.run.models_in_flight;
        schedule.cancelled = StopOnSignal::flag();
        schedule.memory = memory_budget(config_.run);
        schedule.memory_of = [this](const ModelTask& task) { return estimated_memory(estimates_->sites(task)); };
        schedule.refined_memory_of = estimated_memory;
        schedule.model_timeout = config_.run.model_timeout;
        schedule.model_memory = config_.run.model_memory;
        const RunReport report = isolated() ? run_in_workers(schedule, progress) : run_here(schedule, progress);
        progress.finish();
        return report;
    }

    [[nodiscard]] bool isolated() const {
        return arguments_.isolation.empty() ? config_.run.isolation == Isolation::kProcess
                                            : arguments_.isolation == isolation_name(Isolation::kProcess);
    }

    RunReport run_here(const ScheduleOptions& schedule, Progress& progress) {
        return run_models(to_run_, schedule, load_task, [&](ModelRecord&& record) {
            const std::lock_guard lock(mutex_);
            const ModelTask& task = *task_of_.at(record.identity.id);
            note(store_model(std::move(record), task, config_.archive).summary, progress);
        });
    }

    RunReport run_in_workers(const ScheduleOptions& schedule, Progress& progress) {
        IsolatedHandlers handlers;
        handlers.worker = worker_arguments(config_.run);
        handlers.request = [&](const ModelTask& task, int threads) { return worker_request(config_, task, threads); };
        handlers.done = [&](const ModelTask& task, IsolatedResult&& result) {
            const std::lock_guard lock(mutex_);
            ModelSummary summary = settle(result, task, config_.archive);
            const ModelStatus status = summary.status;
            note(std::move(summary), progress);
            return status;
        };
        const RunReport report = run_isolated(to_run_, schedule, handlers);
        if (report.interrupted > 0) remove_left_overs();  // of the workers that were ended
        return report;
    }

    void note(ModelSummary&& summary, Progress& progress) {
        ++counts_[summary.status];
        progress.add(summary);
        finished_.emplace(summary.identity.id, std::move(summary));
    }

    /// Rows in the cohort's order: this run's models, and files of earlier runs, by the index that stands where they
    /// have not changed since. A shard leaves the index to `merge`, since others write beside it.
    void write_rows() {
        rows_.clear();
        const bool is_shard = shard_.count > 1;
        const std::vector<const ModelTask*> shown = is_shard ? tasks_ : select_tasks(config_, {});
        const std::map<std::string, ModelSummary> unchanged = read_unchanged_rows(config_.archive.directory);
        bool index_stands = finished_.empty() && unchanged.size() == shown.size();
        for (const ModelTask* task : shown) {
            const auto known = unchanged.find(task->identity.id);
            index_stands = index_stands && known != unchanged.end();
            if (const auto found = finished_.find(task->identity.id); found != finished_.end())
                rows_.push_back(found->second);
            else if (known != unchanged.end() && !known->second.failure)
                rows_.push_back(with_labels(known->second, *task));
            else if (std::optional<ModelSummary> row = index_row(config_.archive, *task))
                rows_.push_back(std::move(*row));
        }
        if (is_shard || (index_stands && index_is_of(config_.archive.directory, config_.text, resolved_text(config_))))
            return;
        make_index(config_, rows_);
    }

    int finish(const RunReport& report) {
        if (lost_) return say_lost();
        write_rows();
        release_lease();
        print_results(report);
        const std::size_t left = report.interrupted + report.not_started;
        if (left > 0) return say_stopped(left);
        return counts_[ModelStatus::kFailed] > 0 ? kModelFailed : kDone;
    }

    void release_lease() {
        const std::lock_guard lock(lease_mutex_);
        lease_->release();
        released_ = true;
    }

    void print_results(const RunReport& report) {
        to_standard_output([&](std::ostream& out) {
            print_models(out, rows_);
            out << fmt::format("\n{} ok, {} with warnings, {} failed", counts_[ModelStatus::kOk],
                               counts_[ModelStatus::kWarning], counts_[ModelStatus::kFailed]);
            if (done_before_ > 0) out << fmt::format(" ({} of them before)", done_before_);
            out << fmt::format("; {:.1f} s on {}\narchive: {}\n", report.seconds,
                               counted(static_cast<std::size_t>(report.threads), "thread"),
                               config_.archive.directory.string());
            if (shard_.count > 1) out << "the index is made by: lumenline merge " << arguments_.cohort << '\n';
        });
    }

    static int say_stopped(std::size_t left) {
        fmt::print(stderr, "stopped: {} not done; run the same command again\n", counted(left, "model"));
        return kStopped;
    }

    int say_lost() {
        fmt::print(stderr, "stopped: another run has taken over '{}', since this one gave no sign of life\n",
                   config_.archive.directory.string());
        return kStopped;
    }

    void tick() {
        const auto now = Clock::now();
        if (now - beaten_ >= std::chrono::duration<double>(kLeaseBeatSeconds)) {
            beaten_ = now;
            const std::lock_guard lock(lease_mutex_);
            if (!released_ && !lease_->beat()) {
                lost_ = true;
                StopOnSignal::request();
            }
        }
        if (!StopOnSignal::flag()->load()) return;
        if (!signalled_) signalled_ = now;
        if (now - *signalled_ >= kGrace) abandon();
    }

    /// Ends the process while stages still compute. Only what stands on the disk counts, so nothing is lost but them.
    void abandon() {
        const std::lock_guard lock(mutex_);
        if (ended_) return;
        int status = kStopped;
        try {
            if (lost_) {
                say_lost();
            } else {
                write_rows();
                release_lease();
                say_stopped(to_run_.size() - finished_.size());
            }
        } catch (const std::exception& error) {
            fmt::print(stderr, "lumenline: {}\n", error.what());
            status = kModelFailed;
        }
        std::_Exit(status);
    }

    const RunArguments& arguments_;
    const CohortConfig& config_;
    std::vector<const ModelTask*> tasks_;
    Shard shard_;
    std::mutex lease_mutex_;  // of its own: a sign of life must not wait for a large file
    std::unique_ptr<Lease> lease_;
    bool released_ = false;
    std::optional<Estimates> estimates_;
    std::vector<ModelTask> to_run_;
    std::map<std::string, const ModelTask*> task_of_;
    std::size_t done_before_ = 0;

    std::mutex mutex_;  // of what follows, and of all files of the archive
    bool ended_ = false;
    Counts counts_;
    std::map<std::string, ModelSummary> finished_;
    std::vector<ModelSummary> rows_;

    std::atomic<bool> lost_{false};
    Clock::time_point beaten_ = Clock::now();  // the ticker's own
    std::optional<Clock::time_point> signalled_;
};

int dry_run(const RunArguments& arguments, const CohortConfig& config) {
    const StopOnSignal stop;
    const std::vector<const ModelTask*> tasks = select_tasks(config, arguments.only);
    const int asked = arguments.threads.value_or(config.run.threads);
    const std::vector<PlannedModel> plan = plan_models(config.archive, tasks, arguments.retry_failed, asked);
    if (*StopOnSignal::flag()) return kStopped;
    to_standard_output([&](std::ostream& out) {
        TextTable table;
        for (const char* heading : {"id", "would", "because"}) table.add_column(heading, TextTable::Align::kLeft);
        std::map<Action, std::size_t> counts;
        std::vector<const ModelTask*> left;
        for (const PlannedModel& model : plan) {
            ++counts[model.action];
            if (model.action == Action::kRun) left.push_back(model.task);
            table.add_row({model.task->identity.id, model.action == Action::kRun ? "run" : "stay",
                           model.action == Action::kDone ? "it is done" : model.reason});
        }
        table.print(out);
        out << fmt::format("\n{} would run, {} done, {} failed before (--retry-failed tries them again)\n",
                           counts[Action::kRun], counts[Action::kDone], counts[Action::kFailed]);
        out << estimate_text(config, left, asked > 0 ? asked : available_threads()) << '\n';
    });
    return kDone;
}

int run(const RunArguments& arguments) {
    const CohortConfig config = load_cohort(arguments.cohort);
    return arguments.dry_run ? dry_run(arguments, config) : Run(arguments, config).compute();
}

}  // namespace

void add_run(CLI::App& app, std::function<int()>& action) {
    auto arguments = std::make_shared<RunArguments>();
    CLI::App* verb = app.add_subcommand("run", "Compute a cohort into its archive, or what is left of it");
    verb->add_option("COHORT", arguments->cohort, "The cohort's YAML file (config/SCHEMA.md)")->required();
    verb->add_option("--threads", arguments->threads, "Threads to use, instead of the configuration's")
        ->check(CLI::Range(1, 4096));
    verb->add_option("--only", arguments->only, "Compute this model only; may be repeated")->take_all();
    verb->add_option("--shard", arguments->shard, "Compute part I of N (I/N), beside the other parts; then merge");
    verb->add_flag("--wait", arguments->wait, "Wait while another run holds the archive, instead of stopping");
    verb->add_flag("--retry-failed", arguments->retry_failed, "Try models again that failed before");
    verb->add_option("--isolation", arguments->isolation,
                     "none: compute in this process; process: in worker processes, where a crash fails one model only")
        ->check(CLI::IsMember({"none", "process"}));
    verb->add_flag("--dry-run", arguments->dry_run, "Say what would run and why, and write nothing");
    verb->footer(
        "A model whose file stands with the same surface, options and format is done and is not computed again; so a\n"
        "run that was stopped is resumed by the same command. A model that failed is tried again when its inputs\n"
        "change, if it lacked time or memory, or with --retry-failed.\n"
        "A model whose surface is larger starts earlier; models wait while the estimated memory of those in flight is\n"
        "all of run.memory, and --dry-run says how much time, memory and disk the run may take.\n"
        "--shard: the parts are about equal in work; which is in which stands in shards.tsv of the archive.\n"
        "Prints a table of the models, and progress on standard error. SIGINT and SIGTERM stop the run within\n"
        "seconds, with an index of what stands; a second one ends it at once.\n"
        "Exit status: 0 all models ok or warning, 1 at least one failed, 2 usage or configuration error (also: "
        "another\n"
        "run holds the archive), 3 stopped.");
    verb->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace lumenline
