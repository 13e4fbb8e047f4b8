// What a second run does over the results of a first. A file is written anew by a rename, so its inode tells whether
// a model was computed again; no clock is asked.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <map>

#include "tests/cli/cohort_support.h"
#include "tests/cli/hdf_contents.h"

namespace lumenline::cli_test {
namespace {

namespace fs = std::filesystem;

using Inodes = std::map<std::string, ino_t>;

Inodes inodes(const fs::path& folder) {
    Inodes found;
    for (const auto& entry : fs::directory_iterator(folder / "results/models")) {
        if (entry.path().extension() != ".hdf") continue;
        struct stat status {};
        EXPECT_EQ(::stat(entry.path().c_str(), &status), 0);
        found[entry.path().stem().string()] = status.st_ino;
    }
    return found;
}

/// Ids of the files that `run` made anew.
template <class Body>
std::vector<std::string> rewritten(const fs::path& folder, const Body& run) {
    // Links keep the old files, lest a new one get the inode of one that is gone.
    const fs::path kept = folder / "kept";
    fs::remove_all(kept);
    fs::create_directories(kept);
    for (const auto& entry : fs::directory_iterator(folder / "results/models"))
        fs::create_hard_link(entry.path(), kept / entry.path().filename());
    const Inodes before = inodes(folder);
    run();
    std::vector<std::string> ids;
    for (const auto& [id, inode] : inodes(folder))
        if (const auto known = before.find(id); known == before.end() || known->second != inode) ids.push_back(id);
    fs::remove_all(kept);
    return ids;
}

std::vector<std::string> rerun(const fs::path& folder, int status = 0, const std::vector<std::string>& arguments = {}) {
    return rewritten(folder, [&] {
        const Finished run = run_cohort(folder, arguments);
        EXPECT_EQ(run.status, status) << run.out << run.err;
    });
}

void replace(const fs::path& file, const std::string& from, const std::string& to) {
    std::string text = read_text(file);
    ASSERT_NE(text.find(from), std::string::npos) << from;
    write_text(file, text.replace(text.find(from), from.size(), to));
}

using Ids = std::vector<std::string>;
const Ids kAll{"bend", "coil", "narrow", "tube"};

TEST(Resume, WhatIsDoneIsNotDoneTwiceAndTheIndexStaysTheSame) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder).status, 0);
    const auto index = hdf_contents(folder / "results/cohort.h5");
    fs::remove(folder / "results/cohort.h5");
    // Neither the times of the surfaces nor the threads play a part.
    for (const char* surface : {"tube.ply", "bend.ply"})
        fs::last_write_time(folder / surface, fs::file_time_type::clock::now() + std::chrono::hours(1));
    EXPECT_EQ(rerun(folder, 0, {"--threads", "1"}), Ids{});
    EXPECT_EQ(differences(index, hdf_contents(folder / "results/cohort.h5")), Ids{});
    // And beside an index that stands, with all rows of its tables, whether it is made anew or not.
    replace(folder / "cohort.yaml", "length_unit: mm", "# a remark\nlength_unit: mm");
    EXPECT_NE(run_cohort(folder).out.find("(4 of them before)"), std::string::npos);
    auto remarked = hdf_contents(folder / "results/cohort.h5");
    EXPECT_NE(remarked.at("/config/given"), index.at("/config/given"));
    remarked["/config/given"] = index.at("/config/given");
    EXPECT_EQ(differences(index, remarked), Ids{});
    replace(folder / "cohort.yaml", "# a remark\n", "");
    run_cohort(folder);
    EXPECT_NE(run_cohort(folder).out.find("(4 of them before)"), std::string::npos);
    EXPECT_EQ(differences(index, hdf_contents(folder / "results/cohort.h5")), Ids{});
}

