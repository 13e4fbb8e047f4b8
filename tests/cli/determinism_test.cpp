// The matrix of everything that must not change a result: number of threads, worker processes, shards.
#include <gtest/gtest.h>

#include "tests/cli/cohort_support.h"
#include "tests/cli/hdf_contents.h"

namespace lumenline::cli_test {
namespace {

namespace fs = std::filesystem;

/// Runs the cohort of `folder`, in one process or shard by shard from the last to the first.
void run_way(const fs::path& folder, const std::vector<std::string>& options, int shards) {
    if (shards == 1) {
        EXPECT_EQ(run_cohort(folder, options).status, 1) << "junk fails";
        return;
    }
    for (int shard = shards; shard > 0; --shard) {
        std::vector<std::string> all = options;
        all.insert(all.end(), {"--shard", std::to_string(shard) + "/" + std::to_string(shards)});
        const Finished run = run_cohort(folder, all);
        EXPECT_TRUE(run.status == 0 || run.status == 1) << run.err;
    }
    EXPECT_EQ(run_lumenline({"merge", "cohort.yaml"}, folder).status, 1);
}

TEST(Determinism, ThreadsWorkersAndShardsChangeNoDataset) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(
        run_lumenline({"phantom", "tree", "--leaves", "4", "--points-around", "12", "-o", "tree.ply"}, folder).status,
        0);
    write_text(folder / "junk.stl", "no surface\n");
    write_text(folder / "cohort.yaml", read_text(folder / "cohort.yaml") +
                                           "  - {id: tree, surface: tree.ply}\n"
                                           "  - {id: junk, surface: junk.stl}\n");
    std::map<std::string, std::string> expected;
    for (const char* threads : {"1", "2", "3", "8"})
        for (const char* isolation : {"none", "process"})
            for (const int shards : {1, 5}) {
                SCOPED_TRACE(std::string(threads) + " threads, isolation " + isolation + ", " + std::to_string(shards) +
                             " shards");
                fs::remove_all(folder / "results");
                run_way(folder, {"--threads", threads, "--isolation", isolation}, shards);
                ASSERT_EQ(hdf_files(folder / "results").size(), 7U);
                const auto found = archive_contents(folder / "results");
                if (expected.empty()) expected = found;
                EXPECT_EQ(differences(expected, found), std::vector<std::string>{});
            }
}

TEST(Determinism, FolderThatTheProgramIsStartedInChangesNoDataset) {
    const fs::path folder = small_cohort();
    write_text(folder / "junk.stl", "no surface\n");
    write_text(folder / "cohort.yaml", read_text(folder / "cohort.yaml") +
                                           "  - {id: junk, surface: junk.stl}\n"
                                           "  - {id: lost, surface: missing.stl}\n");
    ASSERT_EQ(run_cohort(folder).status, 1);
    const auto expected = archive_contents(folder / "results");
    for (const fs::path& cohort : {folder / "cohort.yaml", folder.filename() / "cohort.yaml"}) {
        fs::remove_all(folder / "results");
        ASSERT_EQ(run_lumenline({"run", cohort.string()}, folder.parent_path()).status, 1);
        EXPECT_EQ(differences(expected, archive_contents(folder / "results")), std::vector<std::string>{}) << cohort;
    }
}

}  // namespace
}  // namespace lumenline::cli_test
