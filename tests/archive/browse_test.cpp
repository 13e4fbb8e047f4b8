#include "engine/cli/browse.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/cli/sparkline.h"
#include "engine/cli/status_of.h"
#include "engine/cli/table.h"
#include "engine/core/branch_tables.h"
#include "io/archive/index.h"
#include "io/archive/model_file.h"
#include "io/archive/utf8.h"
#include "tests/archive/sample_record.h"

namespace lumenline {
namespace {

struct Printed {
    int status = -1;
    std::string out, err;
};

/// Runs the program's command line, with `browse` and another verb beside it.
Printed run(std::vector<std::string> arguments) {
    CLI::App app;
    app.require_subcommand(1);
    app.add_subcommand("run", "another verb");
    std::function<int()> action;
    add_browse(app, action);
    std::reverse(arguments.begin(), arguments.end());
    app.parse(arguments);
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    Printed printed;
    printed.status = status_of(action);
    printed.out = ::testing::internal::GetCapturedStdout();
    printed.err = ::testing::internal::GetCapturedStderr();
    return printed;
}

std::string archive_of(const std::vector<ModelRecord>& records, const std::string& name) {
    return sample_archive(records, name).string();
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Browse, ListIsTheDefault) {
    const std::string archive = archive_of({sample_record("liver-1"), failed_record("b")}, "browse_list");
    const Printed printed = run({"browse", archive});
    EXPECT_EQ(printed.status, 0) << printed.err;
    EXPECT_EQ(printed.out,
              "id       status   inlets  outlets  sites  lines  length [mm]  radius_min [mm]  radius_mean [mm]  "
              "radius_max [mm]  seconds\n"
              "liver-1  warning       1        3      5      2        2.333           0.4500             1.011   "
              "         1.593    2.800\n"
              "b        failed        -        -      5      -            -                -                 -   "
              "             -    2.800\n");
    EXPECT_EQ(run({"browse", archive, "list"}).out, printed.out);
}

TEST(Browse, OneModelFileIsAnArchive) {
    const std::string archive = archive_of({sample_record("a")}, "browse_file");
    const Printed printed = run({"browse", archive + "/models/a.hdf"});
    EXPECT_EQ(printed.out, run({"browse", archive}).out);
    EXPECT_EQ(run({"browse", archive + "/models/a.hdf", "show", "a"}).status, 0);
}

TEST(Browse, ShowTellsWhoWhatAndWhy) {
    const std::string archive = archive_of({sample_record("a"), failed_record("b")}, "browse_show");
    const Printed good = run({"browse", archive, "show", "a"});
    EXPECT_EQ(good.status, 0) << good.err;
    for (const char* part : {"subject", "sub-01", "h\xC3\xA9patique.stl", "inlet", "boundary", "the wall is coarse",
                             "0.3333", "(0.33333, 1, 2)"})
        EXPECT_TRUE(contains(good.out, part)) << part << "\n" << good.out;
    EXPECT_TRUE(contains(good.out, "    1       0       3       4   1.000       1.164       1.593\n")) << good.out;
    EXPECT_TRUE(contains(good.out, "characterization of 2 of 3 sites of the wall\n")) << good.out;
    const Printed bad = run({"browse", archive, "show", "b"});
    EXPECT_TRUE(contains(bad.out, "failed: a front needs at least one vertex to start from\n")) << bad.out;
    EXPECT_TRUE(contains(bad.out, "no_seed"));
}

TEST(Browse, GetPrintsFullPrecision) {
    const std::string archive = archive_of({sample_record("a")}, "browse_get");
    const auto get = [&](const std::string& path) { return run({"browse", archive, "get", "a", path}); };
    EXPECT_EQ(get("/surface/points").out,
              "0\t0\t0.3333333333333333\n1\t0\t0\n-0.5\t0.866\t0\n-0.5\t-0.866\t0\n0\t0\t-0.14285714285714285\n");
    EXPECT_EQ(get("surface/input_vertex").out, "0\n1\n2\n-1\n-1\n") << "the first slash may be left out";
    EXPECT_EQ(get("/voronoi/arrival_time").out,
              "0\t0.33333334\t0.6666667\t1\t1.3333334\t1.6666666\tinf\n"
              "0\t0.33333334\t0.6666667\t1\t1.3333334\t1.6666666\t2\n");
    EXPECT_EQ(get("/timing/total_seconds").out, "2.8\n");
    EXPECT_EQ(get("/endpoints/kind").out, "boundary\nboundary\npoint\npoint\n");
    EXPECT_EQ(get("/surface@genus").out, "1\n");
    EXPECT_EQ(get("@status").out, "warning\n");
    EXPECT_EQ(get("/surface/points@units").out, "mm\n");
    EXPECT_EQ(get("/VTKHDF@Version").out, "1\n0\n");
}

/// Ids of the models that `list` prints, in its order.
std::string listed(const std::string& archive, std::vector<std::string> options) {
    options.insert(options.begin(), {"browse", archive, "list"});
    const Printed printed = run(options);
    EXPECT_EQ(printed.status, 0) << printed.err;
    std::istringstream lines(printed.out);
    std::string ids, line;
    std::getline(lines, line);
    while (std::getline(lines, line)) ids += line.substr(0, line.find(' ')) + " ";
    return ids;
}

std::string ranked_archive() {
    std::vector<ModelRecord> records{sample_record("m2"), sample_record("m10"), failed_record("m1")};
    auto lines = std::make_shared<Centerlines>(*records[1].centerlines);
    for (double& radius : lines->radius) radius *= 2;
    records[1].centerlines = lines;
    return archive_of(records, "browse_ranked");
}

TEST(Browse, ListSortsByAnyColumnWithMissingValuesLast) {
    const std::string archive = ranked_archive();
    EXPECT_EQ(listed(archive, {"--sort", "radius_min"}), "m2 m10 m1 ");
    EXPECT_EQ(listed(archive, {"--sort", "radius_min", "--desc"}), "m10 m2 m1 ");
    EXPECT_EQ(listed(archive, {"--sort", "id"}), "m1 m2 m10 ") << "numbers within names by value";
    EXPECT_EQ(listed(archive, {"--sort", "seconds"}), "m2 m10 m1 ") << "equal ones keep their order";
    const Printed printed = run({"browse", archive, "list", "--sort", "age"});
    EXPECT_TRUE(contains(printed.out, "seconds    age\n")) << printed.out;
}

TEST(Browse, ListTakesNotAvailableForMissingText) {
    std::vector<ModelRecord> records{sample_record("a"), sample_record("b"), sample_record("c"), sample_record("d")};
    const char* const stages[] = {"n/a", "II", "", "I"};
    for (std::size_t i = 0; i < records.size(); ++i) records[i].identity.covariates = {{"stage", stages[i]}};
    const std::string archive = archive_of(records, "browse_missing_text");
    EXPECT_EQ(listed(archive, {"--sort", "stage"}), "d b a c ");
    EXPECT_EQ(listed(archive, {"--sort", "stage", "--desc"}), "b d a c ");
    const Printed csv = run({"browse", archive, "list", "--csv"});
    EXPECT_FALSE(contains(csv.out, "n/a")) << csv.out;
}

TEST(Browse, ListKeepsCovariatesApartFromItsOwnColumns) {
    ModelRecord record = sample_record("a");
    record.identity.covariates = {{"seconds", "7"}, {"lines", "9"}};
    const std::string archive = archive_of({record}, "browse_own_columns");
    const auto models = nlohmann::json::parse(run({"browse", archive, "list", "--json"}).out);
    EXPECT_EQ(models[0].at("seconds"), 2.8);
    EXPECT_EQ(models[0].at("covariate_seconds"), 7);
    EXPECT_EQ(models[0].at("covariate_lines"), 9);
    EXPECT_EQ(listed(archive, {"--where", "seconds < 3", "--where", "lines = 2"}), "a ") << "as they are printed";
}

TEST(Browse, ListSelectsByTheWordsOfStats) {
    const std::string archive = ranked_archive();
    EXPECT_EQ(listed(archive, {"--where", "status=failed"}), "m1 ") << "failed models can be asked for";
    EXPECT_EQ(listed(archive, {"--where", "radius_min > 0.5"}), "m10 ");
    EXPECT_EQ(listed(archive, {"--where", "lines>=1", "--where", "id!=m2"}), "m10 ");
    for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{
             {"--sort", "radius"}, {"--where", "radius<1"}, {"--where", "radius_min"}, {"--where", "radius_min<x"}}) {
        std::vector<std::string> arguments{"browse", archive, "list"};
        arguments.insert(arguments.end(), wrong.begin(), wrong.end());
        const Printed printed = run(arguments);
        EXPECT_EQ(printed.status, 2) << wrong[1];
        EXPECT_EQ(std::count(printed.err.begin(), printed.err.end(), '\n'), 1) << printed.err;
    }
    EXPECT_THROW(run({"browse", archive, "list", "--desc"}), CLI::ParseError);
    EXPECT_THROW(run({"browse", archive, "list", "--json", "--csv"}), CLI::ParseError);
}

TEST(Browse, ListGivesEveryColumnToOtherPrograms) {
    const std::string archive = ranked_archive();
    const auto models = nlohmann::json::parse(run({"browse", archive, "list", "--json", "--sort", "id"}).out);
    ASSERT_EQ(models.size(), 3U);
    EXPECT_EQ(models[0].at("id"), "m1");
    EXPECT_TRUE(models[0].at("radius_min").is_null());
    EXPECT_EQ(models[1].at("sites"), 5);
    EXPECT_TRUE(models[1].at("sites").is_number_integer());
    EXPECT_DOUBLE_EQ(models[1].at("radius_min").get<double>(), 0.45);
    EXPECT_EQ(models[1].at("seconds"), 2.8);
    const Printed csv = run({"browse", archive, "list", "--csv", "--where", "id=m2"});
    EXPECT_EQ(std::count(csv.out.begin(), csv.out.end(), '\n'), 2) << csv.out;
    EXPECT_TRUE(csv.out.starts_with("age,centerlines,")) << csv.out;
    EXPECT_EQ(run({"browse", archive + "/models/m2.hdf", "list", "--json"}).status, 2) << "a model has no tables";
}

TEST(Browse, ShowDrawsTheRadiusAlongEachBranch) {
    ModelRecord record = sample_record("a");
    auto branches = std::make_shared<Branches>(*record.branches);
    for (std::size_t k = 0; k < 9; ++k) branches->points.branch[k] = BranchId(k < 5 ? 0 : 2);
    branches->points.branch_abscissa = {0, 1, 2, 3, 4, 0, 1, 2, 3};
    record.branches = branches;
    const std::string archive = archive_of({record}, "browse_spark");
    const std::string out = run({"browse", archive, "show", "a"}).out;
    EXPECT_TRUE(contains(out, "     0   4.000      0.4500       1.021         0.000  (0, 0, 0)")) << out;
    EXPECT_TRUE(contains(out, "     1       -           -           -             -  -")) << out;
}

TEST(Sparkline, HeightsAreSharesOfTheLargest) {
    const std::vector<double> at{0, 1, 2, 3, 4, 5, 6, 7}, values{8, 7, 6, 5, 4, 3, 2, 1};
    EXPECT_EQ(sparkline(at, values, 8, SparkSet::kAscii), "##*+=:-.");
    EXPECT_EQ(sparkline(at, values, 4, SparkSet::kBlocks), "\u2588\u2586\u2584\u2582");
    EXPECT_EQ(sparkline(at, values, 2, SparkSet::kAscii), "+.") << "the least value of a part counts";
    const std::vector<double> two{0, 1}, level{3, 3};
    EXPECT_EQ(sparkline(two, level, 5, SparkSet::kAscii), "#####") << "parts without a value have the one before";
    EXPECT_EQ(sparkline({}, {}, 5, SparkSet::kAscii), "");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(sparkline(two, std::vector<double>{nan, nan}, 5, SparkSet::kAscii), "");
    EXPECT_EQ(sparkline(two, std::vector<double>{0, 0}, 5, SparkSet::kAscii), "") << "there is no height to share";
}

TEST(Sparkline, LocaleDecidesOnTheCharacters) {
    const auto set_in = [](const char* locale) {
        const char* before = std::getenv("LC_ALL");
        const std::string saved = before == nullptr ? "" : before;
        ::setenv("LC_ALL", locale, 1);
        const SparkSet set = spark_set();
        before == nullptr ? ::unsetenv("LC_ALL") : ::setenv("LC_ALL", saved.c_str(), 1);
        return set;
    };
    EXPECT_EQ(set_in("C"), SparkSet::kAscii);
    EXPECT_EQ(set_in("C.UTF-8"), SparkSet::kBlocks);
    EXPECT_EQ(set_in("of no country"), SparkSet::kAscii);
}

TEST(Browse, TreeNamesGroupsAndDatasets) {
    const std::string archive = archive_of({sample_record("a")}, "browse_tree");
    const Printed printed = run({"browse", archive, "tree", "a"});
    EXPECT_EQ(printed.status, 0);
    for (const char* part : {"/centerlines/path ", "group", "(5, 3)", "(9)", "scalar", "float32", "int64", "mm"})
        EXPECT_TRUE(contains(printed.out, part)) << part;
}

TEST(Browse, UnknownNamesGiveTheNearestAndStatusTwo) {
    const std::string archive = archive_of({sample_record("liver-1"), sample_record("liver-2")}, "browse_unknown");
    const auto expect = [](const Printed& printed, const char* part) {
        EXPECT_EQ(printed.status, 2);
        EXPECT_EQ(printed.out, "");
        EXPECT_TRUE(contains(printed.err, part)) << printed.err;
        EXPECT_EQ(std::count(printed.err.begin(), printed.err.end(), '\n'), 1) << printed.err;
    };
    expect(run({"browse", archive, "show", "liver_2"}), "no model 'liver_2'; the nearest are 'liver-2', 'liver-1'");
    expect(run({"browse", archive, "get", "liver-1", "/surface/point"}), "the nearest are '/surface/points'");
    expect(run({"browse", archive, "get", "liver-1", "/surface"}), "is a group");
    expect(run({"browse", archive, "get", "liver-1", "/surface@genius"}), "the nearest are 'genus'");
    expect(run({"browse", archive, "get", "liver-1", "/surfce@genus"}), "has no object '/surfce'");
    expect(run({"browse", archive + "/none"}), "there is no archive");
    expect(run({"browse", fresh_directory("browse_no_index").string()}), "has no index cohort.h5");
}

TEST(Browse, DamagedArchivesGiveOneSentenceAndStatusOne) {
    const std::string archive = archive_of({sample_record("a"), sample_record("b")}, "browse_damaged");
    write_bytes(archive + "/models/a.hdf", bytes_of(archive + "/models/a.hdf").substr(0, 4000));
    std::filesystem::remove(archive + "/models/b.hdf");
    for (const char* id : {"a", "b"}) {
        const Printed printed = run({"browse", archive, "show", id});
        EXPECT_EQ(printed.status, 1);
        EXPECT_EQ(std::count(printed.err.begin(), printed.err.end(), '\n'), 1) << printed.err;
    }
    EXPECT_EQ(run({"browse", archive}).status, 0) << "the index tells of them all the same";
}

TEST(Browse, ModelsMayBeCalledLikeVerbs) {
    const std::string archive = archive_of({sample_record("list"), sample_record("run")}, "browse_verbs");
    EXPECT_EQ(run({"browse", archive, "show", "list"}).status, 0);
    EXPECT_EQ(run({"browse", archive, "show", "run"}).status, 0);
    EXPECT_EQ(run({"browse", archive, "get", "run", "@id"}).out, "run\n");
}

TEST(Browse, ControlCharactersAreNotPrinted) {
    ModelRecord record = sample_record("a");
    record.identity.id = "a\x1B[2J\tb";
    record.identity.subject =
        "x\xC2\x9B"
        "31m\xE2\x80\xAEy";
    const auto file = fresh_directory("browse_control") / "m.hdf";
    write_model_file(file, record);
    const Printed list = run({"browse", file.string()});
    EXPECT_TRUE(contains(list.out, "a?[2J?b")) << list.out;
    const Printed value = run({"browse", file.string(), "get", record.identity.id, "@subject"});
    EXPECT_EQ(value.out, "x?31m?y\n");
    const Printed unknown = run({"browse", file.string(), "show", "\x1B"});
    EXPECT_TRUE(contains(unknown.err, "a?[2J?b"));
    EXPECT_EQ(unknown.err.find('\x1B'), std::string::npos);
}

/// Status of a run whose standard output is `descriptor`.
int status_with_output(int descriptor, const std::vector<std::string>& arguments) {
    CLI::App app;
    std::function<int()> action;
    add_browse(app, action);
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    app.parse(reversed);
    std::fflush(stdout);
    const int saved = ::dup(STDOUT_FILENO);
    ::dup2(descriptor, STDOUT_FILENO);
    const int status = status_of(action);
    ::dup2(saved, STDOUT_FILENO);
    ::close(saved);
    return status;
}

TEST(Browse, ClosedPipeIsNoError) {
    const std::string archive = archive_of({sample_record("a")}, "browse_pipe");
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    ::close(ends[0]);
    EXPECT_EQ(status_with_output(ends[1], {"browse", archive, "tree", "a"}), 0);
    ::close(ends[1]);
}

TEST(Browse, FullDiskIsAnError) {
    const int full = ::open("/dev/full", O_WRONLY);
    if (full < 0) GTEST_SKIP() << "no /dev/full";
    const std::string archive = archive_of({sample_record("a")}, "browse_full");
    EXPECT_EQ(status_with_output(full, {"browse", archive}), 1);
    ::close(full);
}

TEST(Browse, IncompleteCommandLinesAreRefused) {
    EXPECT_THROW(run({"browse"}), CLI::ParseError);
    EXPECT_THROW(run({"browse", "a", "show"}), CLI::ParseError);
    EXPECT_THROW(run({"browse", "a", "get", "b"}), CLI::ParseError);
    EXPECT_THROW(run({"browse", "a", "shwo", "b"}), CLI::ParseError);
}

TEST(TableNumber, FourDigitsWithoutExponentInTheUsualRange) {
    EXPECT_EQ(table_number(1.0 / 3), "0.3333");
    EXPECT_EQ(table_number(123456.7), "123457");
    EXPECT_EQ(table_number(-12.3456), "-12.35");
    EXPECT_EQ(table_number(0.00123456), "0.001235");
    EXPECT_EQ(table_number(0), "0.000");
    EXPECT_EQ(table_number(1e12), "1e+12");
    EXPECT_EQ(table_number(std::numeric_limits<double>::quiet_NaN()), "-");
    EXPECT_EQ(table_number(std::numeric_limits<double>::infinity()), "inf");
}

TEST(Utf8, InvalidBytesAreReplacedOneByOne) {
    EXPECT_EQ(valid_text("a\xC3\xA9\xF0\x9F\xAB\x80z"), "a\xC3\xA9\xF0\x9F\xAB\x80z");
    const std::string bad = "\xEF\xBF\xBD";
    EXPECT_EQ(valid_text("\xC3"), bad) << "cut short";
    EXPECT_EQ(valid_text("\xC0\xAF"), bad + bad) << "overlong";
    EXPECT_EQ(valid_text("\xED\xA0\x80"), bad + bad + bad) << "surrogate";
    EXPECT_EQ(valid_text("\xF4\x90\x80\x80"), bad + bad + bad + bad) << "beyond Unicode";
    EXPECT_EQ(valid_text("\xE2(\xA1"), bad + "(" + bad);
    EXPECT_EQ(printable("a\nb\x7F\xFF"), "a?b??");
    EXPECT_EQ(cut_text("a\xC3\xA9z", 2), "a");
    EXPECT_EQ(cut_text("a\xC3\xA9z", 3), "a\xC3\xA9");
    EXPECT_EQ(code_points("a\xC3\xA9z"), 3U);
}

}  // namespace
}  // namespace lumenline
