// Whole runs of small cohorts: what is printed, what is written, and that neither order nor threads show in it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "tests/cli/cohort_support.h"
#include "tests/cli/hdf_contents.h"

namespace lumenline::cli_test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kIds{"tube", "bend", "coil", "narrow"};

fs::path model_file(const fs::path& folder, const std::string& id) { return folder / "results/models" / (id + ".hdf"); }

/// Lines of `text` that hold `word`.
std::size_t lines_with(const std::string& text, const std::string& word) {
    std::size_t count = 0;
    for (const std::string& line : lines_of(text)) count += line.find(word) != std::string::npos ? 1 : 0;
    return count;
}

TEST(Run, GoodCohortIsComplete) {
    const fs::path folder = small_cohort();
    const Finished run = run_cohort(folder);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(fs::exists(folder / "results/cohort.h5"));
    for (const std::string& id : kIds) {
        EXPECT_TRUE(fs::exists(model_file(folder, id))) << id;
        EXPECT_EQ(lines_with(run.out, id + " "), 1U) << run.out;
        EXPECT_NE(get_attribute(folder, "results", id, "status"), "failed");
    }
    EXPECT_NE(run.out.find("0 failed"), std::string::npos) << run.out;
    EXPECT_NE(run.err.find("4 of 4 models"), std::string::npos) << run.err;
    EXPECT_EQ(run.err.find('\r'), std::string::npos) << "a progress line for terminals was written to a file";
    EXPECT_TRUE(temporary_files(folder).empty());
}

TEST(Run, BrowseGivesTheNumbersOfThePhantoms) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder).status, 0);
    const Finished list = run_lumenline({"browse", "results", "list"}, folder);
    EXPECT_EQ(list.status, 0);
    EXPECT_EQ(list.out, run_lumenline({"browse", "results"}, folder).out);
    ASSERT_EQ(lines_of(list.out).size(), 1 + kIds.size()) << list.out;
    for (std::size_t i = 0; i < kIds.size(); ++i)
        EXPECT_EQ(lines_of(list.out)[i + 1].rfind(kIds[i], 0), 0U) << "the order of the cohort\n" << list.out;

    const Finished show = run_lumenline({"browse", "results", "show", "tube"}, folder);
    EXPECT_EQ(show.status, 0);
    for (const char* word : {"inlet", "outlet", "boundary", "status", "mm", "tube.ply"})
        EXPECT_NE(show.out.find(word), std::string::npos) << word << "\n" << show.out;

    const std::vector<double> points = get_numbers(folder, "results", "tube", "/centerlines/points");
    const std::vector<double> radius = get_numbers(folder, "results", "tube", "/centerlines/radius");
    const std::vector<double> abscissa = get_numbers(folder, "results", "tube", "/centerlines/abscissa");
    ASSERT_GE(radius.size(), 2U);
    ASSERT_EQ(points.size(), 3 * radius.size());
    ASSERT_EQ(abscissa.size(), radius.size());
    // The elliptic tube has the axis x = y = 0 from z = 0 to z = 30 and the inscribed radius 4. An edge is 2 long:
    // chords and balls of so coarse a section are off by about edge^2 / (8 b) = 0.12, jitter as much again.
    EXPECT_NEAR(points[2], 0, 1e-6);
    EXPECT_NEAR(points[points.size() - 1], 30, 1e-6);
    EXPECT_NEAR(abscissa.back(), 30, 0.5);
    for (std::size_t i = 0; i < radius.size(); ++i) EXPECT_NEAR(radius[i], 4, 0.4) << "at point " << i;
    EXPECT_NEAR(get_numbers(folder, "results", "bend", "/centerlines/abscissa").back(), 20 * 1.5707963, 0.8);

    // The same number through the file itself, and through the table of the index.
    EXPECT_EQ(get_numbers(folder, "results/models/tube.hdf", "tube", "/centerlines/radius"), radius);
    EXPECT_EQ(get_attribute(folder, "results", "bend", "structure"), "");
}

TEST(Run, BrowseNamesTheNearestWhenThereIsNoSuchThing) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder, {"--only", "tube"}).status, 0);
    const std::vector<std::vector<std::string>> requests{
        {"browse", "nowhere"},
        {"browse", "results", "show", "tubes"},
        {"browse", "results", "get", "tube", "/centerlines/radios"},
        {"browse", "results", "get", "tube", "/@staus"},
    };
    for (const auto& request : requests) {
        const Finished got = run_lumenline(request, folder);
        EXPECT_EQ(got.status, 2) << got.err;
        EXPECT_EQ(got.out, "");
        EXPECT_EQ(lines_of(got.err).size(), 1U) << got.err;
    }
    EXPECT_NE(run_lumenline(requests[1], folder).err.find("'tube'"), std::string::npos);
    EXPECT_NE(run_lumenline(requests[2], folder).err.find("/centerlines/radius"), std::string::npos);
}

