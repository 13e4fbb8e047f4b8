#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/data_table.h"
#include "engine/population/agreement.h"
#include "engine/population/describe.h"
#include "engine/population/hypothesis.h"
#include "engine/population/regression.h"

namespace lumenline {

/// What a study of a table is asked for. Columns are named as in the table.
struct StudyOptions {
    std::string by;                     ///< groups to compare; empty = all rows are one
    std::vector<std::string> measures;  ///< empty = all columns of measures
    std::vector<std::string> where;     ///< conditions, see `rows_where`; all must hold
    std::string subject;                ///< rows of one are not independent; empty = `subject`, if there is one
    std::string label;                  ///< rows of different labels are studied apart, as branches are
    std::string bin_by;                 ///< a column of numbers from 0 to 1, cut into `bins`, studied apart: a profile
    std::size_t bins = 20;
    std::string normalize_by;            ///< measures are divided by this column
    std::vector<std::string> adjust;     ///< covariates of a linear model beside the groups
    std::vector<std::string> correlate;  ///< columns to correlate measures with
    std::string retest;  ///< column of occasions (as `session`): the first two, in order of their names, are compared
    std::size_t bootstrap = 0;  ///< draws of subjects; 0 = the values of a subject are averaged first
    std::uint64_t seed = 1;
    double confidence = 0.95;
};

/// What is studied apart.
struct Stratum {
    std::string measure, label, bin;
};

/// Where the values of a line come from.
struct Coverage {
    std::size_t rows_in = 0, rows_used = 0;
    std::vector<std::pair<std::string, std::size_t>> left_out;  ///< reason, rows

    [[nodiscard]] std::string reasons() const;  ///< "2 failed, 1 without a value"
};

struct GroupLine {
    Stratum stratum;
    std::string group;
    Coverage coverage;
    std::vector<double> values;  ///< one per unit, ascending
    Description description;
    double p5 = 0, p95 = 0;
};

/// Groups a and b; q are p adjusted over all comparisons of the study, each test a family.
struct ComparisonLine {
    Stratum stratum;
    std::string a, b;
    std::size_t count_a = 0, count_b = 0;
    Coverage coverage;
    WelchResult welch;  ///< with bootstrap: only the difference and its interval, from the draws
    TestResult mann_whitney, brown_forsythe;
    double welch_q = 0, mann_whitney_q = 0, brown_forsythe_q = 0;
};

struct CorrelationLine {
    Stratum stratum;
    std::string with;
    std::size_t count = 0;
    Coverage coverage;
    CorrelationResult pearson, spearman;
    double pearson_q = 0, spearman_q = 0;
};

struct RegressionLine {
    Stratum stratum;
    Coverage coverage;
    Regression model;
};

struct AgreementLine {
    Stratum stratum;
    std::string first, second;  ///< occasions
    Coverage coverage;
    Agreement agreement;
    std::vector<std::pair<std::string, std::pair<double, double>>> subjects;  ///< values of both occasions
};

struct Study {
    std::string unit;  ///< what counts as one observation, in a sentence
    Coverage coverage;
    std::vector<GroupLine> groups;
    std::vector<ComparisonLine> comparisons;
    std::vector<CorrelationLine> correlations;
    std::vector<RegressionLine> regressions;
    std::vector<AgreementLine> agreements;
};

/// A request that a table cannot meet; the sentence says which column is missing and which there are.
class StudyError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Statistics of a table's measures by group.
///
/// Rows of models that failed (column `status`) or are rated bad (column `rating`) are left out, and counted with
/// their reason in each line. A subject's values of one group, label and bin are averaged first, so that observations
/// are independent; with `bootstrap`, they are kept and whole subjects drawn. A row without subject is one of its own.
/// @throws StudyError
Study study_table(const DataTable& table, const StudyOptions& options);

}  // namespace lumenline
