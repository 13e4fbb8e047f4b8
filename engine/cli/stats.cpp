// Every result is a table of its own, the same in text, TSV and JSON: printed for people, in one file with a line of
// its name before each, or as one object.

#include "engine/cli/stats.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <variant>
#include <vector>

#include "engine/cli/ratings.h"
#include "engine/cli/run.h"
#include "engine/cli/standard_output.h"
#include "engine/cli/table.h"
#include "engine/core/text.h"
#include "engine/population/study.h"
#include "io/archive/read.h"
#include "io/archive/utf8.h"

namespace lumenline {

namespace {

constexpr int kMostBins = 10'000;
constexpr int kMostDraws = 1'000'000;  ///< beyond, intervals no longer change and draws fill the memory

struct Request {
    std::string archive, table = "models", format = "text", ratings;
    StudyOptions study;
};

using Cell = std::variant<std::string, double, std::size_t>;

template <class NumberText>
std::string text_of(const Cell& cell, NumberText number_text) {
    if (const auto* text = std::get_if<std::string>(&cell)) return *text;
    if (const auto* count = std::get_if<std::size_t>(&cell)) return std::to_string(*count);
    return number_text(std::get<double>(cell));
}

struct Result {
    std::string name;
    std::vector<std::string> headings;
    std::vector<std::vector<Cell>> rows;
};

/// Which columns of the strata say anything.
struct Shown {
    bool label = false, bin = false;
};

Result result_of(std::string name, const Shown& shown, std::initializer_list<const char*> headings) {
    Result result{std::move(name), {"measure"}, {}};
    if (shown.label) result.headings.emplace_back("label");
    if (shown.bin) result.headings.emplace_back("bin");
    result.headings.insert(result.headings.end(), headings.begin(), headings.end());
    for (const char* heading : {"rows_in", "rows_used", "left_out"}) result.headings.emplace_back(heading);
    return result;
}

void add_row(Result& result, const Shown& shown, const Stratum& stratum, const Coverage& coverage,
             std::vector<Cell> cells) {
    std::vector<Cell> row{stratum.measure};
    if (shown.label) row.emplace_back(stratum.label);
    if (shown.bin) row.emplace_back(stratum.bin);
    row.insert(row.end(), cells.begin(), cells.end());
    row.insert(row.end(), {coverage.rows_in, coverage.rows_used, coverage.reasons()});
    result.rows.push_back(std::move(row));
}

std::vector<Result> results_of(const Study& study, const Shown& shown) {
    Result groups = result_of(
        "groups", shown,
        {"group", "n", "mean", "sd", "median", "lower_quartile", "upper_quartile", "p5", "p95", "min", "max"});
    for (const GroupLine& l : study.groups) {
        const Description& d = l.description;
        add_row(groups, shown, l.stratum, l.coverage,
                {l.group, d.count, d.mean, d.sd, d.median, d.lower_quartile, d.upper_quartile, l.p5, l.p95, d.least,
                 d.largest});
    }
    Result comparisons = result_of("comparisons", shown,
                                   {"a", "b", "n_a", "n_b", "difference", "low", "high", "welch_t", "freedom",
                                    "welch_p", "welch_q", "mann_whitney_u", "mann_whitney_p", "mann_whitney_q",
                                    "brown_forsythe_f", "brown_forsythe_p", "brown_forsythe_q"});
    for (const ComparisonLine& l : study.comparisons)
        add_row(
            comparisons, shown, l.stratum, l.coverage,
            {l.a, l.b, l.count_a, l.count_b, l.welch.difference.value, l.welch.difference.low, l.welch.difference.high,
             l.welch.test.statistic, l.welch.freedom, l.welch.test.p, l.welch_q, l.mann_whitney.statistic,
             l.mann_whitney.p, l.mann_whitney_q, l.brown_forsythe.statistic, l.brown_forsythe.p, l.brown_forsythe_q});
    Result correlations = result_of("correlations", shown,
                                    {"with", "n", "pearson_r", "low", "high", "pearson_p", "pearson_q", "spearman_rho",
                                     "rho_low", "rho_high", "spearman_p", "spearman_q"});
    for (const CorrelationLine& l : study.correlations)
        add_row(correlations, shown, l.stratum, l.coverage,
                {l.with, l.count, l.pearson.coefficient.value, l.pearson.coefficient.low, l.pearson.coefficient.high,
                 l.pearson.p, l.pearson_q, l.spearman.coefficient.value, l.spearman.coefficient.low,
                 l.spearman.coefficient.high, l.spearman.p, l.spearman_q});
    Result regressions =
        result_of("regressions", shown, {"term", "n", "coefficient", "low", "high", "error", "t", "p", "r_squared"});
    for (const RegressionLine& l : study.regressions)
        for (const RegressionTerm& t : l.model.terms)
            add_row(regressions, shown, l.stratum, l.coverage,
                    {t.name, l.model.count, t.coefficient.value, t.coefficient.low, t.coefficient.high, t.error,
                     t.test.statistic, t.test.p, l.model.r_squared});
    Result agreements = result_of("agreement", shown,
                                  {"first", "second", "n", "icc", "icc_low", "icc_high", "bias", "bias_low",
                                   "bias_high", "sd", "lower_limit", "upper_limit"});
    Result changes = result_of("changes", shown, {"subject", "first", "second", "change", "relative_change"});
    for (const AgreementLine& l : study.agreements) {
        const Agreement& a = l.agreement;
        add_row(agreements, shown, l.stratum, l.coverage,
                {l.first, l.second, a.count, a.icc.value, a.icc.low, a.icc.high, a.bias.value, a.bias.low, a.bias.high,
                 a.sd, a.lower_limit.value, a.upper_limit.value});
        for (const auto& [subject, values] : l.subjects)
            add_row(changes, shown, l.stratum, l.coverage,
                    {subject, values.first, values.second, values.second - values.first,
                     (values.second - values.first) / values.first});
    }
    std::vector<Result> results;
    for (Result* r : {&groups, &comparisons, &correlations, &regressions, &agreements, &changes})
        if (!r->rows.empty()) results.push_back(std::move(*r));
    return results;
}

std::string sentence(const Study& study) {
    std::string text = fmt::format("{} of {} taken", study.coverage.rows_used, counted(study.coverage.rows_in, "row"));
    if (!study.coverage.left_out.empty()) text += "; left out: " + study.coverage.reasons();
    return text + "; every line says how many of them it used; observations are " + study.unit;
}

void print_text(const Study& study, const std::vector<Result>& results, std::ostream& out) {
    out << sentence(study) << '\n';
    for (const Result& result : results) {
        out << '\n' << result.name << '\n';
        TextTable table;
        for (std::size_t c = 0; c < result.headings.size(); ++c)
            table.add_column(result.headings[c], std::holds_alternative<std::string>(result.rows.front()[c])
                                                     ? TextTable::Align::kLeft
                                                     : TextTable::Align::kRight);
        for (const auto& row : result.rows) {
            std::vector<std::string> cells;
            for (const Cell& cell : row) cells.push_back(text_of(cell, table_number));
            table.add_row(cells);
        }
        table.print(out);
    }
}

void print_tsv(const Study& study, const std::vector<Result>& results, std::ostream& out) {
    out << "# " << printable(sentence(study)) << '\n';
    for (const Result& result : results) {
        out << "# " << result.name << '\n';
        for (std::size_t c = 0; c < result.headings.size(); ++c) out << (c > 0 ? "\t" : "") << result.headings[c];
        out << '\n';
        for (const auto& row : result.rows) {
            for (std::size_t c = 0; c < row.size(); ++c)
                out << (c > 0 ? "\t" : "") << printable(text_of(row[c], exact_text));
            out << '\n';
        }
    }
}

void print_json(const Study& study, const std::vector<Result>& results, std::ostream& out) {
    nlohmann::ordered_json document;
    document["observations"] = study.unit;
    document["rows_in"] = study.coverage.rows_in;
    document["rows_used"] = study.coverage.rows_used;
    document["left_out"] = study.coverage.reasons();
    for (const Result& result : results) {
        auto& rows = document[result.name] = nlohmann::ordered_json::array();
        for (const auto& row : result.rows) {
            nlohmann::ordered_json& object = rows.emplace_back();
            for (std::size_t c = 0; c < row.size(); ++c) {
                nlohmann::ordered_json& value = object[result.headings[c]];  // null where a number is not finite
                std::visit([&value](const auto& v) { value = v; }, row[c]);
            }
        }
    }
    out << document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
}

int run(const Request& request) {
    DataTable table = read_data_table(request.archive, request.table);
    if (!request.ratings.empty()) add_ratings(request.ratings, table);
    const Study study = study_table(table, request.study);
    const std::vector<Result> results =
        results_of(study, {!request.study.label.empty(), !request.study.bin_by.empty()});
    to_standard_output([&](std::ostream& out) {
        if (request.format == "json")
            print_json(study, results, out);
        else if (request.format == "tsv")
            print_tsv(study, results, out);
        else
            print_text(study, results, out);
    });
    return kDone;
}

}  // namespace

void add_stats(CLI::App& app, std::function<int()>& action) {
    const auto request = std::make_shared<Request>();
    StudyOptions& study = request->study;
    CLI::App* verb = app.add_subcommand("stats", "Statistics of an archive's tables by group");
    verb->add_option("ARCHIVE", request->archive, "directory with a cohort.h5, or a packed archive")->required();
    verb->add_option("--by", study.by, "column whose groups are compared; without it all rows are one group");
    verb->add_option("--table", request->table, "table of the index: models, branches, ...")->capture_default_str();
    verb->add_option("--measure", study.measures, "columns, with commas between; default: all measures of the table")
        ->delimiter(',');
    verb->add_option(
        "--where", study.where,
        "'COLUMN OP VALUE', OP one of = != < <= > >=; may be repeated: all hold; 'COLUMN =' is what has no value, "
        "'COLUMN !=' the rest");
    verb->add_option("--subject", study.subject,
                     "column of subjects, whose rows are not independent; default: subject, where the table has it");
    verb->add_option("--label", study.label, "column whose values are studied apart, as branch_label");
    verb->add_option("--bin-by", study.bin_by,
                     "column of numbers from 0 to 1 to make a profile over, as abscissa_relative of sections");
    verb->add_option("--bins", study.bins, "of the profile")->check(CLI::Range(1, kMostBins))->capture_default_str();
    verb->add_option("--normalize-by", study.normalize_by, "column that measures are divided by, as body size");
    verb->add_option("--adjust", study.adjust, "covariates of a linear model beside the groups")->delimiter(',');
    verb->add_option("--correlate", study.correlate, "columns to correlate the measures with")->delimiter(',');
    verb->add_option("--retest", study.retest,
                     "column of occasions, as 'session': agreement and change between the first two");
    verb->add_option("--bootstrap", study.bootstrap,
                     "draw whole subjects this many times for the intervals, instead of averaging each one's rows")
        ->check(CLI::Range(0, kMostDraws));
    verb->add_option("--seed", study.seed, "of the draws")->check(CLI::NonNegativeNumber)->capture_default_str();
    verb->add_option("--confidence", study.confidence, "of the intervals")
        ->check(CLI::Range(0.5, 0.9999))
        ->capture_default_str();
    verb->add_option(
        "--ratings", request->ratings,
        "TSV or CSV with the columns model and rating, as report writes it: models rated 'bad' are left out");
    verb->add_option("--format", request->format, "text, tsv or json")
        ->check(CLI::IsMember({"text", "tsv", "json"}))
        ->capture_default_str();
    verb->footer(
        "Rows of one subject are averaged per group first, so that observations are independent; --bootstrap keeps\n"
        "them and draws whole subjects. q: p adjusted over all comparisons of one test (Benjamini & Hochberg).\n"
        "Exit status: 0 done, 1 the archive is damaged, 2 no such archive, table or column, or a wrong condition.");
    verb->callback([request, &action] { action = [request] { return run(*request); }; });
}

}  // namespace lumenline
