// Reads and conditions every surface of a cohort, one after the other in this thread: what stops a model later than
// that is rare, and what stops it earlier is what a user can mend in the files or in the configuration. Whether a size
// is unlike the others' is known only when all are: it is said below them.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <memory>
#include <ostream>
#include <vector>

#include "config/cohort.h"
#include "engine/cli/estimates.h"
#include "engine/cli/model_io.h"
#include "engine/cli/plan.h"
#include "engine/cli/run.h"
#include "engine/cli/standard_output.h"
#include "engine/core/size_note.h"
#include "engine/core/stage_context.h"
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

/// Per model, what its size says of its unit; empty = nothing.
std::vector<Diagnostics> unlikely_units(const std::vector<double>& diagonals, const std::string& unit) {
    std::vector<Diagnostics> found;
    for (const std::string& note : size_notes(diagonals, unit)) {
        StageContext context(Stage::kLoad);
        if (!note.empty()) context.warn("unlikely_unit", note);
        found.push_back(context.diagnostics());
    }
    return found;
}

int validate(const std::string& cohort) {
    const CohortConfig config = load_cohort(cohort);
    std::size_t width = 0;
    for (const ModelTask& task : config.tasks) width = std::max(width, code_points(task.identity.id));
    std::map<ModelStatus, std::size_t> counts;
    std::vector<double> diagonals;
    std::vector<ModelStatus> statuses;
    const StopOnSignal stop;
    bool stopped = false;
    to_standard_output([&](std::ostream& out) {
        const auto print = [&](const ModelTask& task, ModelStatus status, const std::string& text) {
            const std::string gap(width - code_points(task.identity.id), ' ');
            out << printable(fmt::format("{}{}  {:<7}  {}", task.identity.id, gap, status_name(status), text))
                << std::endl;
        };
        for (const ModelTask& task : config.tasks) {
            const ModelRecord record = check(task);
            stopped = record.failure && record.failure->code == ErrorCode::kInterrupted;
            if (stopped || *StopOnSignal::flag()) {
                stopped = true;
                return;
            }
            statuses.push_back(record.status);
            diagonals.push_back(record.surface ? record.surface->diagonal : 0);
            print(task, record.status, verdict(record));
        }
        const std::string unit = config.tasks.empty() ? "unknown" : config.tasks.front().identity.length_unit;
        const std::vector<Diagnostics> units = unlikely_units(diagonals, unit);
        for (std::size_t i = 0; i < units.size(); ++i) {
            for (const Diagnostic& d : units[i])
                print(config.tasks[i], ModelStatus::kWarning, d.code + ": " + d.message);
            if (!units[i].empty() && statuses[i] == ModelStatus::kOk) statuses[i] = ModelStatus::kWarning;
            ++counts[statuses[i]];
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
        "Reads, repairs and closes every surface as a run would, and prints a line per model; below, models whose\n"
        "size is so unlike the cohort's median that they are probably in another unit; then what a run may take:\n"
        "time, disk and memory.\n"
        "Exit status: 0 all models ok or warning, 1 at least one failed, 2 usage or configuration error, 3 stopped.");
    verb->callback([cohort, &action] { action = [cohort] { return validate(*cohort); }; });
}

}  // namespace lumenline
