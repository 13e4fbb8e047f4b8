// The verb `model`, one surface into one file; and `browse` with nobody listening.
#include <gtest/gtest.h>

#include "tests/cli/cohort_support.h"
#include "tests/cli/hdf_contents.h"

namespace lumenline::cli_test {
namespace {

namespace fs = std::filesystem;

/// A closed bent tube around the z-axis at x = -20, all coordinates negative or near zero.
fs::path capped_bend() {
    const fs::path folder = fresh_folder();
    make_phantom_file(folder / "bend.ply", {"torus", "--turns", "0.25", "--capped", "--offset=-40,-50,-60"});
    return folder;
}

TEST(Model, OpenTubeNeedsNoPoints) {
    const fs::path folder = fresh_folder();
    make_phantom_file(folder / "tube.ply", {"cylinder", "--b", "4", "--length", "30"});
    const Finished run = run_lumenline({"model", "tube.ply", "-o", "out.hdf", "--length-unit", "mm"}, folder);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("model file: out.hdf"), std::string::npos) << run.out;
    EXPECT_EQ(get_attribute(folder, "out.hdf", "out", "length_unit"), "mm");
    EXPECT_EQ(get_attribute(folder, "out.hdf", "out", "source_file"), "tube.ply");
    EXPECT_EQ(get_numbers(folder, "out.hdf", "out", "/centerlines/offsets").size(), 2U);
}

TEST(Model, GivenPointsWithNegativeCoordinatesAreEndpoints) {
    const fs::path folder = capped_bend();
    // Points of the axis, a circle of radius 20 around the shifted origin, at 25 and 65 degrees.
    const Finished run = run_lumenline(
        {"model", "bend.ply", "-o", "out.hdf", "--inlet=-21.874,-41.548,-60", "--outlet=-31.548,-31.874,-60"}, folder);
    ASSERT_EQ(run.status, 0) << run.err;
    const auto point = get_numbers(folder, "out.hdf", "out", "/endpoints/point");
    EXPECT_EQ(point, (std::vector<double>{-21.874, -41.548, -60, -31.548, -31.874, -60}));
    const auto line = get_numbers(folder, "out.hdf", "out", "/centerlines/points");
    ASSERT_GE(line.size(), 6U);
    // A line starts at the point of the complex nearest to the given one, here at most a coarse ball's error away.
    EXPECT_NEAR(line[0], -21.874, 0.5);
    EXPECT_NEAR(line[line.size() - 3], -31.548, 0.5);
}

TEST(Model, SpaceBeforeANegativePointIsAllowedOrSaysWhatToWrite) {
    const fs::path folder = capped_bend();
    const Finished run = run_lumenline(
        {"model", "bend.ply", "-o", "out.hdf", "--inlet", "-21.874,-41.548,-60", "--outlet", "-31.548,-31.874,-60"},
        folder);
    if (run.status != 0) {
        EXPECT_EQ(run.status, 2);
        EXPECT_NE(run.err.find("--inlet"), std::string::npos) << run.err;
    }
}

TEST(Model, ScaleAppliesBeforeThePoints) {
    const fs::path folder = capped_bend();
    const Finished run = run_lumenline({"model", "bend.ply", "-o", "out.hdf", "--scale", "0.1",
                                        "--inlet=-2.1874,-4.1548,-6", "--outlet=-3.1548,-3.1874,-6"},
                                       folder);
    ASSERT_EQ(run.status, 0) << run.err;
    const auto radius = get_numbers(folder, "out.hdf", "out", "/centerlines/radius");
    // The tube's radius is 5; a section of 16 points holds balls that are up to 3 % off, jitter adds as much.
    for (const double r : radius) EXPECT_NEAR(r, 0.5, 0.05);
}

TEST(Model, PointOutsideOfTheLumenFailsWithOneSentence) {
    const fs::path folder = capped_bend();
    const Finished run =
        run_lumenline({"model", "bend.ply", "-o", "out.hdf", "--inlet=0,0,0", "--outlet=-31.548,-31.874,-60"}, folder);
    EXPECT_EQ(run.status, 1);
    EXPECT_EQ(lines_of(run.err).size(), 1U) << run.err;
    EXPECT_EQ(get_attribute(folder, "out.hdf", "out", "failure_code"), "endpoint_outside");
}

TEST(Model, ClosedSurfaceWhoseOpeningsAreAskedForFailsWithOneSentence) {
    const fs::path folder = capped_bend();
    const Finished run = run_lumenline({"model", "bend.ply", "--mode", "boundaries", "-o", "out.hdf"}, folder);
    EXPECT_EQ(run.status, 1);
    EXPECT_EQ(lines_of(run.err).size(), 1U) << run.err;
    EXPECT_EQ(get_attribute(folder, "out.hdf", "out", "failure_code"), "endpoints_missing");
}

TEST(Model, FlatCapsAreOpenedUnasked) {
    const fs::path folder = capped_bend();
    const Finished run = run_lumenline({"model", "bend.ply", "-o", "out.hdf"}, folder);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(get_attribute(folder, "out.hdf", "out", "status"), "warning");  // two caps alike: the inlet is not clear
}

TEST(Model, UnreadableSurfaceFailsWithOneSentence) {
    const fs::path folder = fresh_folder();
    write_text(folder / "garbage.stl", "this is no surface\n");
    write_text(folder / "empty.ply", "");
    fs::create_directory(folder / "folder.ply");
    for (const char* file : {"missing.ply", "garbage.stl", "empty.ply", "folder.ply"}) {
        const Finished run = run_lumenline({"model", file, "-o", "out.hdf"}, folder);
        EXPECT_EQ(run.status, 1) << file;
        EXPECT_EQ(run.out, "") << file;
        EXPECT_EQ(lines_of(run.err).size(), 1U) << run.err;
        EXPECT_NE(run.err.find(file), std::string::npos) << run.err;
    }
}

TEST(Model, OutputThatCannotBeWrittenIsOneSentence) {
    const fs::path folder = fresh_folder();
    make_phantom_file(folder / "tube.ply", {"cylinder", "--b", "4", "--length", "30"});
    const Finished run = run_lumenline({"model", "tube.ply", "-o", "absent/out.hdf"}, folder);
    EXPECT_EQ(run.status, 1);
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(lines_of(run.err).size(), 1U) << run.err;
    EXPECT_NE(run.err.find("absent/out.hdf"), std::string::npos) << run.err;
}

TEST(Model, OutputNeverReplacesTheSurface) {
    const fs::path folder = fresh_folder();
    make_phantom_file(folder / "tube.ply", {"cylinder", "--b", "4", "--length", "30"});
    const std::string before = read_text(folder / "tube.ply");
    fs::create_symlink("tube.ply", folder / "same.ply");
    for (const char* output : {"tube.ply", "./tube.ply", "same.ply"}) {
        EXPECT_EQ(run_lumenline({"model", "tube.ply", "-o", output}, folder).status, 2) << output;
        EXPECT_TRUE(read_text(folder / "tube.ply") == before) << output << " was replaced";
        write_text(folder / "tube.ply", before);
    }
}

TEST(Model, ThreadsAndRepetitionChangeNothing) {
    const fs::path folder = fresh_folder();
    make_phantom_file(folder / "coil.ply", {"helix", "--turns", "0.4"});
    for (const char* threads : {"1", "4"})
        ASSERT_EQ(run_lumenline({"model", "coil.ply", "-o", "coil.hdf", "--threads", threads}, folder).status, 0);
    const auto four = hdf_contents(folder / "coil.hdf");
    ASSERT_EQ(run_lumenline({"model", "coil.ply", "-o", "coil.hdf", "--threads", "1"}, folder).status, 0);
    const auto names = differences(four, hdf_contents(folder / "coil.hdf"));
    EXPECT_TRUE(names.empty()) << names.front();
}

TEST(Model, PrecisionConcernsFieldsOnly) {
    const fs::path folder = fresh_folder();
    make_phantom_file(folder / "tube.ply", {"cylinder", "--b", "4", "--length", "30"});
    for (const char* precision : {"float32", "float64"})
        ASSERT_EQ(run_lumenline({"model", "tube.ply", "-o", precision + std::string(".hdf"), "--precision", precision},
                                folder)
                      .status,
                  0);
    const auto single = hdf_contents(folder / "float32.hdf"), full = hdf_contents(folder / "float64.hdf");
    EXPECT_EQ(differences(single, full),
              (std::vector<std::string>{
                  "/@id", "/@inputs_sha256", "/surface/abscissa", "/surface/angle", "/surface/branch_abscissa",
                  "/surface/branch_abscissa_relative", "/surface/descent_length", "/surface/euclidean_distance",
                  "/surface/geodesic_distance", "/surface/geodesic_distance_refined",
                  "/surface/normalized_tangency_deviation", "/surface/normalized_tangency_deviation_refined",
                  "/voronoi/arrival_time", "/voronoi/centerline_distance"}));
}

TEST(Outputs, NeitherInputsNorSpecialFilesAreReplaced) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder, {"--only", "coil"}).status, 0);
    write_text(folder / "ratings.tsv", "model\trating\ncoil\tgood\n");
    ASSERT_EQ(run_shell("mkfifo pipe && mkdir inner", folder).status, 0);
    const std::string index = read_text(folder / "results/cohort.h5"),
                      model = read_text(folder / "results/models/coil.hdf");
    const std::string ratings = read_text(folder / "ratings.tsv");
    for (const auto& [words, status] : std::vector<std::pair<std::vector<std::string>, int>>{
             {{"pack", "results", "-o", "results/models/coil.hdf"}, 2},
             {{"pack", "results", "-o", "results/cohort.h5"}, 2},
             {{"report", "results", "-o", "results/cohort.h5"}, 2},
             {{"report", "results", "-o", "ratings.tsv", "--ratings", "ratings.tsv"}, 2},
             {{"report", "results", "-o", "x", "--template", "./x"}, 2},
             {{"browse", "results", "page", "-o", "results/models/new.hdf"}, 2},
             {{"browse", "results", "get", "coil", "/surface/points", "-o", "results/models/coil.hdf"}, 2},
             {{"phantom", "cylinder", "-o", "x.ply", "--truth", "x.ply"}, 2},
             {{"report", "results", "-o", "results"}, 1},
             {{"report", "results", "-o", ""}, 1},
             {{"report", "results", "-o", "pipe"}, 1},
             {{"pack", "results", "-o", "inner"}, 1},
             {{"pack", "results", "-o", "absent/one.h5"}, 1},
             {{"browse", "results", "get", "coil", "/surface/points", "-o", "pipe"}, 1},
             {{"phantom", "cylinder", "-o", "x.ply", "--truth", "pipe"}, 1}}) {
        const Finished run = run_lumenline(words, folder);
        EXPECT_EQ(run.status, status) << words[0] << " " << run.err;
        ASSERT_EQ(lines_of(run.err).size(), 1U) << run.err;
        EXPECT_EQ(run.err.rfind("lumenline: cannot write '", 0), 0U) << run.err;
    }
    EXPECT_TRUE(read_text(folder / "results/cohort.h5") == index);
    EXPECT_TRUE(read_text(folder / "results/models/coil.hdf") == model);
    EXPECT_EQ(read_text(folder / "ratings.tsv"), ratings);
    EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
    EXPECT_FALSE(fs::exists(folder / "x"));
}

