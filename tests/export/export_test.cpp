// The verb `export` on an archive of a tree and a failure; its files as VTK and a reader of CSV see them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cli/process.h"

namespace lumenline {
namespace {

using cli_test::Finished;
using cli_test::run_lumenline;
using cli_test::run_shell;

std::filesystem::path archive() {
    auto folder = cli_test::fresh_folder();
    EXPECT_EQ(run_lumenline({"phantom", "tree", "-o", "tree.ply", "--leaves", "2"}, folder).status, 0);
    cli_test::write_text(folder / "broken.ply", "ply\n");
    cli_test::write_text(folder / "models.tsv",
                         "id\tsurface\tgroup\nforked\ttree.ply\t\"a, \"\"b\"\"\"\nbroken\tbroken.ply\tc\n");
    cli_test::write_text(folder / "cohort.yaml",
                         "cohort: a\nlength_unit: mm\nmodels: {table: models.tsv}\narchive: {directory: results}\n");
    EXPECT_EQ(run_lumenline({"run", "cohort.yaml"}, folder).status, 1);
    return folder;
}

TEST(Export, VtkReadsSurfaceLinesAndDiagram) {
    const auto folder = archive();
    const Finished exported = run_lumenline({"export", "results", "--to", "vtp", "-o", "vtp"}, folder);
    ASSERT_EQ(exported.status, 0) << exported.err;
    EXPECT_EQ(exported.out, "3 files written to vtp\n");
    EXPECT_NE(exported.err.find("model 'broken' has nothing to export"), std::string::npos) << exported.err;
    const std::string python =
        "$(for p in python3 /usr/bin/python3; do $p -c 'import vtkmodules, h5py' 2>/dev/null && echo $p && break; "
        "done)";
    if (run_shell("test -n \"" + python + "\"", folder).status != 0)
        GTEST_SKIP() << "VTK's Python modules or h5py are not installed (Debian: python3-vtk9 python3-h5py)";
    const Finished read =
        run_shell(python + " " LUMENLINE_SOURCE_DIR "/tests/export/vtk_reads.py vtp results/models/forked.hdf", folder);
    EXPECT_EQ(read.status, 0) << read.err;
    EXPECT_NE(read.out.find("junction parts"), std::string::npos) << read.out;
    // The exported lines and surface are what our own readers take for a surface, too.
    EXPECT_EQ(run_lumenline({"model", "vtp/forked_surface.vtp", "-o", "again.hdf"}, folder).status, 0);
}

TEST(Export, TablesHaveADictionaryAndQuotedText) {
    const auto folder = archive();
    ASSERT_EQ(run_lumenline({"export", "results", "--to", "csv", "-o", "csv"}, folder).status, 0);
    const auto models = cli_test::lines_of(cli_test::read_text(folder / "csv" / "models.csv"));
    ASSERT_EQ(models.size(), 3U);
    EXPECT_NE(models[1].find(",\"a, \"\"b\"\"\","), std::string::npos) << models[1];
    const auto dictionary = nlohmann::json::parse(cli_test::read_text(folder / "csv" / "dictionary.json"));
    bool found = false;
    for (const auto& entry : dictionary)
        if (entry.at("table") == "branches" && entry.at("column") == "length") {
            found = true;
            EXPECT_EQ(entry.at("unit"), "mm");
            EXPECT_EQ(entry.at("type"), "float64");
            EXPECT_FALSE(entry.at("definition").get<std::string>().empty());
        }
    EXPECT_TRUE(found);
    EXPECT_TRUE(std::filesystem::exists(folder / "csv" / "branches.csv"));
    // Columns that were joined from the models have their own type and unit.
    const auto is_joined = [](const auto& e) { return e.at("table") == "sections" && e.at("column") == "sites"; };
    const auto joined = std::find_if(dictionary.begin(), dictionary.end(), is_joined);
    ASSERT_NE(joined, dictionary.end());
    EXPECT_EQ(joined->at("type"), "int32");
    // With tabs, as BIDS has it, the same.
    ASSERT_EQ(run_lumenline({"export", "results", "--to", "tsv", "-o", "tsv"}, folder).status, 0);
    const auto tabs = cli_test::lines_of(cli_test::read_text(folder / "tsv" / "models.tsv"));
    ASSERT_EQ(tabs.size(), 3U);
    EXPECT_NE(tabs[1].find("\t\"a, \"\"b\"\"\"\t"), std::string::npos) << tabs[1];
    EXPECT_NE(tabs[2].find("\tn/a\t"), std::string::npos) << "the failed model has no lengths";
    EXPECT_EQ(nlohmann::json::parse(cli_test::read_text(folder / "tsv" / "dictionary.json")), dictionary);
}

TEST(Export, WrongRequestsAreRefusedInOneSentence) {
    const auto folder = archive();
    const Finished unknown =
        run_lumenline({"export", "results", "--to", "vtp", "-o", "vtp", "--model", "forkd"}, folder);
    EXPECT_EQ(unknown.status, 2);
    EXPECT_NE(unknown.err.find("nearest"), std::string::npos) << unknown.err;
    const Finished some = run_lumenline({"export", "results", "--to", "csv", "-o", "csv", "--model", "forked"}, folder);
    EXPECT_EQ(some.status, 2);
    EXPECT_NE(some.err.find("--model goes with --to vtp only"), std::string::npos) << some.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "csv"));
    const Finished nothing =
        run_lumenline({"export", "results", "--to", "vtp", "-o", "vtp", "--model", "broken"}, folder);
    EXPECT_EQ(nothing.status, 1) << "a model that failed has nothing to write";
    EXPECT_EQ(cli_test::lines_of(nothing.err).size(), 1U) << nothing.err;
    EXPECT_EQ(run_lumenline({"export", "nowhere", "--to", "csv", "-o", "csv"}, folder).status, 2);
    EXPECT_EQ(run_lumenline({"export", "results", "--to", "stl", "-o", "x"}, folder).status, 2);
    const Finished blocked = run_lumenline({"export", "results", "--to", "csv", "-o", "cohort.yaml"}, folder);
    EXPECT_EQ(blocked.status, 1);
    EXPECT_EQ(cli_test::lines_of(blocked.err).size(), 1U) << blocked.err;
}

}  // namespace
}  // namespace lumenline