TEST(Resume, ChangesRedoExactlyTheModelsConcerned) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder).status, 0);
    replace(folder / "cohort.yaml", "inlets: [[0, 0, 0]]", "inlets: [[0, 0, 30]]");
    EXPECT_EQ(rerun(folder), Ids{"tube"}) << "the points of one model";
    make_phantom_file(folder / "bend.ply", {"torus", "--turns", "0.3"});
    EXPECT_EQ(rerun(folder), Ids{"bend"}) << "its surface";
    replace(folder / "cohort.yaml", "surface: coil.ply", "surface: coil.ply, scale: 2");
    EXPECT_EQ(rerun(folder), Ids{"coil"}) << "its scale";
    replace(folder / "cohort.yaml", "group: straight", "group: upright");
    replace(folder / "cohort.yaml", "age: 63", "age: 64");
    EXPECT_EQ(rerun(folder), Ids{}) << "labels determine no result";
    const auto index = hdf_contents(folder / "results/cohort.h5");
    EXPECT_NE(index.at("/tables/models/group").find("upright"), std::string::npos) << "but the tables have them";
    replace(folder / "cohort.yaml", "models:", "characterize: false\nmodels:");
    EXPECT_EQ(rerun(folder), kAll) << "an option of all";
    replace(folder / "cohort.yaml", "models:", "archive: {precision: float64}\nmodels:");
    EXPECT_EQ(rerun(folder), kAll) << "the format";
    replace(folder / "cohort.yaml", "length_unit: mm", "length_unit: cm");
    EXPECT_EQ(rerun(folder), kAll) << "the unit on every dataset";
    EXPECT_EQ(rerun(folder), Ids{});
}

TEST(Resume, LostDamagedAndForeignFilesAreMadeAnew) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder).status, 0);
    const fs::path models = folder / "results/models";
    const auto whole = hdf_contents(models / "tube.hdf");
    fs::remove(models / "tube.hdf");
    write_text(models / "bend.hdf", "no model");
    fs::copy_file(models / "coil.hdf", models / "narrow.hdf", fs::copy_options::overwrite_existing);
    write_text(models / "tube.hdf.tmp", "what a killed run leaves behind");
    EXPECT_EQ(rerun(folder), (Ids{"bend", "narrow", "tube"}));
    EXPECT_EQ(differences(whole, hdf_contents(models / "tube.hdf")), Ids{});
    EXPECT_TRUE(temporary_files(folder).empty());
}

TEST(Resume, LeftOversGoEvenIfNothingRuns) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder).status, 0);
    write_text(folder / "results/models/tube.hdf.tmp", "half a model");
    write_text(folder / "results/cohort.h5.tmp", "half an index");
    write_text(folder / "results/models/elsewhere.hdf.tmp", "of no model of this cohort");
    EXPECT_EQ(rerun(folder), Ids{});
    EXPECT_EQ(temporary_files(folder), Ids{(folder / "results/models/elsewhere.hdf.tmp").string()});
}

TEST(Resume, FailuresStandUntilTheyAreRetriedOrTheirInputsChange) {
    const fs::path folder = small_cohort();
    const std::string good = read_text(folder / "bend.ply");
    write_text(folder / "bend.ply", "ply\nformat ascii 1.0\nelement vertex -1\n");
    fs::remove(folder / "coil.ply");
    ASSERT_EQ(run_cohort(folder).status, 1);
    EXPECT_EQ(rerun(folder, 1), Ids{}) << "known failures count, but are not computed again";
    EXPECT_EQ(rerun(folder, 1, {"--retry-failed", "--only", "bend"}), Ids{"bend"});
    EXPECT_EQ(rerun(folder, 1, {"--retry-failed"}), (Ids{"bend", "coil"}));
    write_text(folder / "bend.ply", good);
    EXPECT_EQ(rerun(folder, 1), Ids{"bend"});
    EXPECT_NE(get_attribute(folder, "results", "bend", "status"), "failed");
}

TEST(Resume, WhatLackedTimeIsTriedAgainByTheNextRun) {
    const fs::path folder = small_cohort();
    const std::string plain = read_text(folder / "cohort.yaml");
    write_text(folder / "cohort.yaml", "run: {model_timeout: 0.000001 s}\n" + plain);
    ASSERT_EQ(run_cohort(folder).status, 1);
    EXPECT_EQ(get_attribute(folder, "results", "tube", "failure_code"), "timeout");
    EXPECT_NE(get_attribute(folder, "results", "tube", "failure_sentence").find("run.model_timeout"),
              std::string::npos);
    EXPECT_NE(run_cohort(folder, {"--dry-run"}).out.find("4 would run"), std::string::npos);
    write_text(folder / "cohort.yaml", plain);
    EXPECT_EQ(rerun(folder), kAll);
}

