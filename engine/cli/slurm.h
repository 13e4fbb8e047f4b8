#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lumenline {

/// What is asked of Slurm.
struct SlurmRequest {
    int tasks = 1;                                ///< shards, one array task each
    std::string partition, time, memory;          ///< as sbatch takes them; empty = the cluster's default
    std::string cpus;                             ///< of a task
    std::vector<std::string> more;                ///< further options of sbatch, for every job
    std::filesystem::path program, logs, folder;  ///< absolute; jobs run in `folder`
    std::filesystem::path cohort;                 ///< as given, from `folder`: sentences on failures name its files
    std::string name;                             ///< of the cohort
};

/// Shards `first` to `last` in one array; its indices count from 1.
struct ArrayJob {
    std::string job;  ///< Slurm's number; empty before it is submitted
    int first = 1, last = 1;
};

/// Cuts shards 1 to `tasks` into arrays of fewer than `max_array_size` tasks: indices end below that.
std::vector<ArrayJob> cut_into_arrays(int tasks, int max_array_size);

/// Batch script of an array of shards, and of the merge behind it.
std::string array_script(const SlurmRequest& request, const ArrayJob& array);
std::string merge_script(const SlurmRequest& request);

/// MaxArraySize of the cluster; Slurm's default where it cannot be asked.
int max_array_size();

/// Submits a script. @param dependency  "afterany:12:13", or empty
/// @returns the job's number
/// @throws std::runtime_error with what sbatch said
std::string submit_script(const std::string& script, const std::string& dependency);

/// The jobs of an archive, kept in `runs/slurm.tsv`.
struct SlurmJobs {
    std::vector<ArrayJob> arrays;
    std::string merge;
};
void write_jobs(const std::filesystem::path& archive_dir, const SlurmJobs& jobs);
SlurmJobs read_jobs(const std::filesystem::path& archive_dir);

/// A job of an archive that waits or runs.
struct SlurmTask {
    std::string job;  ///< "12_3"
    int shard = 0;    ///< 0 = the merge
    std::string state, reason, node;
};

/// Those of an archive, by shard; none where nothing was submitted or squeue does not answer.
std::vector<SlurmTask> queued_tasks(const std::filesystem::path& archive_dir);

}  // namespace lumenline
