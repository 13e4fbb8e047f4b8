// Labels of branches from the configuration to the tables and their statistics.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/archive/read.h"
#include "tests/cli/process.h"

namespace lumenline {
namespace {

using cli_test::Finished;
using cli_test::run_lumenline;

/// Three forked trees, the template the last of them.
std::filesystem::path folder_of_trees() {
    auto folder = cli_test::fresh_folder();
    for (const char* seed : {"1", "2", "3"})
        EXPECT_EQ(run_lumenline({"phantom", "tree", "-o", std::string("t") + seed + ".ply", "--leaves", "2", "--seed",
                                 seed, "--points-around", "12"},
                                folder)
                      .status,
                  0);
    cli_test::write_text(folder / "models.tsv",
                         "id\tsurface\tgroup\tbranch_labels\nfirst\tt1.ply\ta\t\nsecond\tt2.ply\ta\t\n"
                         "third\tt3.ply\tb\t0=trunk;1=left;2=right\n");
    return folder;
}

void configure(const std::filesystem::path& folder, const std::string& population) {
    cli_test::write_text(folder / "cohort.yaml",
                         "cohort: a\nmodels: {table: models.tsv}\npopulation: " + population + "\n");
}

std::vector<std::string> labels(const std::filesystem::path& folder) {
    return ArchiveFile(folder / "results/cohort.h5").strings("/tables/branches/branch_label");
}

using Strings = std::vector<std::string>;

TEST(LabelsOfARun, FollowTheConfigurationWithoutComputingAnew) {
    const auto folder = folder_of_trees();
    configure(folder, "{labels: position}");
    ASSERT_EQ(run_lumenline({"run", "cohort.yaml"}, folder).status, 0);
    EXPECT_EQ(labels(folder), (Strings{"1", "1.1", "1.2", "1", "1.1", "1.2", "1", "1.1", "1.2"}));
    configure(folder, "{labels: given}");
    const Finished again = run_lumenline({"run", "cohort.yaml"}, folder);
    EXPECT_NE(again.out.find("(3 of them before)"), std::string::npos) << again.out;
    EXPECT_EQ(labels(folder), (Strings{"", "", "", "", "", "", "trunk", "left", "right"}));
    configure(folder, "{labels: none}");
    ASSERT_EQ(run_lumenline({"run", "cohort.yaml"}, folder).status, 0);
    EXPECT_EQ(labels(folder), Strings(9));
    cli_test::write_text(folder / "labels.tsv", "id\tbranch_id\tbranch_label\nfirst\t7\ttail\n");
    configure(folder, "{labels: given, label_table: labels.tsv}");
    const Finished odd = run_lumenline({"run", "cohort.yaml"}, folder);
    EXPECT_EQ(odd.status, 0);
    EXPECT_NE(odd.err.find("the model 'first' has the branches 0 to 2, but a label for 7, 'tail'"), std::string::npos)
        << odd.err;
}

TEST(LabelsOfARun, OfATemplateAreTheSameFromShardsAndServeStatistics) {
    const auto folder = folder_of_trees();
    configure(folder, "{labels: template, template: third}");
    ASSERT_EQ(run_lumenline({"run", "cohort.yaml"}, folder).status, 0);
    const Strings whole = labels(folder);
    ASSERT_EQ(whole.size(), 9U);
    for (std::size_t m = 0; m < 3; ++m) {
        const Strings own(whole.begin() + static_cast<std::ptrdiff_t>(3 * m), whole.begin() + 3 + 3 * m);
        EXPECT_EQ(own[0], "trunk");
        EXPECT_TRUE(own == (Strings{"trunk", "left", "right"}) || own == (Strings{"trunk", "right", "left"}));
    }
    std::filesystem::remove_all(folder / "results");
    for (const char* shard : {"3/3", "1/3", "2/3"})
        ASSERT_EQ(run_lumenline({"run", "cohort.yaml", "--shard", shard}, folder).status, 0);
    ASSERT_EQ(run_lumenline({"merge", "cohort.yaml"}, folder).status, 0);
    EXPECT_EQ(labels(folder), whole);

    const Finished stats = run_lumenline({"stats", "results", "--table", "branches", "--label", "branch_label", "--by",
                                          "group", "--measure", "length", "--format", "json"},
                                         folder);
    ASSERT_EQ(stats.status, 0) << stats.err;
    Strings strata;
    const auto document = nlohmann::json::parse(stats.out);
    for (const auto& line : document.at("groups")) {
        strata.push_back(line.at("label").get<std::string>() + " " + line.at("group").get<std::string>());
        EXPECT_EQ(line.at("n"), line.at("group") == "a" ? 2 : 1);
    }
    EXPECT_EQ(strata, (Strings{"left a", "left b", "right a", "right b", "trunk a", "trunk b"}));
}

TEST(ProfilesOfARun, AgreeWithASecondImplementation) {
    const auto folder = cli_test::fresh_folder();
    std::string table = "id\tsurface\tsubject\tgroup\n";
    for (const std::string seed : {"1", "2", "3"}) {
        EXPECT_EQ(run_lumenline({"phantom", "tree", "-o", "t" + seed + ".ply", "--leaves", "2", "--seed", seed,
                                 "--points-around", "12"},
                                folder)
                      .status,
                  0);
        for (const std::string visit : {"a", "b"})  // rows of one subject are averaged first
            table += seed + visit + "\tt" + seed + ".ply\tsubject " + seed + "\tg\n";
    }
    cli_test::write_text(folder / "models.tsv", table);
    configure(folder, "{}");
    ASSERT_EQ(run_lumenline({"run", "cohort.yaml"}, folder).status, 0);
    if (cli_test::run_shell("python3 -c 'import numpy' || /usr/bin/python3 -c 'import numpy'", folder).status != 0)
        GTEST_SKIP() << "NumPy is not installed (Debian: python3-numpy)";
    ASSERT_EQ(run_lumenline({"export", "results", "--to", "csv", "-o", "csv"}, folder).status, 0);
    const Finished second = cli_test::run_shell(
        "python=python3; $python -c 'import numpy' 2>/dev/null || python=/usr/bin/python3; "
        "$python " LUMENLINE_SOURCE_DIR "/tests/population/second_profile.py csv/sections.csv area 8",
        folder);
    ASSERT_EQ(second.status, 0) << second.err;
    const auto expected = nlohmann::json::parse(second.out);
    const Finished stats = run_lumenline({"stats", "results", "--table", "sections", "--by", "group", "--bin-by",
                                          "abscissa_relative", "--bins", "8", "--measure", "area", "--format", "json"},
                                         folder);
    ASSERT_EQ(stats.status, 0) << stats.err;
    const auto found = nlohmann::json::parse(stats.out).at("groups");
    ASSERT_EQ(found.size(), 8U);
    ASSERT_EQ(expected.size(), 8U);
    for (std::size_t k = 0; k < 8; ++k) {
        EXPECT_EQ(found[k].at("n"), 3);
        EXPECT_EQ(expected[k].at("n"), 3);
        for (const char* key : {"mean", "sd", "median", "p5", "p95"}) {
            const double value = expected[k].at(key).get<double>();
            EXPECT_NEAR(found[k].at(key).get<double>(), value, 1e-9 * value) << key << " of bin " << k;
        }
    }
    EXPECT_EQ(found[3].at("bin"), "0.375-0.5");
}

}  // namespace
}  // namespace lumenline
