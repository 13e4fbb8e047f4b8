// A selection of the mutations that runs in seconds, and the judge itself.
#include <gtest/gtest.h>

#include <iostream>
#include <limits>
#include <map>

#include "tests/cli/process.h"
#include "tests/mutation/trial.h"

namespace lumenline::mutation {
namespace {

TEST(Fault, ThereAreFortyDamagesOfEightSurfaces) {
    EXPECT_GE(all_damages().size(), 40U);
    EXPECT_EQ(subjects().size(), 8U);
}

TEST(Fault, SelectedDamageEndsRepairedOrRefused) {
    constexpr std::size_t kStep = 11;  // prime to 8, so that every damage meets some surface
    const auto folder = cli_test::fresh_folder();
    std::map<std::string, int> outcomes;
    for (std::size_t s = 0; s < subjects().size(); ++s) {
        const std::vector<Line> clean = clean_lines(s, folder);
        ASSERT_FALSE(clean.empty()) << subjects()[s].name;
        for (std::size_t d = s; d < all_damages().size(); d += kStep) {
            const std::string verdict = try_damage(s, d, clean, folder);
            ++outcomes[verdict];
            EXPECT_FALSE(verdict.starts_with("WRONG")) << subjects()[s].name << ", " << all_damages()[d].name << " ("
                                                       << all_damages()[d].format << "): " << verdict;
        }
    }
    for (const auto& [verdict, count] : outcomes) std::cout << count << " " << verdict << "\n";
}

TEST(Judge, RejectsWhatMustNotHappen) {
    const Damage mended{"", "", {true, false, {}}, {}}, refused{"", "", {false, false, {"no_surface"}}, {}};
    const std::vector<Line> clean{{{{0, 0, 0}, {10, 0, 0}}, {1, 1}}};
    Outcome outcome{0, "", "ok", "", "", clean};
    EXPECT_EQ(judge(mended, outcome, clean), "repaired");
    EXPECT_TRUE(judge(refused, outcome, clean).starts_with("WRONG"));
    outcome.lines[0].points[1].y = 2;
    EXPECT_TRUE(judge(mended, outcome, clean).starts_with("WRONG")) << "a line elsewhere";
    outcome.lines[0].points = {{0, 0, 0}, {5, 0, 0}};
    EXPECT_TRUE(judge(mended, outcome, clean).starts_with("WRONG")) << "half of the line";
    outcome.lines.clear();
    EXPECT_TRUE(judge(mended, outcome, clean).starts_with("WRONG")) << "no line";
    EXPECT_EQ(judge(refused, {1, "", "failed", "no_surface", "one sentence\n", {}}, clean), "refused: no_surface");
    EXPECT_TRUE(judge(refused, {1, "", "failed", "internal", "one sentence\n", {}}, clean).starts_with("WRONG"));
    EXPECT_TRUE(judge(refused, {1, "", "failed", "no_surface", "two\nlines\n", {}}, clean).starts_with("WRONG"));
    EXPECT_TRUE(judge(refused, {-1, "signal 11", "", "", "", {}}, clean).starts_with("WRONG"));
    EXPECT_TRUE(judge(refused, {23, "", "", "", "leak\n", {}}, clean).starts_with("WRONG")) << "a sanitizer's status";
    EXPECT_EQ(deviation(clean, {}), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace lumenline::mutation
