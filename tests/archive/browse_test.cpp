#include "engine/cli/browse.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <limits>

#include "engine/cli/table.h"
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
    printed.status = action();
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
    const int status = action();
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
