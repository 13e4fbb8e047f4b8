// Shards are frozen before anything is submitted: tasks start at different times, and none may find surfaces of other
// sizes. A submission that fails half way takes back what it has submitted.
#include "engine/cli/submit.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <ostream>
#include <system_error>

#include "config/cohort.h"
#include "engine/cli/command.h"
#include "engine/cli/estimates.h"
#include "engine/cli/plan.h"
#include "engine/cli/run.h"
#include "engine/cli/shards.h"
#include "engine/cli/slurm.h"
#include "engine/cli/standard_output.h"
#include "engine/core/text.h"
#include "io/archive/commit.h"
#include "io/archive/lease.h"

namespace lumenline {

namespace {

namespace fs = std::filesystem;

struct SubmitArguments {
    std::string cohort;
    SlurmRequest request;
    bool print = false;
};

std::string safe_name(std::string name) {
    std::ranges::replace_if(
        name, [](unsigned char c) { return c <= ' ' || c == '/' || c >= 127; }, '_');
    return name;
}

SlurmRequest complete(SlurmRequest request, const CohortConfig& config) {
    for (const std::string& word : request.more)
        if (std::ranges::any_of(word, [](unsigned char c) { return c < ' '; }))
            throw CLI::ValidationError("submit", "an option of sbatch holds a control character");
    request.tasks = std::min(request.tasks, static_cast<int>(config.tasks.size()));
    request.program = fs::read_symlink("/proc/self/exe");
    request.folder = fs::current_path();
    request.cohort = config.file;
    request.logs = fs::absolute(config.archive.directory).lexically_normal() / "runs";
    request.name = safe_name(config.name);
    return request;
}

/// What is wrong with the cohort's surfaces at first sight; a run would say the same of each model.
void say_missing(const CohortConfig& config) {
    std::size_t missing = 0;
    const ModelTask* first = nullptr;
    for (const ModelTask& task : config.tasks) {
        std::error_code error;
        if (fs::exists(task.surface_path, error)) continue;
        if (missing++ == 0) first = &task;
    }
    if (missing > 0)
        fmt::print(stderr, "{} of {} not found, first '{}' of {}: these models will fail\n", missing,
                   counted(config.tasks.size(), "surface"), first->surface_path, first->identity.id);
}

void require_slurm() {
    try {
        run_command({"sbatch", "--version"});
    } catch (const std::system_error&) {
        throw CLI::ValidationError("submit",
                                   "this machine has no sbatch: run it where the cluster takes jobs, or see "
                                   "examples/slurm/README.md for machines without Slurm");
    }
}

/// Throws unless the archive is free of runs and jobs.
void require_free(const fs::path& archive_dir) {
    for (const LeaseHolder& run : read_leases(archive_dir))
        if (run.alive)
            throw LeaseHeld(fmt::format("a run holds '{}': process {} on {} since {}; wait for its end, or stop it",
                                        archive_dir.string(), run.process, run.host, run.since));
    const std::vector<SlurmTask> queued = queued_tasks(archive_dir);
    if (!queued.empty())
        throw LeaseHeld(
            fmt::format("the cohort is submitted already: {} in the queue, such as {} ({}); wait for "
                        "their end, or scancel them",
                        counted(queued.size(), "job"), queued.front().job, queued.front().state));
}

void print_scripts(const SlurmRequest& request, const std::vector<ArrayJob>& arrays) {
    to_standard_output([&](std::ostream& out) {
        for (std::size_t i = 0; i < arrays.size(); ++i)
            out << fmt::format("# job {}: shards {} to {} of {}\n", i + 1, arrays[i].first, arrays[i].last,
                               request.tasks)
                << array_script(request, arrays[i]) << '\n';
        out << "# last job, with --dependency=afterany: and the numbers of the jobs above\n" << merge_script(request);
    });
}

SlurmJobs submit_jobs(const SlurmRequest& request, std::vector<ArrayJob> arrays) {
    SlurmJobs jobs;
    try {
        std::string dependency = "afterany";
        for (ArrayJob& array : arrays) {
            array.job = submit_script(array_script(request, array), "");
            dependency += ":" + array.job;
            jobs.arrays.push_back(array);
        }
        jobs.merge = submit_script(merge_script(request), dependency);
    } catch (const std::exception&) {
        for (const ArrayJob& array : jobs.arrays) run_command({"scancel", array.job});
        throw;
    }
    return jobs;
}

int submit(const SubmitArguments& arguments) {
    const CohortConfig config = load_cohort(arguments.cohort);
    const SlurmRequest request = complete(arguments.request, config);
    const std::vector<ArrayJob> arrays = cut_into_arrays(request.tasks, max_array_size());
    if (arguments.print) {
        print_scripts(request, arrays);
        return kDone;
    }
    require_slurm();
    say_missing(config);
    require_free(config.archive.directory);
    make_directories(config.archive.directory / "models");
    make_directories(request.logs);
    if (request.tasks > 1) (void)tasks_of_shard(config.archive.directory, config.tasks, {1, request.tasks});
    const SlurmJobs jobs = submit_jobs(request, arrays);
    write_jobs(config.archive.directory, jobs);
    to_standard_output([&](std::ostream& out) {
        for (const ArrayJob& array : jobs.arrays)
            out << fmt::format("array {}: shards {} to {} of {}\n", array.job, array.first, array.last, request.tasks);
        out << fmt::format("merge {}: after all of them\n", jobs.merge);
        out << "in all " << estimate_text(config, select_tasks(config, {}), request.tasks) << '\n';
    });
    return kDone;
}

}  // namespace

void add_submit(CLI::App& app, std::function<int()>& action) {
    auto arguments = std::make_shared<SubmitArguments>();
    SlurmRequest& request = arguments->request;
    CLI::App* verb = app.add_subcommand("submit", "Compute a cohort as a Slurm job array, and merge its index");
    verb->add_option("COHORT", arguments->cohort, "The cohort's YAML file (config/SCHEMA.md)")->required();
    constexpr int kMostTasks = 100000;
    verb->add_option("--tasks", request.tasks, "Shards, each a task of the array; at most one a model")
        ->required()
        ->check(CLI::Range(1, kMostTasks));
    verb->add_option("--partition", request.partition, "As sbatch takes it");
    verb->add_option("--time", request.time, "Longest time of a task, as sbatch takes it");
    verb->add_option("--mem", request.memory, "Memory of a task, as sbatch takes it");
    verb->add_option("--cpus-per-task", request.cpus, "Threads of a task")->check(CLI::Range(1, 4096));
    verb->add_option("SBATCH", request.more, "Behind --: any other options of sbatch, for every job");
    verb->add_flag("--print", arguments->print, "Print the scripts, and neither write nor submit anything");
    verb->footer(
        "Freezes what each shard computes (shards.tsv in the archive), submits an array of `run --shard`, cut where "
        "it\n"
        "is beyond the cluster's MaxArraySize, and a `merge` that begins when all have ended, however they did.\n"
        "Prints the jobs' numbers; logs are in runs/ of the archive, and `status` shows the queue too. Tasks may be\n"
        "requeued at any moment. The same command again computes what is left. More: examples/slurm/README.md.\n"
        "Exit status: 0 submitted, 1 Slurm refuses it, 2 usage or configuration error (also: the archive is in use).");
    verb->callback([arguments, &action] { action = [arguments] { return submit(*arguments); }; });
}

}  // namespace lumenline
