// Scripts carry their options as #SBATCH lines, so that a printed one is the one that is submitted. sbatch reads such a
// line as words, with quotes and backslashes and with # as the start of a comment.

#include "engine/cli/slurm.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "engine/cli/command.h"

namespace lumenline {

namespace {

namespace fs = std::filesystem;

constexpr const char* kHeading = "job\tfirst\tlast";

std::string sbatch_quoted(const std::string& word) {
    constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,%@+[]";
    if (word.find_first_not_of(kPlain) == std::string::npos && !word.empty()) return word;
    std::string quoted = "\"";
    for (const char c : word) {
        if (c == '"' || c == '\\') quoted += '\\';
        quoted += c;
    }
    return quoted + "\"";
}

std::string shell_quoted(const std::string& word) {
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

/// A path in which sbatch puts nothing in the place of a percent sign.
std::string without_patterns(const fs::path& path) {
    std::string text;
    for (const char c : path.string()) text += c == '%' ? std::string("%%") : std::string(1, c);
    return text;
}

std::string heading(const SlurmRequest& request, const char* what, const char* log) {
    std::string text = "#!/bin/sh\n";
    const auto option = [&text](const std::string& word) { text += "#SBATCH " + sbatch_quoted(word) + "\n"; };
    option(fmt::format("--job-name={}-{}", request.name, what));
    option("--chdir=" + request.folder.string());
    option(fmt::format("--output={}/{}", without_patterns(request.logs), log));
    option("--open-mode=append");
    option("--requeue");
    if (!request.partition.empty()) option("--partition=" + request.partition);
    if (!request.time.empty()) option("--time=" + request.time);
    if (!request.more.empty()) {
        text += "#SBATCH";
        for (const std::string& word : request.more) text += " " + sbatch_quoted(word);
        text += "\n";
    }
    return text;
}

}  // namespace

std::vector<ArrayJob> cut_into_arrays(int tasks, int max_array_size) {
    const int most = std::max(max_array_size - 1, 1);
    std::vector<ArrayJob> arrays;
    for (int first = 1; first <= tasks; first += most) arrays.push_back({"", first, std::min(first + most - 1, tasks)});
    return arrays;
}

std::string array_script(const SlurmRequest& request, const ArrayJob& array) {
    std::string text = heading(request, "run", "slurm-%A_%a.out");
    text += fmt::format("#SBATCH --array=1-{}\n", array.last - array.first + 1);
    if (!request.memory.empty()) text += "#SBATCH " + sbatch_quoted("--mem=" + request.memory) + "\n";
    if (!request.cpus.empty()) text += "#SBATCH " + sbatch_quoted("--cpus-per-task=" + request.cpus) + "\n";
    const std::string shard = array.first == 1 ? std::string("$SLURM_ARRAY_TASK_ID")
                                               : fmt::format("$((SLURM_ARRAY_TASK_ID + {}))", array.first - 1);
    // It waits for the lease that a task which died on another node has left, until that expires.
    return text + fmt::format(
                      "exec {} run {} --shard \"{}/{}\" --wait \\\n"
                      "    --threads \"${{SLURM_CPUS_PER_TASK:-${{SLURM_CPUS_ON_NODE:-1}}}}\"\n",
                      shell_quoted(request.program.string()), shell_quoted(request.cohort.string()), shard,
                      request.tasks);
}

std::string merge_script(const SlurmRequest& request) {
    return heading(request, "merge", "slurm-%j.out") + fmt::format("exec {} merge {} --wait\n",
                                                                   shell_quoted(request.program.string()),
                                                                   shell_quoted(request.cohort.string()));
}

int max_array_size() {
    constexpr int kDefault = 1001;
    try {
        std::istringstream lines(run_command({"scontrol", "show", "config"}).out);
        for (std::string line; std::getline(lines, line);) {
            int size = 0;
            const std::size_t value = line.find_first_of("0123456789");
            if (line.starts_with("MaxArraySize") && value != std::string::npos &&
                std::from_chars(line.data() + value, line.data() + line.size(), size).ec == std::errc())
                return size;
        }
    } catch (const std::system_error&) {
        return kDefault;
    }
    return kDefault;
}

std::string submit_script(const std::string& script, const std::string& dependency) {
    std::vector<std::string> words{"sbatch", "--parsable"};
    if (!dependency.empty()) words.push_back("--dependency=" + dependency);
    const CommandResult result = run_command(words, script);
    const std::string job = result.out.substr(0, result.out.find_first_not_of("0123456789"));
    if (result.status != 0 || job.empty()) {
        std::string said = result.err.substr(0, result.err.find_last_not_of('\n') + 1);
        std::ranges::replace(said, '\n', ' ');
        throw std::runtime_error("sbatch does not take the job: " + (said.empty() ? "it does not answer" : said));
    }
    return job;
}

void write_jobs(const fs::path& archive_dir, const SlurmJobs& jobs) {
    const fs::path file = archive_dir / "runs" / "slurm.tsv";
    fs::path temporary = file;
    temporary += ".tmp";
    {
        std::ofstream out(temporary);
        out << kHeading << '\n';
        for (const ArrayJob& array : jobs.arrays) out << array.job << '\t' << array.first << '\t' << array.last << '\n';
        out << jobs.merge << "\t0\t0\n";
        if (!out.flush()) throw std::runtime_error("cannot write '" + temporary.string() + "'");
    }
    fs::rename(temporary, file);
}

SlurmJobs read_jobs(const fs::path& archive_dir) {
    SlurmJobs jobs;
    std::ifstream in(archive_dir / "runs" / "slurm.tsv");
    std::string line;
    if (!std::getline(in, line) || line != kHeading) return jobs;
    while (std::getline(in, line)) {
        std::istringstream words(line);
        ArrayJob array;
        if (!(words >> array.job >> array.first >> array.last)) continue;
        if (array.first > 0)
            jobs.arrays.push_back(array);
        else
            jobs.merge = array.job;
    }
    return jobs;
}

std::vector<SlurmTask> queued_tasks(const fs::path& archive_dir) {
    const SlurmJobs jobs = read_jobs(archive_dir);
    if (jobs.arrays.empty()) return {};
    std::string ids = jobs.merge;
    for (const ArrayJob& array : jobs.arrays) ids += "," + array.job;
    std::vector<SlurmTask> tasks;
    try {
        std::istringstream lines(
            run_command({"squeue", "--noheader", "--array", "--jobs", ids, "--format", "%F|%K|%T|%r|%N"}).out);
        for (std::string line; std::getline(lines, line);) {
            std::istringstream cells(line);
            std::string job, index;
            SlurmTask task;
            for (std::string* cell : {&job, &index, &task.state, &task.reason, &task.node})
                std::getline(cells, *cell, '|');
            if (task.reason == "None") task.reason.clear();
            int number = 0;
            std::from_chars(index.data(), index.data() + index.size(), number);
            for (const ArrayJob& array : jobs.arrays)
                if (array.job == job) task.shard = array.first - 1 + number;
            task.job = task.shard > 0 ? job + "_" + index : job;
            tasks.push_back(std::move(task));
        }
    } catch (const std::system_error&) {
        return {};
    }
    std::ranges::stable_sort(tasks, {}, &SlurmTask::shard);
    return tasks;
}

}  // namespace lumenline
