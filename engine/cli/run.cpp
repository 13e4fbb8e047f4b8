#include "engine/cli/run.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <ostream>
#include <set>

#include "config/cohort.h"
#include "engine/cli/model_io.h"
#include "engine/cli/progress.h"
#include "engine/cli/standard_output.h"
#include "engine/cli/table.h"
#include "engine/core/text.h"
#include "engine/schedule/run_models.h"
#include "io/archive/index.h"
#include "io/archive/model_file.h"

namespace lumenline {

namespace {

namespace fs = std::filesystem;

struct RunArguments {
    std::string cohort;
    std::optional<int> threads;
    std::vector<std::string> only;
};

/// Writes one finished record into the archive; a file that cannot be written is the model's failure.
ModelSummary store(ModelRecord record, const ModelTask& task, const ArchiveSettings& archive) {
    record.identity.inputs_sha256 = inputs_digest(task, record.identity.source_sha256, archive.float32_fields);
    ModelSummary summary = summarize(record);
    try {
        write_model_file(model_path(archive.directory, record.identity.id), record, {archive.float32_fields});
    } catch (const StageError& error) {
        summary.status = ModelStatus::kFailed;
        summary.failure = Failure{error.stage(), error.code(), error.what()};
    }
    return summary;
}

/// The tasks to compute: all, or those named by --only.
std::vector<ModelTask> select(const CohortConfig& config, const std::vector<std::string>& only) {
    if (only.empty()) return config.tasks;
    std::vector<ModelTask> chosen;
    for (const std::string& id : std::set<std::string>(only.begin(), only.end())) {
        const auto found = std::find_if(config.tasks.begin(), config.tasks.end(),
                                        [&](const ModelTask& t) { return t.identity.id == id; });
        if (found == config.tasks.end()) throw CLI::ValidationError("--only", "the cohort has no model '" + id + "'");
        chosen.push_back(*found);
    }
    return chosen;
}

/// Rows of the index in the cohort's order: this run's models, and files of earlier runs.
std::vector<ModelSummary> gather(const CohortConfig& config, std::map<std::string, ModelSummary> done) {
    std::vector<ModelSummary> rows;
    for (const ModelTask& task : config.tasks) {
        const fs::path file = model_path(config.archive.directory, task.identity.id);
        if (const auto found = done.find(task.identity.id); found != done.end()) {
            rows.push_back(std::move(found->second));
        } else if (fs::exists(file)) {
            try {
                rows.push_back(read_summary(file));
            } catch (const std::exception& error) {
                fmt::print(stderr, "{}: {}; it is left out of the index\n", task.identity.id, error.what());
            }
        }
    }
    return rows;
}

/// How this run's models ended.
using Counts = std::map<ModelStatus, std::size_t>;

void print_results(const CohortConfig& config, const std::vector<ModelSummary>& rows, Counts counts,
                   const RunReport& report) {
    to_standard_output([&](std::ostream& out) {
        print_models(out, rows);
        out << fmt::format("\n{} ok, {} with warnings, {} failed; {:.1f} s on {}\narchive: {}\n",
                           counts[ModelStatus::kOk], counts[ModelStatus::kWarning], counts[ModelStatus::kFailed],
                           report.seconds, counted(static_cast<std::size_t>(report.threads), "thread"),
                           config.archive.directory.string());
    });
}

int run(const RunArguments& arguments) {
    const CohortConfig config = load_cohort(arguments.cohort);
    const std::vector<ModelTask> tasks = select(config, arguments.only);
    fs::create_directories(config.archive.directory / "models");

    std::map<std::string, const ModelTask*> task_of;
    for (const ModelTask& task : tasks) task_of[task.identity.id] = &task;
    std::map<std::string, ModelSummary> done;
    Progress progress(tasks.size());
    const StopOnSignal stop;
    ScheduleOptions schedule;
    schedule.threads = arguments.threads.value_or(config.run.threads);
    schedule.models_in_flight = config.run.models_in_flight;
    schedule.cancelled = StopOnSignal::flag();
    const RunReport report = run_models(tasks, schedule, load_task, [&](ModelRecord&& record) {
        const ModelTask& task = *task_of.at(record.identity.id);
        ModelSummary summary = store(std::move(record), task, config.archive);
        progress.add(summary);
        done.emplace(summary.identity.id, std::move(summary));
    });
    progress.finish();
    Counts counts;
    for (const auto& [id, summary] : done) ++counts[summary.status];
    const std::vector<ModelSummary> rows = gather(config, std::move(done));
    write_index(config.archive.directory, rows, config.text, resolved_text(config));
    print_results(config, rows, counts, report);
    if (report.interrupted + report.not_started > 0) {
        fmt::print(stderr, "stopped: {} not done; run the same command again\n",
                   counted(report.interrupted + report.not_started, "model"));
        return kStopped;
    }
    return counts[ModelStatus::kFailed] > 0 ? kModelFailed : kDone;
}

}  // namespace

void add_run(CLI::App& app, std::function<int()>& action) {
    auto arguments = std::make_shared<RunArguments>();
    CLI::App* verb = app.add_subcommand("run", "Compute a cohort into its archive");
    verb->add_option("COHORT", arguments->cohort, "The cohort's YAML file (config/SCHEMA.md)")->required();
    verb->add_option("--threads", arguments->threads, "Threads to use, instead of the configuration's")
        ->check(CLI::PositiveNumber);
    verb->add_option("--only", arguments->only, "Compute this model only; may be repeated")->take_all();
    verb->footer(
        "Prints a table of the models, and progress on standard error.\n"
        "Exit status: 0 all models ok or warning, 1 at least one failed, 2 usage or configuration error, 3 stopped.");
    verb->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace lumenline
