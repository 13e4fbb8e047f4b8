// Shards against the run of all: what each computes, that together they give the same archive, and what `merge` and
// `status` say on the way.
#include <gtest/gtest.h>

#include <set>

#include "tests/cli/cohort_support.h"
#include "tests/cli/hdf_contents.h"

namespace lumenline::cli_test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kIds{"tube", "bend", "coil", "narrow"};

std::set<std::string> ids_in(const fs::path& archive) {
    std::set<std::string> ids;
    for (const auto& entry : fs::directory_iterator(archive / "models")) ids.insert(entry.path().stem().string());
    return ids;
}

Finished verb(const fs::path& folder, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin() + 1, "cohort.yaml");
    return run_lumenline(arguments, folder);
}

TEST(Shards, TogetherTheyAreTheRunOfAll) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder).status, 0);
    const auto whole = archive_contents(folder / "results");
    fs::remove_all(folder / "results");
    std::set<std::string> before;
    for (const char* shard : {"3/3", "1/3", "2/3"}) {
        const Finished run = run_cohort(folder, {"--shard", shard});
        EXPECT_EQ(run.status, 0) << run.err;
        const std::set<std::string> after = ids_in(folder / "results");
        EXPECT_GT(after.size(), before.size()) << shard << " has a share";
        before = after;
        EXPECT_FALSE(fs::exists(folder / "results/cohort.h5")) << "left to merge";
    }
    EXPECT_EQ(before.size(), kIds.size());
    const Finished merge = verb(folder, {"merge"});
    EXPECT_EQ(merge.status, 0) << merge.err;
    EXPECT_NE(merge.out.find("0 failed, 0 missing"), std::string::npos) << merge.out;
    EXPECT_EQ(differences(whole, archive_contents(folder / "results")), std::vector<std::string>{});
    EXPECT_TRUE(temporary_files(folder).empty());
}

TEST(Shards, AssignmentStandsWhenSurfacesChange) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder, {"--shard", "1/2"}).status, 0);
    const std::string frozen = read_text(folder / "results/shards.tsv");
    EXPECT_EQ(lines_of(frozen).size(), 1 + kIds.size());
    make_phantom_file(folder / "tube.ply", {"cylinder", "--b", "4", "--length", "90"});
    ASSERT_EQ(run_cohort(folder, {"--shard", "2/2"}).status, 0);
    EXPECT_EQ(read_text(folder / "results/shards.tsv"), frozen);
    // Another number of shards is another assignment.
    ASSERT_EQ(run_cohort(folder, {"--shard", "1/4"}).status, 0);
    EXPECT_NE(read_text(folder / "results/shards.tsv"), frozen);
}

TEST(Shards, WrongShardsAreRefused) {
    const fs::path folder = small_cohort();
    for (const char* shard : {"0/2", "3/2", "1", "1/", "/2", "a/b", "1/2/3", "-1/2", "1/0"}) {
        const Finished run = run_cohort(folder, {std::string("--shard=") + shard});
        EXPECT_EQ(run.status, 2) << shard << run.out;
        EXPECT_NE(run.err.find("--shard"), std::string::npos) << run.err;
    }
    EXPECT_FALSE(fs::exists(folder / "results"));
}

TEST(Merge, MissingModelsAreStatusThreeAndTheIndexHoldsTheRest) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder, {"--only", "tube", "--only", "coil"}).status, 0);
    fs::remove(folder / "results/cohort.h5");
    const Finished merge = verb(folder, {"merge"});
    EXPECT_EQ(merge.status, 3) << merge.err;
    EXPECT_NE(merge.out.find("2 missing"), std::string::npos) << merge.out;
    EXPECT_EQ(lines_of(run_lumenline({"browse", "results"}, folder).out).size(), 3U);
}

TEST(Merge, WaitsForNobodyUnlessAsked) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder, {"--only", "tube"}).status, 0);
    write_text(folder / "results/runs/2-of-3.lease", "host=elsewhere\nprocess=4711\nsince=2026-01-31 12:00:00 UTC\n");
    const Finished merge = verb(folder, {"merge"});
    EXPECT_EQ(merge.status, 2);
    EXPECT_NE(merge.err.find("shard 2/3"), std::string::npos) << merge.err;
}

TEST(Status, SaysWhatIsDoneFailedAndLeft) {
    const fs::path folder = small_cohort();
    const Finished fresh = verb(folder, {"status"});
    EXPECT_EQ(fresh.status, 3) << fresh.err;
    EXPECT_NE(fresh.out.find("small: 0 ok, 0 with warnings, 0 failed, 4 pending of 4 models"), std::string::npos)
        << fresh.out;
    EXPECT_FALSE(fs::exists(folder / "results")) << "status writes nothing";

    write_text(folder / "bend.ply", "ply\nno surface\n");
    ASSERT_EQ(run_cohort(folder, {"--only", "bend", "--only", "tube"}).status, 1);
    write_text(folder / "results/models/coil.hdf", "no model");
    const Finished half = verb(folder, {"status"});
    EXPECT_EQ(half.status, 3);
    EXPECT_NE(half.out.find("1 failed, 2 pending of 4"), std::string::npos) << half.out;
    for (const char* word : {"bend", "file_format", "narrow", "no file yet", "cannot be used", "left: about"})
        EXPECT_NE(half.out.find(word), std::string::npos) << word << "\n" << half.out;

    ASSERT_EQ(run_cohort(folder).status, 1);
    EXPECT_EQ(verb(folder, {"status"}).status, 1);
    make_phantom_file(folder / "bend.ply", {"torus", "--turns", "0.25"});
    ASSERT_EQ(run_cohort(folder).status, 0);
    EXPECT_EQ(verb(folder, {"status"}).status, 0);
    write_text(folder / "cohort.yaml", "characterize: false\n" + read_text(folder / "cohort.yaml"));
    EXPECT_NE(verb(folder, {"status"}).out.find("0 failed, 4 pending of 4"), std::string::npos)
        << "a changed option makes all of them pending";
}

TEST(Status, JsonHoldsRunsFailuresAndCounts) {
    const fs::path folder = small_cohort();
    write_text(folder / "bend.ply", "ply\nno \"surface\"\n");
    ASSERT_EQ(run_cohort(folder, {"--only", "bend"}).status, 1);
    write_text(folder / "results/runs/1-of-1.lease", "host=elsewhere\nprocess=4711\nsince=2026-01-31 12:00:00 UTC\n");
    const Finished json = verb(folder, {"status", "--json"});
    EXPECT_EQ(json.status, 3);
    // Read by a parser that is not ours.
    const Finished read =
        run_shell("'" + std::string(LUMENLINE_BINARY) +
                      "' status cohort.yaml --json | python3 -c '"
                      "import json,sys; s = json.load(sys.stdin);"
                      "print(s[\"models\"], s[\"failed\"], s[\"pending\"], s[\"failures\"][0][\"code\"],"
                      " s[\"runs\"][0][\"host\"], s[\"runs\"][0][\"alive\"])'; true",
                  folder);
    if (read.out.empty()) GTEST_SKIP() << "no python3 here: " << read.err;
    EXPECT_EQ(read.out, "4 1 3 file_format elsewhere True\n") << json.out;
}

}  // namespace
}  // namespace lumenline::cli_test