TEST(Run, BadFilesFailAloneWithOneSentenceThatNamesThem) {
    const fs::path folder = small_cohort();
    const std::string whole = read_text(folder / "tube.ply");
    write_text(folder / "truncated.ply", whole.substr(0, whole.size() / 2));
    write_text(folder / "garbage.stl", "this is no surface\n");
    std::ofstream(folder / "cohort.yaml", std::ios::app) << "  - {id: lost, surface: missing.ply}\n"
                                                            "  - {id: junk, surface: garbage.stl}\n"
                                                            "  - {id: half, surface: truncated.ply}\n";
    const Finished run = run_cohort(folder);
    EXPECT_EQ(run.status, 1) << run.err;
    EXPECT_NE(run.out.find("3 failed"), std::string::npos) << run.out;
    const std::vector<std::array<std::string, 3>> bad{{"lost", "missing.ply", "file_unreadable"},
                                                      {"junk", "garbage.stl", "file_format"},
                                                      {"half", "truncated.ply", "file_format"}};
    for (const auto& [id, file, code] : bad) {
        EXPECT_EQ(lines_with(run.err, file), 1U) << run.err;
        EXPECT_EQ(get_attribute(folder, "results", id, "status"), "failed");
        EXPECT_EQ(get_attribute(folder, "results", id, "failure_stage"), "load");
        EXPECT_EQ(get_attribute(folder, "results", id, "failure_code"), code);
        EXPECT_NE(get_attribute(folder, "results", id, "failure_sentence").find(file), std::string::npos);
        EXPECT_NE(run_lumenline({"browse", "results", "show", id}, folder).out.find("failed: "), std::string::npos);
    }
    for (const std::string& id : kIds) {
        EXPECT_NE(get_attribute(folder, "results", id, "status"), "failed");
        EXPECT_FALSE(get_numbers(folder, "results", id, "/centerlines/radius").empty());
    }
}

TEST(Run, FileMadeGoodIsNoFailureAnyMore) {
    const fs::path folder = small_cohort();
    fs::rename(folder / "bend.ply", folder / "away.ply");
    EXPECT_EQ(run_cohort(folder).status, 1);
    fs::rename(folder / "away.ply", folder / "bend.ply");
    EXPECT_EQ(run_cohort(folder, {"--only", "bend"}).status, 0);
    EXPECT_NE(get_attribute(folder, "results", "bend", "status"), "failed");
    const Finished list = run_lumenline({"browse", "results"}, folder);
    EXPECT_EQ(lines_with(list.out, "failed"), 0U) << list.out;
}

TEST(Run, ConfigurationErrorNamesFileLineAndNearestKeyAndWritesNothing) {
    const fs::path folder = small_cohort();
    write_text(folder / "cohort.yaml", "cohort: small\nlenght_unit: mm\nmodels: [{id: tube, surface: tube.ply}]\n");
    const Finished run = run_cohort(folder);
    EXPECT_EQ(run.status, 2);
    EXPECT_EQ(run.out, "");
    ASSERT_EQ(lines_of(run.err).size(), 1U) << run.err;
    EXPECT_EQ(run.err.rfind("cohort.yaml:2: ", 0), 0U) << run.err;
    EXPECT_NE(run.err.find("length_unit"), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(folder / "results"));
    EXPECT_EQ(run_lumenline({"run", "absent.yaml"}, folder).status, 2);
}

TEST(Run, OnlyComputesTheNamedModels) {
    const fs::path folder = small_cohort();
    EXPECT_EQ(run_cohort(folder, {"--only", "coil", "--only", "tube"}).status, 0);
    EXPECT_TRUE(fs::exists(model_file(folder, "coil")) && fs::exists(model_file(folder, "tube")));
    EXPECT_FALSE(fs::exists(model_file(folder, "bend")) || fs::exists(model_file(folder, "narrow")));
    const auto before = hdf_contents(model_file(folder, "coil"), {});
    const Finished second = run_cohort(folder, {"--only", "bend"});
    EXPECT_EQ(second.status, 0);
    EXPECT_TRUE(differences(before, hdf_contents(model_file(folder, "coil"), {})).empty()) << "untouched";
    EXPECT_EQ(lines_of(run_lumenline({"browse", "results"}, folder).out).size(), 4U) << "three models and a heading";
}

TEST(Run, OnlyWithAnUnknownModelIsRefused) {
    const fs::path folder = small_cohort();
    const Finished run = run_cohort(folder, {"--only", "tube", "--only", "nobody"});
    EXPECT_EQ(run.status, 2);
    EXPECT_NE(run.err.find("nobody"), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(folder / "results"));
}