TEST(Outputs, LinkStaysAndItsTargetIsWritten) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder, {"--only", "coil"}).status, 0);
    write_text(folder / "target.txt", "old");
    fs::create_symlink("target.txt", folder / "link.NPY");
    ASSERT_EQ(run_lumenline({"browse", "results", "get", "coil", "/surface/points", "-o", "link.NPY"}, folder).status,
              0);
    EXPECT_TRUE(fs::is_symlink(folder / "link.NPY"));
    EXPECT_EQ(read_text(folder / "target.txt").substr(1, 5), "NUMPY") << "the name's case plays no part";
}

TEST(Page, ModelsOfAFileThatIsTheWholeArchiveCannotBeChosen) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder, {"--only", "coil"}).status, 0);
    ASSERT_EQ(run_lumenline({"pack", "results", "-o", "one.h5"}, folder).status, 0);
    const Finished page = run_lumenline({"browse", "one.h5", "page", "-o", "p.html", "--model", "coil"}, folder);
    EXPECT_EQ(page.status, 2);
    EXPECT_NE(page.err.find("--model"), std::string::npos) << page.err;
    EXPECT_FALSE(fs::exists(folder / "p.html"));
}

TEST(Browse, ClosedPipeIsNoError) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder, {"--only", "coil"}).status, 0);
    const std::string get = std::string("'") + LUMENLINE_BINARY + "' browse results get coil /surface/points";
    for (const char* reader : {" | head -n 1", " | true"}) {
        const Finished got = run_shell(get + reader, folder);
        EXPECT_EQ(got.status, 0) << reader << got.err;
        EXPECT_EQ(got.err, "") << reader;
    }
    EXPECT_EQ(lines_of(run_shell(get + " | head -n 1", folder).out).size(), 1U);
}

