// Every damage on every subject, each in a process of its own: none crashes, hangs or leaks (the sanitizer build
// makes a leak an exit status of its own); each ends repaired, with the clean surface's lines, or refused with a
// code that is right.
#include <gtest/gtest.h>

#include <iostream>
#include <map>

#include "tests/cli/process.h"
#include "tests/mutation/trial.h"

namespace lumenline::mutation {
namespace {

class Mutation : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Mutation, EndsRepairedOrRefused) {
    const auto folder = cli_test::fresh_folder();
    const std::vector<Line> clean = clean_lines(GetParam(), folder);
    ASSERT_FALSE(clean.empty()) << subjects()[GetParam()].name;
    std::map<std::string, int> outcomes;
    for (std::size_t d = 0; d < all_damages().size(); ++d) {
        const std::string verdict = try_damage(GetParam(), d, clean, folder);
        ++outcomes[verdict.starts_with("WRONG") ? "WRONG" : verdict];
        EXPECT_FALSE(verdict.starts_with("WRONG"))
            << all_damages()[d].name << " (" << all_damages()[d].format << ", number " << d << "): " << verdict;
    }
    std::cout << subjects()[GetParam()].name << ": " << all_damages().size() << " damaged surfaces";
    for (const auto& [verdict, count] : outcomes) std::cout << ", " << count << " " << verdict;
    std::cout << "\n";
}

INSTANTIATE_TEST_SUITE_P(All, Mutation, ::testing::Range(std::size_t{0}, subjects().size()),
                         [](const auto& test) { return subjects()[test.param].name; });

}  // namespace
}  // namespace lumenline::mutation