TEST(Run, OnlyNamedTwiceIsComputedOnce) {
    const fs::path folder = small_cohort();
    const Finished run = run_cohort(folder, {"--only", "tube", "--only", "tube"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(lines_with(run.out, "tube "), 1U) << run.out;
    EXPECT_NE(run.err.find("1 of 1 models"), std::string::npos) << run.err;
}

TEST(Run, ThreadsAndRepetitionChangeNothing) {
    const fs::path folder = small_cohort();
    std::map<std::string, std::map<std::string, std::string>> first;
    for (const char* threads : {"1", "4", "4", "2"}) {
        fs::remove_all(folder / "results");
        ASSERT_EQ(run_cohort(folder, {"--threads", threads}).status, 0);
        for (const std::string& id : kIds) {
            const auto contents = hdf_contents(model_file(folder, id));
            ASSERT_TRUE(contents.contains("/centerlines/points") && contents.contains("/voronoi/arrival_time"));
            const auto [known, added] = first.emplace(id, contents);
            const auto names = differences(known->second, contents);
            EXPECT_TRUE(names.empty()) << id << " with " << threads << " threads differs in " << names.front();
        }
        const auto index = hdf_contents(folder / "results/cohort.h5");
        const auto [known, added] = first.emplace("cohort.h5", index);
        const auto names = differences(known->second, index);
        EXPECT_TRUE(names.empty()) << "the index differs in " << names.front();
    }
}

TEST(Run, ComparisonSeesADifferentModel) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder).status, 0);
    const auto tube = hdf_contents(model_file(folder, "tube")), bend = hdf_contents(model_file(folder, "bend"));
    EXPECT_GT(differences(tube, bend).size(), 20U);
    auto changed = tube;
    changed["/centerlines/radius"].back() ^= 1;
    EXPECT_EQ(differences(tube, changed), std::vector<std::string>{"/centerlines/radius"});
    changed = tube;
    changed.erase("/@status");
    EXPECT_EQ(differences(changed, tube).size(), 1U);
    EXPECT_FALSE(tube.contains("/timing/seconds") || tube.contains("/provenance/host"));
}

TEST(Run, MetresAndMillimetresGiveTheSameVessel) {
    const fs::path folder = fresh_folder();
    make_phantom_file(folder / "mm.ply", {"torus", "--turns", "0.25"});
    make_phantom_file(folder / "m.ply", {"torus", "--turns", "0.25", "--scale", "0.001"});
    write_text(folder / "cohort.tsv", "id\tsurface\tscale\nmm\tmm.ply\tn/a\nscaled\tm.ply\t1000\nm\tm.ply\tn/a\n");
    write_text(folder / "cohort.yaml", "cohort: units\nmodels: {table: cohort.tsv}\n");
    ASSERT_EQ(run_cohort(folder).status, 0);
    for (const char* path : {"/centerlines/radius", "/centerlines/abscissa"}) {
        const std::vector<double> mm = get_numbers(folder, "results", "mm", path);
        // Coordinates that went through another unit differ in their last digits, and with them the exact points a
        // line visits; ends, smallest and largest values are the vessel's. 1e-6 is far below its resolution.
        for (const auto& [id, factor] : {std::pair{"scaled", 1.0}, std::pair{"m", 1000.0}}) {
            const std::vector<double> other = get_numbers(folder, "results", id, path);
            EXPECT_NEAR(factor * other.back(), mm.back(), 1e-6 * mm.back()) << id << path;
            EXPECT_NEAR(factor * *std::max_element(other.begin(), other.end()), *std::max_element(mm.begin(), mm.end()),
                        1e-6 * mm.back())
                << id << path;
        }
    }
    EXPECT_EQ(get_attribute(folder, "results", "m", "status"), get_attribute(folder, "results", "mm", "status"));
}

TEST(Run, ArchiveThatCannotBeWrittenIsOneSentence) {
    const fs::path folder = small_cohort();
    // A file stands where the folder should be: holds for root too, which permissions do not stop.
    write_text(folder / "results", "in the way");
    const Finished run = run_cohort(folder);
    EXPECT_EQ(run.status, 1) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(lines_of(run.err).size(), 1U) << run.err;
    EXPECT_NE(run.err.find("results"), std::string::npos) << run.err;
    EXPECT_EQ(read_text(folder / "results"), "in the way");
}

TEST(Run, ModelFileThatCannotBeWrittenFailsThatModel) {
    const fs::path folder = small_cohort();
    fs::create_directories(model_file(folder, "bend") / "in the way");
    const Finished run = run_cohort(folder);
    EXPECT_EQ(run.status, 1) << run.err;
    EXPECT_EQ(lines_with(run.err, "bend: failed in archive"), 1U) << run.err;
    EXPECT_NE(run.out.find("1 failed"), std::string::npos) << run.out;
    EXPECT_NE(get_attribute(folder, "results", "tube", "status"), "failed");
}

}  // namespace
}  // namespace lumenline::cli_test