TEST(Browse, FullDiskIsAnErrorWithOneSentence) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder, {"--only", "coil"}).status, 0);
    const Finished got = run_shell(
        std::string("'") + LUMENLINE_BINARY + "' browse results get coil /surface/points > /dev/full", folder);
    EXPECT_EQ(got.status, 1);
    EXPECT_EQ(lines_of(got.err).size(), 1U) << got.err;
}

TEST(Phantom, SameSeedGivesTheSameBytesAndAnotherSeedDoesNot) {
    const fs::path folder = fresh_folder();
    for (const char* name : {"a", "b", "c"})
        ASSERT_EQ(run_lumenline({"phantom", "helix", "--jitter", "0.2", "--seed", *name == 'c' ? "2" : "1", "-o",
                                 name + std::string(".ply"), "--truth", name + std::string(".tsv")},
                                folder)
                      .status,
                  0);
    EXPECT_TRUE(read_text(folder / "a.ply") == read_text(folder / "b.ply"));
    EXPECT_FALSE(read_text(folder / "a.ply") == read_text(folder / "c.ply"));
    EXPECT_EQ(read_text(folder / "a.tsv"), read_text(folder / "c.tsv")) << "the truth does not depend on the noise";
}

TEST(Phantom, FileThatCannotBeWrittenIsOneSentence) {
    const fs::path folder = fresh_folder();
    const Finished run = run_lumenline({"phantom", "torus", "-o", "absent/torus.ply"}, folder);
    EXPECT_EQ(run.status, 1);
    EXPECT_EQ(lines_of(run.err).size(), 1U) << run.err;
}

}  // namespace
}  // namespace lumenline::cli_test
