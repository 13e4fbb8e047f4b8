// Reads and conditions every surface of a cohort, one after the other in this thread: what stops a model later than
// that is rare, and what stops it earlier is what a user can mend in the files or in the configuration.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <memory>
#include <ostream>

#include "config/cohort.h"
#include "engine/cli/estimates.h"
#include "engine/cli/model_io.h"
#include "engine/cli/plan.h"
#include "engine/cli/run.h"
#include "engine/cli/standard_output.h"
#include "engine/core/text.h"
#include "engine/schedule/model_job.h"
#include "engine/schedule/run_models.h"
#include "io/archive/utf8.h"

namespace lumenline {

namespace {

ModelRecord check(const ModelTask& task) {
    ModelJob job(task, nullptr, StopOnSignal::flag());
    job.load(load_task);
    job.condition();
    return job.take();
}

/// What there is to say of a model, in a sentence.
std::string verdict(const ModelRecord& record) {
    if (record.failure) return record.failure->sentence;
    std::vector<const Diagnostic*> findings;
    for (const Diagnostic& d : record.diagnostics)
        if (d.severity != Severity::kNote) findings.push_back(&d);
    if (findings.size() == 1) return findings.front()->message;
    if (!findings.empty())
        return fmt::format("{} (and {})", findings.front()->message, counted(findings.size() - 1, "more warning"));
    return fmt::format("{}, {}", counted(record.surface->site_count(), "site"),
                       counted(record.surface->openings.size(), "opening"));
}

int validate(const std::string& cohort) {
    const CohortConfig config = load_cohort(cohort);
    std::size_t width = 0;
    for (const ModelTask& task : config.tasks) width = std::max(width, code_points(task.identity.id));
    std::map<ModelStatus, std::size_t> counts;
    const StopOnSignal stop;
    bool stopped = false;
    to_standard_output([&](std::ostream& out) {
        for (const ModelTask& task : config.tasks) {
            const ModelRecord record = check(task);
            stopped = record.failure && record.failure->code == ErrorCode::kInterrupted;
            if (stopped || *StopOnSignal::flag()) {
                stopped = true;
                return;
            }
            ++counts[record.status];
            const std::string gap(width - code_points(task.identity.id), ' ');
            out << printable(fmt::format("{}{}  {:<7}  {}", task.identity.id, gap, status_name(record.status),
                                         verdict(record)))
                << std::endl;
        }
        out << fmt::format("\n{} ok, {} with warnings, {} failed\n", counts[ModelStatus::kOk],
                           counts[ModelStatus::kWarning], counts[ModelStatus::kFailed]);
        out << "a run: " << estimate_text(config, select_tasks(config, {}), available_threads()) << '\n';
    });
    if (stopped) {
        fmt::print(stderr, "stopped\n");
        return kStopped;
    }
    return counts[ModelStatus::kFailed] > 0 ? kModelFailed : kDone;
}

}  // namespace

void add_validate(CLI::App& app, std::function<int()>& action) {
    auto cohort = std::make_shared<std::string>();
    CLI::App* verb = app.add_subcommand("validate", "Check a cohort's configuration and surfaces, compute nothing");
    verb->add_option("COHORT", *cohort, "The cohort's YAML file (config/SCHEMA.md)")->required();
    verb->footer(
        "Reads, repairs and closes every surface as a run would, and prints a line per model, then what a run\n"
        "may take: time, disk and memory.\n"
        "Exit status: 0 all models ok or warning, 1 at least one failed, 2 usage or configuration error, 3 stopped.");
    verb->callback([cohort, &action] { action = [cohort] { return validate(*cohort); }; });
}

}  // namespace lumenline
