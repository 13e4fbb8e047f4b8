// The verb, on indices written by hand; its figures against a second implementation where SciPy is installed.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "engine/core/text.h"
#include "io/archive/index.h"
#include "tests/cli/process.h"

namespace lumenline {
namespace {

using cli_test::Finished;
using cli_test::fresh_folder;
using cli_test::run_lumenline;
using cli_test::run_shell;

struct Person {
    std::string subject, group, session;
    double age = 0, value = 0;
};

ModelSummary summary_of(const Person& person) {
    ModelSummary s;
    s.identity.id = person.subject + "_" + person.session;
    s.identity.subject = person.subject;
    s.identity.group = person.group;
    s.identity.session = person.session;
    s.identity.covariates = {{"age", exact_text(person.age)}};
    s.status = ModelStatus::kOk;
    s.centerlines = 1;
    s.length = s.radius_min = s.radius_mean = s.radius_max = person.value;
    return s;
}

/// Thirty subjects in two groups, at two sessions.
std::vector<Person> people() {
    std::mt19937_64 random(7);
    const auto uniform = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
    std::vector<Person> result;
    for (int i = 0; i < 30; ++i) {
        const bool in_b = i % 2 == 1;
        const double age = 40 + 30 * uniform(), value = 2 + 0.02 * age + (in_b ? 0.4 : 0.0) + uniform();
        const std::string subject = "s" + std::to_string(i);
        result.push_back({subject, in_b ? "b" : "a", "1", age, value});
        result.push_back({subject, in_b ? "b" : "a", "2", age, value + 0.1 * uniform()});
    }
    return result;
}

std::filesystem::path archive_of(const std::vector<Person>& people) {
    const std::filesystem::path folder = fresh_folder();
    std::vector<ModelSummary> models;
    for (const Person& p : people) models.push_back(summary_of(p));
    write_index(folder, models, "cohort: a\n", "cohort: a\n");
    return folder;
}

nlohmann::json stats(const std::filesystem::path& archive, std::vector<std::string> options) {
    options.insert(options.begin(), {"stats", archive.string(), "--format", "json"});
    const Finished finished = run_lumenline(options, archive);
    EXPECT_EQ(finished.status, 0) << finished.err;
    return nlohmann::json::parse(finished.out);
}

TEST(Stats, AgreesWithASecondImplementation) {
    const auto everybody = people();
    const auto archive = archive_of(everybody);
    if (run_shell("python3 -c 'import scipy' || /usr/bin/python3 -c 'import scipy'", archive).status != 0)
        GTEST_SKIP() << "SciPy is not installed (Debian: python3-scipy)";
    {
        std::ofstream table(archive / "people.tsv");
        table << "group\tage\tfirst\tsecond\n";
        for (std::size_t i = 0; i < everybody.size(); i += 2)
            table << everybody[i].group << '\t' << exact_text(everybody[i].age) << '\t'
                  << exact_text(everybody[i].value) << '\t' << exact_text(everybody[i + 1].value) << '\n';
    }
    const std::string script = std::string(LUMENLINE_SOURCE_DIR) + "/tests/population/second_implementation.py";
    const Finished second = run_shell(
        "python=python3; $python -c 'import scipy' 2>/dev/null || "
        "python=/usr/bin/python3; $python " +
            script + " people.tsv",
        archive);
    ASSERT_EQ(second.status, 0) << second.err;
    const auto expected = nlohmann::json::parse(second.out);

    const auto first = stats(archive, {"--by", "group", "--measure", "radius_mean", "--where", "session = 1",
                                       "--correlate", "age", "--adjust", "age"});
    const auto both = stats(archive, {"--measure", "radius_mean", "--retest", "session"});
    const auto same = [&](const nlohmann::json& row, const char* key, const char* name = nullptr) {
        const double value = row.at(key).get<double>(), other = expected.at(name != nullptr ? name : key).get<double>();
        EXPECT_NEAR(value, other, 1e-9 * std::fabs(other)) << key;
    };
    const auto& group = first.at("groups").at(0);
    for (const char* key : {"mean", "sd", "median", "lower_quartile", "upper_quartile"}) same(group, key);
    const auto& comparison = first.at("comparisons").at(0);
    for (const char* key :
         {"welch_t", "welch_p", "mann_whitney_u", "mann_whitney_p", "brown_forsythe_f", "brown_forsythe_p"})
        same(comparison, key);
    const auto& correlation = first.at("correlations").at(0);
    for (const char* key : {"pearson_r", "pearson_p", "spearman_rho", "spearman_p"}) same(correlation, key);
    const auto& regression = first.at("regressions").at(1);
    EXPECT_EQ(regression.at("term"), "group=b");
    for (const char* key : {"coefficient", "error", "p"}) same(regression, key);
    const auto& agreement = both.at("agreement").at(0);
    same(agreement, "icc");
    same(agreement, "bias");
    same(agreement, "sd", "agreement_sd");
    EXPECT_EQ(both.at("changes").size(), 30U);
}

TEST(Stats, EveryLineSaysWhatItUsedAndWhatNot) {
    const auto archive = archive_of(people());
    cli_test::write_text(archive / "ratings.tsv", "id\trating\ns0_1\tbad\ns1_1\tgood\n");
    const auto result = stats(archive, {"--by", "group", "--ratings", "ratings.tsv", "--measure", "length"});
    EXPECT_EQ(result.at("rows_in"), 60);
    EXPECT_EQ(result.at("left_out"), "1 rated bad");
    for (const auto& line : result.at("groups")) {
        EXPECT_EQ(line.at("rows_used"), 59);
        EXPECT_EQ(line.at("left_out"), "1 rated bad");
    }
    EXPECT_EQ(result.at("observations"), "subjects: rows of one are averaged first");
}

TEST(Stats, TextAndTabSeparatedHoldTheSameTables) {
    const auto archive = archive_of(people());
    const Finished text = run_lumenline({"stats", ".", "--by", "group", "--measure", "length"}, archive);
    EXPECT_EQ(text.status, 0);
    EXPECT_NE(text.out.find("\ncomparisons\n"), std::string::npos);
    EXPECT_NE(text.out.find("60 of 60 rows taken; every line says how many of them it used"), std::string::npos);
    const Finished tsv =
        run_lumenline({"stats", ".", "--by", "group", "--measure", "length", "--format", "tsv"}, archive);
    EXPECT_NE(tsv.out.find("# groups\nmeasure\tgroup\tn\t"), std::string::npos) << tsv.out;
}

TEST(Stats, WrongRequestsAreRefusedInOneSentence) {
    const auto archive = archive_of(people());
    const auto refused = [&](std::vector<std::string> options, const std::string& what) {
        options.insert(options.begin(), {"stats", "."});
        const Finished finished = run_lumenline(options, archive);
        EXPECT_EQ(finished.status, 2) << what;
        EXPECT_NE(finished.err.find(what), std::string::npos) << finished.err;
        EXPECT_EQ(cli_test::lines_of(finished.err).size(), 1U) << finished.err;
    };
    refused({"--by", "grop"}, "has no column 'grop'");
    refused({"--table", "branch"}, "has no table 'branch'");
    refused({"--where", "age ~ 3"}, "write COLUMN OP VALUE");
    refused({"--correlate", "group"}, "holds text");
    cli_test::write_text(archive / "ratings.tsv", "id\tverdict\ns0_1\tbad\n");
    refused({"--ratings", "ratings.tsv"}, "column 'rating' is missing");
}

}  // namespace
}  // namespace lumenline
