// `submit` on a real Slurm, started here on loopback; where there is none, what can be said without.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "tests/cli/cohort_support.h"
#include "tests/cli/hdf_contents.h"
#include "tests/slurm/local_cluster.h"

namespace lumenline::cli_test {
namespace {

namespace fs = std::filesystem;

/// Six models: the four small ones, one that takes seconds, and one that fails.
fs::path cohort_of_six() {
    const fs::path folder = small_cohort();
    const Finished made = run_lumenline(
        {"phantom", "cylinder", "--points-around", "130", "--length", "60", "--jitter", "0.2", "-o", "large.ply"},
        folder);
    EXPECT_EQ(made.status, 0) << made.err;
    write_text(folder / "cohort.yaml", read_text(folder / "cohort.yaml") +
                                           "  - {id: large, surface: large.ply}\n"
                                           "  - {id: lost, surface: missing.stl}\n");
    return folder;
}

/// "2" of "array 2: shards 1 to 4 of 6".
std::string job_of(const std::string& line) {
    const std::size_t blank = line.find(' ');
    return line.substr(blank + 1, line.find(':') - blank - 1);
}

TEST(Submit, ArrayWithATaskKilledAndRequeuedGivesTheArchiveOfAPlainRun) {
    if (const std::string reason = LocalCluster::reason_against(); !reason.empty()) GTEST_SKIP() << reason;
    const fs::path folder = cohort_of_six();
    ASSERT_EQ(run_cohort(folder).status, 1);
    const auto expected = archive_contents(folder / "results");
    fs::remove_all(folder / "results");

    LocalCluster cluster;
    ASSERT_EQ(cluster.wait_until_ready(), "");
    const Finished submitted = run_lumenline({"submit", "cohort.yaml", "--tasks", "6", "--partition", "main", "--time",
                                              "10:00", "--", "--comment=a comment"},
                                             folder);
    ASSERT_EQ(submitted.status, 0) << submitted.err;
    EXPECT_NE(submitted.err.find("1 of 6 surfaces not found"), std::string::npos) << submitted.err;
    const std::vector<std::string> said = lines_of(submitted.out);
    ASSERT_EQ(said.size(), 4U) << submitted.out;
    EXPECT_TRUE(said[0].ends_with(": shards 1 to 4 of 6") && said[1].ends_with(": shards 5 to 6 of 6"))
        << "no index reaches MaxArraySize\n"
        << submitted.out;

    // The largest model is that of the first shard. Its task is killed while it computes, and starts anew.
    const std::string task = job_of(said[0]) + "_1";
    while (run_shell("squeue --noheader --array --states=running --format %i", folder).out.find(task + "\n") ==
               std::string::npos ||
           !fs::exists(folder / "results/runs/1-of-6.lease")) {
        ASSERT_TRUE(cluster.busy());
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    const Finished status = run_lumenline({"status", "cohort.yaml"}, folder);
    EXPECT_NE(status.out.find("slurm job " + task + ", shard 1: RUNNING on "), std::string::npos) << status.out;
    EXPECT_NE(status.out.find(", merge: PENDING (Dependency)"), std::string::npos) << status.out;
    const Finished again = run_lumenline({"submit", "cohort.yaml", "--tasks", "6"}, folder);
    EXPECT_EQ(again.status, 2) << "it is under way";
    ASSERT_EQ(run_shell("scontrol requeue " + task, folder).status, 0);
    while (cluster.busy()) std::this_thread::sleep_for(std::chrono::milliseconds(200));

    const std::string log = read_text(folder / "results/runs" / ("slurm-" + task + ".out"));
    EXPECT_NE(log.find("REQUEUE"), std::string::npos) << log;
    const std::string merged = read_text(folder / "results/runs" / ("slurm-" + job_of(said[2]) + ".out"));
    EXPECT_NE(merged.find("1 failed, 0 missing"), std::string::npos) << merged;
    EXPECT_EQ(hdf_files(folder / "results").size(), 7U);
    EXPECT_EQ(differences(expected, archive_contents(folder / "results")), std::vector<std::string>{});
    EXPECT_TRUE(temporary_files(folder / "results").empty());
    EXPECT_EQ(run_lumenline({"status", "cohort.yaml"}, folder).status, 1) << "done, with a failure";

    const Finished refused = run_lumenline({"submit", "cohort.yaml", "--tasks", "2", "--partition", "nowhere"}, folder);
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.err.find("sbatch does not take the job"), std::string::npos) << refused.err;
    EXPECT_EQ(run_shell("squeue --noheader", folder).out, "");
}

TEST(Submit, PrintShowsScriptsThatAShellUnderstandsAndWritesNothing) {
    const fs::path odd = fresh_folder() / "it's 100% odd";
    fs::create_directories(odd);
    write_text(odd / "cohort.yaml",
               "cohort: some name\nmodels:\n  - {id: a, surface: a.stl}\n  - {id: b, surface: b.stl}\n");
    const Finished print = run_lumenline({"submit", "cohort.yaml", "--tasks", "5", "--mem", "4G", "--cpus-per-task",
                                          "2", "--print", "--", "--comment", "two words"},
                                         odd);
    ASSERT_EQ(print.status, 0) << print.err;
    for (const char* line :
         {"#SBATCH --job-name=some_name-run", "#SBATCH --job-name=some_name-merge", "#SBATCH --array=1-2",
          "#SBATCH --requeue", "#SBATCH --mem=4G", "#SBATCH --cpus-per-task=2", "#SBATCH --comment \"two words\"",
          "100%% odd/results/runs/slurm-%A_%a.out\"", "--shard \"$SLURM_ARRAY_TASK_ID/2\" --wait"})
        EXPECT_NE(print.out.find(line), std::string::npos) << line << "\n" << print.out;
    EXPECT_FALSE(fs::exists(odd / "results"));
    write_text(odd / "scripts.sh", print.out);
    EXPECT_EQ(run_shell("sh -n scripts.sh", odd).status, 0);
    // With the program's name alone exchanged, the words that the shell makes of it.
    const Finished words = run_shell(
        "SLURM_ARRAY_TASK_ID=2 sh <(sed -n '/^exec/,$p' scripts.sh | sed \"s/^exec '[^']*'/echo/\" | head -2)", odd);
    EXPECT_EQ(words.out, "run cohort.yaml --shard 2/2 --wait --threads 1\n") << words.err;
}

TEST(Submit, WhatIsWrongIsSaidBeforeAnythingIsWritten) {
    const fs::path folder = small_cohort();
    EXPECT_EQ(run_lumenline({"submit", "cohort.yaml"}, folder).status, 2);
    EXPECT_EQ(run_lumenline({"submit", "cohort.yaml", "--tasks", "0"}, folder).status, 2);
    EXPECT_EQ(run_lumenline({"submit", "absent.yaml", "--tasks", "2"}, folder).status, 2);
    EXPECT_EQ(run_lumenline({"submit", "cohort.yaml", "--tasks", "2", "--account=x"}, folder).status, 2)
        << "options of sbatch stand behind --";
    const Finished no_slurm =
        run_shell("PATH=/nowhere '" + std::string(LUMENLINE_BINARY) + "' submit cohort.yaml --tasks 2", folder);
    EXPECT_EQ(no_slurm.status, 2);
    EXPECT_NE(no_slurm.err.find("this machine has no sbatch"), std::string::npos) << no_slurm.err;
    EXPECT_FALSE(fs::exists(folder / "results"));
}

}  // namespace
}  // namespace lumenline::cli_test
