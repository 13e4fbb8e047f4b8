// The bare form of `branches`, and labels of branches by hand: three spellings of one thing.
#include "tests/config/support.h"

namespace lumenline {
namespace {

using testing::Folder;
using testing::model_with;
using testing::with;

TEST(BareBranches, StandForAMapWithEnabledAlone) {
    const Folder folder;
    EXPECT_FALSE(folder.load(with("branches: false")).tasks[0].options.branches.enabled);
    EXPECT_TRUE(folder.load(with("branches: true")).tasks[0].options.branches.enabled);
    EXPECT_EQ(canonical_text(folder.load(with("branches: false")).tasks[0]),
              canonical_text(folder.load(with("branches: {enabled: false}")).tasks[0]));
    EXPECT_EQ(folder.error(with("branches: maybe")),
              "cohort.yaml:2: key 'branches' must be true, false or a map of keys, not 'maybe'");
    EXPECT_NE(folder.error(with("branches: 'true'")), "");
    EXPECT_NE(folder.error(with("branches: [true]")).find("not a list"), std::string::npos);
    EXPECT_NE(folder.error(with("branches: {step: 0.1, enable: true}")).find("did you mean 'enabled'?"),
              std::string::npos);
}

TEST(BranchLabels, ListTableAndTableOfTheirOwnSayTheSame) {
    const Folder folder;
    const GivenLabels expected{{0, "aorta"}, {2, "left iliac"}};
    EXPECT_EQ(folder.load(model_with("branch_labels: {0: aorta, 2: left iliac}")).tasks[0].identity.branch_labels,
              expected);
    folder.write("t.tsv", "id\tsurface\tbranch_labels\na\ta.stl\t0=aorta; 2 = left iliac\nb\tb.stl\tn/a\n");
    const CohortConfig table = folder.load("cohort: c\nmodels: {table: t.tsv}\n");
    EXPECT_EQ(table.tasks[0].identity.branch_labels, expected);
    EXPECT_TRUE(table.tasks[1].identity.branch_labels.empty());
    EXPECT_TRUE(table.tasks[0].identity.covariates.empty()) << "labels are no covariate";
    folder.write("l.csv", "id,length,branch_id,branch_label\na,1.5,0,aorta\na,2,1,\na,3,2,left iliac\n");
    const CohortConfig own = folder.load(with("population: {labels: given, label_table: l.csv}"));
    EXPECT_EQ(own.tasks[0].identity.branch_labels, expected);
    EXPECT_EQ(own.labels.rule, LabelRule::kGiven);
    EXPECT_EQ(canonical_text(own.tasks[0]), canonical_text(folder.load(with("")).tasks[0])) << "no model is made anew";
    EXPECT_EQ(folder.load(resolved_text(own)).tasks[0].identity.branch_labels, expected);
}

TEST(BranchLabels, TemplateIsAModelOfTheCohort) {
    const Folder folder;
    const CohortConfig config = folder.load(with("population: {labels: template, template: a, directions: axes}"));
    EXPECT_EQ(config.labels.rule, LabelRule::kTemplate);
    EXPECT_EQ(config.labels.template_model, "a");
    EXPECT_TRUE(config.labels.axes);
    EXPECT_EQ(folder.error(with("population: {labels: template, template: z}")),
              "cohort.yaml:2: key 'template' names 'z', which is no model of the cohort");
    EXPECT_NE(folder.error(with("population: {labels: template}")), "");
}

TEST(BranchLabels, WhatIsNoneIsNamed) {
    const Folder folder;
    EXPECT_EQ(folder.error(model_with("branch_labels: {x: aorta}")),
              "cohort.yaml:5: key 'x' must be a whole number, not 'x'");
    EXPECT_NE(folder.error(model_with("branch_labels: {0: [a]}")).find("must be one label"), std::string::npos);
    EXPECT_NE(folder.error(model_with("branch_labels: {0: ' '}")).find("must not be empty"), std::string::npos);
    EXPECT_NE(folder.error(model_with("branch_labels: [a]")).find("must be a map"), std::string::npos);
    folder.write("t.tsv", "id\tsurface\tbranch_labels\na\ta.stl\t0:aorta\n");
    EXPECT_EQ(folder.error("cohort: c\nmodels: {table: t.tsv}\n"),
              "t.tsv:2: column 'branch_labels' must hold labels as NUMBER=LABEL with ';' between them, not '0:aorta'");
    const std::string yaml = with("population: {label_table: l.tsv}");
    folder.write("l.tsv", "id\tbranch\tbranch_label\na\t0\tx\n");
    EXPECT_NE(folder.error(yaml).find("column 'branch_id' is missing"), std::string::npos);
    folder.write("l.tsv", "id\tbranch_id\tbranch_label\nb\t0\tx\n");
    EXPECT_EQ(folder.error(yaml), "l.tsv:2: column 'id' names 'b', which is no model of the cohort");
    folder.write("l.tsv", "id\tbranch_id\tbranch_label\na\t0\tx\na\t0\ty\n");
    EXPECT_EQ(folder.error(yaml), "l.tsv:3: column 'branch_label' labels the branch 0 a second time");
}

}  // namespace
}  // namespace lumenline
