#include "engine/population/study.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/population/rows.h"

namespace lumenline {
namespace {

using Numbers = std::vector<double>;
using Texts = std::vector<std::string>;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

DataTable sample() {
    DataTable t{"models", 8, {}};
    t.columns.push_back({"id", "1", "", false, Texts{"a", "b", "c", "d", "e", "f", "g", "h"}});
    t.columns.push_back({"status", "1", "", false, Texts{"ok", "ok", "failed", "ok", "warning", "ok", "ok", "ok"}});
    t.columns.push_back({"subject", "1", "", false, Texts{"s1", "s1", "s2", "s3", "s4", "s5", "", ""}});
    t.columns.push_back({"group", "1", "", false, Texts{"x", "x", "x", "x", "y", "y", "y", ""}});
    t.columns.push_back({"session", "1", "", false, Texts{"v2", "v10", "v2", "v2", "v2", "v10", "v2", "v2"}});
    t.columns.push_back({"age", "1", "covariate", false, Numbers{10, 10, 20, 30, 40, 50, kNaN, 70}});
    t.columns.push_back({"radius", "mm", "", true, Numbers{1, 3, 99, 4, 5, kNaN, 7, 8}});
    t.columns.push_back({"place", "1", "", false, Numbers{0, 0.2, 0.5, 0.7, 1, kNaN, 0.4, 1.5}});
    return t;
}

StudyOptions by_group() {
    StudyOptions options;
    options.by = "group";
    return options;
}

TEST(Study, RowsOfASubjectAreAveragedAndFailuresLeftOut) {
    const Study study = study_table(sample(), by_group());
    ASSERT_EQ(study.groups.size(), 2U);
    EXPECT_EQ(study.groups[0].group, "x");
    EXPECT_EQ(study.groups[0].values, (Numbers{2, 4})) << "s1 with 1 and 3, s3 with 4; s2 failed";
    EXPECT_EQ(study.groups[1].values, (Numbers{5, 7}));
    const Coverage& c = study.groups[0].coverage;
    EXPECT_EQ(c.rows_in, 8U);
    EXPECT_EQ(c.rows_used, 5U);
    EXPECT_EQ(c.reasons(), "1 failed, 1 without a value, 1 without 'group'");
    ASSERT_EQ(study.comparisons.size(), 1U);
    EXPECT_EQ(study.comparisons[0].welch.difference.value, -3);
}

TEST(Study, TextThatSaysNotAvailableIsNoGroupAndNoLevel) {
    DataTable table = sample();
    table.columns.push_back(
        {"smoker", "1", "covariate", false, Texts{"yes", "yes", "n/a", "no", "n/a", "yes", "no", ""}});
    StudyOptions options;
    options.by = "smoker";
    const Study by = study_table(table, options);
    ASSERT_EQ(by.groups.size(), 2U);
    EXPECT_EQ(by.groups[0].group, "no");
    EXPECT_EQ(by.groups[1].group, "yes");
    EXPECT_EQ(by.groups[0].coverage.reasons(), "1 failed, 2 without 'smoker', 1 without a value");
    options = {};
    options.adjust = {"smoker"};
    const Study adjusted = study_table(table, options);
    ASSERT_EQ(adjusted.regressions.size(), 1U);
    ASSERT_EQ(adjusted.regressions[0].model.terms.size(), 2U) << "the intercept and one level beside the first";
    EXPECT_EQ(adjusted.regressions[0].model.terms[1].name, "smoker=yes");
    EXPECT_NE(adjusted.regressions[0].coverage.reasons().find("2 without a covariate"), std::string::npos);
}

TEST(Study, ModelsRatedBadAreLeftOut) {
    DataTable table = sample();
    table.columns.push_back({"rating", "1", "", false, Texts{"", "", "", "bad", "good", "", "", ""}});
    const Study study = study_table(table, by_group());
    EXPECT_EQ(study.groups[0].values, (Numbers{2}));
    EXPECT_EQ(study.coverage.reasons(), "1 failed, 1 rated bad");
}

TEST(Study, ConditionsMustAllHold) {
    StudyOptions options = by_group();
    options.where = {"age >= 20", "session != v10"};
    const Study study = study_table(sample(), options);
    EXPECT_EQ(study.coverage.rows_used, 3U);
    EXPECT_EQ(study.coverage.reasons(), "4 outside of the conditions, 1 failed");
}

TEST(Conditions, WhatIsMissingMeetsNoneButThatItIs) {
    DataTable table = sample();
    table.columns.push_back({"smoker", "1", "", false, Texts{"yes", "no", "n/a", "", "yes", "no", "no", "no"}});
    const auto rows = [&](const std::string& condition) { return rows_where(table, {condition}); };
    using Rows = std::vector<std::size_t>;
    EXPECT_EQ(rows("radius ="), (Rows{5}));
    EXPECT_EQ(rows("radius!="), (Rows{0, 1, 2, 3, 4, 6, 7}));
    EXPECT_EQ(rows("radius != 5"), (Rows{0, 1, 2, 3, 6, 7}));
    EXPECT_EQ(rows("smoker="), (Rows{2, 3}));
    EXPECT_EQ(rows("smoker = n/a"), (Rows{2, 3}));
    EXPECT_EQ(rows("smoker !="), (Rows{0, 1, 4, 5, 6, 7}));
    EXPECT_EQ(rows("smoker != no"), (Rows{0, 4}));
    EXPECT_EQ(rows("radius < inf"), (Rows{0, 1, 2, 3, 4, 6, 7}));
}

TEST(Conditions, TextIsOrderedAsNumbersOrNotAtAll) {
    DataTable table{"models", 4, {}};
    table.columns.push_back({"visit", "1", "", false, Texts{"9", "10", "", "100"}});
    table.columns.push_back({"side", "1", "", false, Texts{"left", "right", "", "7"}});
    EXPECT_EQ(rows_where(table, {"visit >= 10"}), (std::vector<std::size_t>{1, 3}));
    EXPECT_THROW(rows_where(table, {"visit < x"}), StudyError);
    EXPECT_THROW(rows_where(table, {"side < 8"}), StudyError);
}

TEST(Conditions, NumbersAreComparedWithNumbersOnly) {
    for (const char* condition :
         {"age < 1e999", "age = -1e999", "age <", "age >= n/a", "age = x", "age = 3x", "age = nan"})
        try {
            rows_where(sample(), {condition});
            ADD_FAILURE() << condition;
        } catch (const StudyError& error) {
            EXPECT_NE(std::string(error.what()).find("which is no number, or out of range"), std::string::npos)
                << error.what();
        }
}

TEST(Study, BootstrapKeepsRowsAndDrawsSubjects) {
    StudyOptions options = by_group();
    options.bootstrap = 200;
    const Study study = study_table(sample(), options);
    EXPECT_EQ(study.groups[0].values, (Numbers{1, 3, 4}));
    EXPECT_TRUE(std::isnan(study.comparisons[0].welch.test.p)) << "rows are not independent: no test of them";
    EXPECT_LE(study.comparisons[0].welch.difference.low, study.comparisons[0].welch.difference.value);
    EXPECT_NE(study.unit.find("drawing whole subjects 200 times"), std::string::npos);
}

TEST(Study, ProfilesCountRowsOutsideOfTheBins) {
    StudyOptions options;
    options.bin_by = "place";
    options.bins = 2;
    const Study study = study_table(sample(), options);
    ASSERT_EQ(study.groups.size(), 2U);
    EXPECT_EQ(study.groups[0].stratum.bin, "0-0.5");
    EXPECT_EQ(study.groups[0].values, (Numbers{2, 7}));
    EXPECT_EQ(study.groups[1].values, (Numbers{4, 5})) << "1 belongs to the last bin";
    EXPECT_EQ(study.coverage.reasons(), "1 failed, 1 without 'place', 1 with 'place' outside of 0 to 1");
}

TEST(Study, LabelsAreStudiedApart) {
    StudyOptions options;
    options.label = "group";
    const Study study = study_table(sample(), options);
    ASSERT_EQ(study.groups.size(), 3U);
    EXPECT_EQ(study.groups[1].stratum.label, "x");
}

TEST(Study, MeasuresCanBeDividedByBodySize) {
    StudyOptions options = by_group();
    options.normalize_by = "age";
    const Study study = study_table(sample(), options);
    EXPECT_EQ(study.groups[1].values, (Numbers{0.125})) << "without an age there is no value";
}

TEST(Study, OccasionsArePairedBySubjectInTheOrderOfTheirNumbers) {
    DataTable table = sample();
    StudyOptions options;
    options.retest = "session";
    const Study study = study_table(table, options);
    ASSERT_EQ(study.agreements.size(), 1U);
    EXPECT_EQ(study.agreements[0].first, "v2");
    EXPECT_EQ(study.agreements[0].second, "v10");
    ASSERT_EQ(study.agreements[0].subjects.size(), 1U);
    EXPECT_EQ(study.agreements[0].subjects[0].second, std::pair(1.0, 3.0));
}

TEST(Study, GroupsAndCovariatesEnterTheModelTogether) {
    DataTable table{"models", 6, {}};
    table.columns.push_back({"group", "1", "", false, Texts{"a", "a", "a", "b", "b", "b"}});
    table.columns.push_back({"age", "1", "", false, Numbers{1, 2, 3, 2, 3, 5}});
    table.columns.push_back({"radius", "mm", "", true, Numbers{3, 5, 7, 15, 17, 21}});  // 1 + 2 age + 10 of b
    StudyOptions options = by_group();
    options.adjust = {"age"};
    const Study study = study_table(table, options);
    ASSERT_EQ(study.regressions.size(), 1U);
    const auto& terms = study.regressions[0].model.terms;
    ASSERT_EQ(terms.size(), 3U);
    EXPECT_EQ(terms[1].name, "group=b");
    EXPECT_NEAR(terms[1].coefficient.value, 10, 1e-12);
    EXPECT_NEAR(terms[2].coefficient.value, 2, 1e-12);
}

TEST(Study, UnknownColumnsAreNamedWithThoseThereAre) {
    StudyOptions options;
    options.by = "grop";
    try {
        study_table(sample(), options);
        FAIL();
    } catch (const StudyError& error) {
        EXPECT_NE(std::string(error.what()).find("no column 'grop'; it has id, status"), std::string::npos);
    }
    options = {};
    options.where = {"age about 3"};
    EXPECT_THROW(study_table(sample(), options), StudyError);
    options.where = {"age > old"};
    EXPECT_THROW(study_table(sample(), options), StudyError);
    options = {};
    options.correlate = {"group"};
    EXPECT_THROW(study_table(sample(), options), StudyError);
    options = {};
    options.subject = "nothere";
    EXPECT_THROW(study_table(sample(), options), StudyError);
}

TEST(NaturalOrder, NumbersCountByTheirValue) {
    EXPECT_TRUE(natural_less("visit2", "visit10"));
    EXPECT_FALSE(natural_less("visit10", "visit2"));
    EXPECT_TRUE(natural_less("a", "b"));
    EXPECT_TRUE(natural_less("a", "a1"));
    EXPECT_FALSE(natural_less("a", "a"));
    EXPECT_TRUE(natural_less("a01", "a1") != natural_less("a1", "a01")) << "an order of different names";
}

}  // namespace
}  // namespace lumenline
