// `lumenline validate`: a line per model, the exit status of a run, and nothing written.
#include <gtest/gtest.h>

#include "tests/cli/cohort_support.h"

namespace lumenline::cli_test {
namespace {

namespace fs = std::filesystem;

Finished validate(const fs::path& folder) { return run_lumenline({"validate", "cohort.yaml"}, folder); }

TEST(Validate, GoodCohortHasALinePerModelAndWritesNothing) {
    const fs::path folder = small_cohort();
    const Finished finished = validate(folder);
    EXPECT_EQ(finished.status, 0) << finished.err;
    EXPECT_EQ(finished.err, "");
    const std::vector<std::string> lines = lines_of(finished.out);
    ASSERT_EQ(lines.size(), 7U) << finished.out;
    const char* const ids[] = {"tube", "bend", "coil", "narrow"};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(lines[i].rfind(ids[i], 0), 0U) << lines[i];
        EXPECT_NE(lines[i].find(" ok "), std::string::npos) << lines[i];
        EXPECT_NE(lines[i].find("2 openings"), std::string::npos) << lines[i];
    }
    EXPECT_EQ(lines[5], "4 ok, 0 with warnings, 0 failed");
    for (const char* word : {"a run: about 0:", "thread", "MB on disk", "of memory"})
        EXPECT_NE(lines[6].find(word), std::string::npos) << lines[6];
    EXPECT_FALSE(fs::exists(folder / "results"));
}

TEST(Validate, BadSurfaceIsASentenceAndStatusOneAndTheOthersAreChecked) {
    const fs::path folder = small_cohort();
    write_text(folder / "bend.ply", "ply\nformat ascii 1.0\nelement vertex -1\n");
    const Finished finished = validate(folder);
    EXPECT_EQ(finished.status, 1) << finished.err;
    const std::vector<std::string> lines = lines_of(finished.out);
    ASSERT_EQ(lines.size(), 7U) << finished.out;
    EXPECT_NE(lines[1].find("bend    failed   "), std::string::npos) << lines[1];
    EXPECT_NE(lines[1].find("bend.ply, line 3:"), std::string::npos) << lines[1];
    EXPECT_EQ(lines[5], "3 ok, 0 with warnings, 1 failed");
}

TEST(Validate, ModelInAnotherUnitIsFlaggedBelowTheOthers) {
    const fs::path folder = small_cohort();
    std::string text = read_text(folder / "cohort.yaml");
    const std::string surface = "surface: bend.ply";
    ASSERT_NE(text.find(surface), std::string::npos) << text;
    write_text(folder / "cohort.yaml", text.replace(text.find(surface), surface.size(), surface + ", scale: 10"));
    const Finished finished = validate(folder);
    EXPECT_EQ(finished.status, 0) << finished.err;
    const std::vector<std::string> lines = lines_of(finished.out);
    ASSERT_EQ(lines.size(), 8U) << finished.out;
    EXPECT_NE(lines[1].find("bend    ok "), std::string::npos) << lines[1];
    EXPECT_NE(lines[4].find(std::string("bend    warning  ") + "unlikely_unit" + ": its size of "), std::string::npos)
        << lines[4];
    EXPECT_NE(lines[4].find("`scale: 0.1` would mend that"), std::string::npos) << lines[4];
    EXPECT_EQ(lines[6], "3 ok, 1 with warnings, 0 failed");
}

TEST(Validate, WrongConfigurationIsStatusTwo) {
    const fs::path folder = small_cohort();
    write_text(folder / "cohort.yaml", "cohort: c\nmodles: []\n");
    const Finished finished = validate(folder);
    EXPECT_EQ(finished.status, 2);
    EXPECT_EQ(finished.out, "");
    EXPECT_NE(finished.err.find("modles"), std::string::npos) << finished.err;
}

}  // namespace
}  // namespace lumenline::cli_test