TEST(Resume, LittleMemoryChangesNothingButTheOrder) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder).status, 0);
    fs::rename(folder / "results", folder / "whole");
    write_text(folder / "cohort.yaml", "run: {memory: 1 MB}\n" + read_text(folder / "cohort.yaml"));
    ASSERT_EQ(run_cohort(folder).status, 0) << "every model is larger than that and runs alone";
    for (const std::string& id : kAll)
        EXPECT_EQ(differences(hdf_contents(folder / "whole/models" / (id + ".hdf")),
                              hdf_contents(folder / "results/models" / (id + ".hdf"))),
                  Ids{});
    fs::remove_all(folder / "results");
    fs::rename(folder / "whole", folder / "results");
    EXPECT_EQ(rerun(folder), Ids{}) << "limits determine no result";
}

TEST(Resume, DryRunSaysWhatWouldRunAndWhyAndWritesNothing) {
    const fs::path folder = small_cohort();
    const Finished fresh = run_cohort(folder, {"--dry-run"});
    EXPECT_EQ(fresh.status, 0) << fresh.err;
    EXPECT_NE(fresh.out.find("4 would run, 0 done"), std::string::npos) << fresh.out;
    EXPECT_FALSE(fs::exists(folder / "results"));

    write_text(folder / "coil.ply", "ply\nno surface\n");
    ASSERT_EQ(run_cohort(folder).status, 1);
    make_phantom_file(folder / "bend.ply", {"torus", "--turns", "0.3"});
    fs::remove(folder / "results/models/narrow.hdf");
    const Finished next = run_cohort(folder, {"--dry-run"});
    const std::map<std::string, std::string> reasons{{"tube", "it is done"},
                                                     {"bend", "its surface has changed"},
                                                     {"coil", "it failed in load (file_format)"},
                                                     {"narrow", "it has no file yet"}};
    for (const auto& [id, reason] : reasons) {
        bool found = false;
        for (const std::string& line : lines_of(next.out))
            found = found || (line.starts_with(id + " ") && line.ends_with(reason));
        EXPECT_TRUE(found) << id << "\n" << next.out;
    }
    EXPECT_NE(next.out.find("2 would run, 1 done, 1 failed before"), std::string::npos) << next.out;
    EXPECT_FALSE(fs::exists(folder / "results/models/narrow.hdf"));
    replace(folder / "cohort.yaml", "models:", "centerlines: {refine: none}\nmodels:");
    EXPECT_NE(run_cohort(folder, {"--dry-run"}).out.find("options, format or program have changed"), std::string::npos);
}

TEST(Resume, SecondRunOnAHeldArchiveIsToldWhoHoldsIt) {
    const fs::path folder = small_cohort();
    // A lease of another machine that has just shown that it lives.
    fs::create_directories(folder / "results/runs");
    write_text(folder / "results/runs/1-of-1.lease",
               "host=elsewhere\nprocess=4711\nsince=2026-01-31 12:00:00 UTC\nboot=another\n");
    const Finished run = run_cohort(folder);
    EXPECT_EQ(run.status, 2);
    EXPECT_EQ(lines_of(run.err).size(), 1U) << run.err;
    EXPECT_NE(run.err.find("process 4711 on elsewhere since 2026-01-31 12:00:00 UTC"), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(folder / "results/models/tube.hdf"));
    fs::last_write_time(folder / "results/runs/1-of-1.lease", fs::file_time_type::clock::now() - std::chrono::hours(1));
    const Finished next = run_cohort(folder);
    EXPECT_EQ(next.status, 0) << next.err;
    EXPECT_NE(next.err.find("has expired"), std::string::npos) << next.err;
    EXPECT_FALSE(fs::exists(folder / "results/runs/1-of-1.lease")) << "given back";
}

}  // namespace
}  // namespace lumenline::cli_test
