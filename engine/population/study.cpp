// One stratum at a time: a measure, of one label, in one bin. Its rows become observations, one per subject and group
// unless subjects are drawn; everything else is arithmetic on these.
#include "engine/population/study.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "engine/core/text.h"
#include "engine/population/bootstrap.h"
#include "engine/population/rows.h"

namespace lumenline {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Sum of values that may be missing.
struct Mean {
    double sum = 0;
    std::size_t count = 0;

    void add(double value) {
        if (std::isnan(value)) return;
        sum += value;
        ++count;
    }
    [[nodiscard]] double value() const { return count > 0 ? sum / static_cast<double>(count) : kNaN; }
};

/// The rows of one subject in one group of a stratum.
struct Observation {
    std::string group, subject;
    std::vector<double> values;
    std::vector<std::size_t> rows;
    [[nodiscard]] double mean() const {
        Mean m;
        for (const double v : values) m.add(v);
        return m.value();
    }
};

struct NaturalLess {
    bool operator()(const std::string& a, const std::string& b) const { return natural_less(a, b); }
};

class Studying {
public:
    Studying(const DataTable& table, const StudyOptions& options) : table_(table), options_(options) {
        by_ = optional_column(options.by);
        label_ = optional_column(options.label);
        retest_ = optional_column(options.retest);
        subject_ = options.subject.empty() ? table.find("subject") : &column_of(table, options.subject);
        id_ = table.find("id");
        if (!options.bin_by.empty()) bin_by_ = &numbers_of(table, options.bin_by);
        if (!options.normalize_by.empty()) normalize_by_ = &numbers_of(table, options.normalize_by);
        for (const std::string& name : options.correlate) correlate_.push_back(&numbers_of(table, name));
        for (const std::string& name : options.adjust) adjust_.push_back(&column_of(table, name));
        for (const std::string& name : options.measures) measures_.push_back(&numbers_of(table, name));
        if (options.measures.empty()) take_all_measures();
        if (options.bins == 0) throw StudyError("a profile needs at least one bin");
    }

    Study run() {
        rows_ = select_rows(table_, options_, study_.coverage);
        study_.unit = unit();
        std::map<std::pair<std::size_t, std::string>, std::vector<std::size_t>> parts;  // by bin and label
        for (const std::size_t row : rows_) {
            const std::optional<std::size_t> bin = bin_of(row);
            if (!bin) {
                leave_out(study_.coverage, is_missing(*bin_by_, row)
                                               ? "without '" + options_.bin_by + "'"
                                               : "with '" + options_.bin_by + "' outside of 0 to 1");
                --study_.coverage.rows_used;
                continue;
            }
            parts[{*bin, label_ != nullptr ? cell_text(*label_, row) : ""}].push_back(row);
        }
        for (const DataColumn* measure : measures_)
            for (const auto& [key, rows] : parts) {
                measure_ = measure;
                stratum_ = {measure->name, key.second, bin_text(key.first)};
                study_stratum(rows);
            }
        adjust_p_values();
        return std::move(study_);
    }

private:
    [[nodiscard]] const DataColumn* optional_column(const std::string& name) const {
        return name.empty() ? nullptr : &column_of(table_, name);
    }

    void take_all_measures() {
        for (const DataColumn& c : table_.columns)
            if (c.is_measure && c.is_number() && &c != bin_by_ && &c != normalize_by_) measures_.push_back(&c);
        if (measures_.empty()) throw StudyError("the table '" + table_.name + "' has no column of measures");
    }

    [[nodiscard]] std::string unit() const {
        if (options_.bootstrap > 0)
            return "rows; intervals by drawing whole subjects " + std::to_string(options_.bootstrap) + " times";
        return label_ != nullptr ? "subjects, apart by '" + options_.label + "': rows of one are averaged first"
                                 : "subjects: rows of one are averaged first";
    }

    [[nodiscard]] std::optional<std::size_t> bin_of(std::size_t row) const {
        if (bin_by_ == nullptr) return 0;
        const double place = bin_by_->numbers()[row];
        if (!(place >= 0 && place <= 1)) return std::nullopt;
        return std::min(static_cast<std::size_t>(place * static_cast<double>(options_.bins)), options_.bins - 1);
    }

    [[nodiscard]] std::string bin_text(std::size_t bin) const {
        if (bin_by_ == nullptr) return "";
        const double count = static_cast<double>(options_.bins), first = static_cast<double>(bin);
        return short_text(first / count, 3) + "-" + short_text((first + 1) / count, 3);
    }

    [[nodiscard]] double value_of(std::size_t row) const {
        const double value = measure_->numbers()[row];
        return normalize_by_ != nullptr ? value / normalize_by_->numbers()[row] : value;
    }

    [[nodiscard]] std::string subject_of(std::size_t row) const {
        std::string subject = subject_ != nullptr ? cell_text(*subject_, row) : "";
        if (!subject.empty()) return subject;
        return id_ != nullptr ? cell_text(*id_, row) : "row " + std::to_string(row);
    }

    void study_stratum(const std::vector<std::size_t>& rows) {
        // What was left out before has no label or bin to be told apart by: it counts for every stratum.
        coverage_ = study_.coverage;
        coverage_.rows_used = 0;
        const std::size_t elsewhere = rows_.size() - rows.size();
        coverage_.rows_in -= elsewhere;
        std::map<std::pair<std::string, std::string>, Observation> found;
        for (const std::size_t row : rows) {
            const double value = value_of(row);
            const std::string group = by_ != nullptr ? cell_text(*by_, row) : "all";
            if (group.empty())
                leave_out(coverage_, "without '" + options_.by + "'");
            else if (!std::isfinite(value))
                leave_out(coverage_, "without a value");
            else {
                Observation& o = found[{group, subject_of(row)}];
                std::tie(o.group, o.subject) = std::tuple(group, subject_of(row));
                o.values.push_back(value);
                o.rows.push_back(row);
                ++coverage_.rows_used;
            }
        }
        observations_.clear();
        for (auto& [key, o] : found) observations_.push_back(std::move(o));
        describe_groups();
        for (const DataColumn* with : correlate_) correlate(*with);
        if (!adjust_.empty()) regress();
        if (retest_ != nullptr) compare_occasions(rows);
    }

    void describe_groups() {
        std::map<std::string, std::vector<Cluster>, NaturalLess> groups;
        for (const Observation& o : observations_)
            groups[o.group].push_back(options_.bootstrap > 0 ? o.values : std::vector<double>{o.mean()});
        std::vector<std::pair<std::string, std::vector<double>>> flat;
        for (const auto& [name, clusters] : groups) {
            GroupLine line{stratum_, name, coverage_, {}, {}, kNaN, kNaN};
            for (const Cluster& c : clusters) line.values.insert(line.values.end(), c.begin(), c.end());
            std::sort(line.values.begin(), line.values.end());
            line.description = describe(line.values);
            line.p5 = quantile(line.values, 0.05);
            line.p95 = quantile(line.values, 0.95);
            flat.emplace_back(name, line.values);
            study_.groups.push_back(std::move(line));
        }
        for (std::size_t i = 0; i < flat.size(); ++i)
            for (std::size_t j = i + 1; j < flat.size(); ++j) {
                const auto& [a, in_a] = flat[i];
                const auto& [b, in_b] = flat[j];
                ComparisonLine line{stratum_, a, b, in_a.size(), in_b.size(), coverage_, {}, {}, {}, kNaN, kNaN, kNaN};
                if (options_.bootstrap > 0) {
                    line.welch.difference = bootstrap_difference(groups[a], groups[b], options_.confidence,
                                                                 options_.bootstrap, options_.seed);
                } else {
                    line.welch = welch_test(in_a, in_b, options_.confidence);
                    line.mann_whitney = mann_whitney_test(in_a, in_b);
                    line.brown_forsythe = brown_forsythe_test(std::vector{in_a, in_b});
                }
                study_.comparisons.push_back(std::move(line));
            }
    }

    [[nodiscard]] static double mean_over(const DataColumn& column, const Observation& o) {
        Mean m;
        for (const std::size_t row : o.rows) m.add(column.numbers()[row]);
        return m.value();
    }

    void correlate(const DataColumn& with) {
        std::vector<double> x, y;
        Coverage coverage = coverage_;
        for (const Observation& o : observations_) {
            const double value = mean_over(with, o);
            if (std::isnan(value)) {
                leave_out(coverage, "without '" + with.name + "'", o.rows.size());
                coverage.rows_used -= o.rows.size();
                continue;
            }
            x.push_back(value);
            y.push_back(o.mean());
        }
        study_.correlations.push_back({stratum_, with.name, x.size(), coverage,
                                       pearson_correlation(x, y, options_.confidence),
                                       spearman_correlation(x, y, options_.confidence), kNaN, kNaN});
    }

    void regress() {
        RegressionLine line{stratum_, coverage_, {}};
        std::vector<const Observation*> complete;
        for (const Observation& o : observations_) {
            const auto has = [&](const DataColumn* c) {
                return c->is_number() ? !std::isnan(mean_over(*c, o)) : !cell_text(*c, o.rows.front()).empty();
            };
            if (std::all_of(adjust_.begin(), adjust_.end(), has)) {
                complete.push_back(&o);
                continue;
            }
            leave_out(line.coverage, "without a covariate", o.rows.size());
            line.coverage.rows_used -= o.rows.size();
        }
        std::vector<double> y;
        for (const Observation* o : complete) y.push_back(o->mean());
        std::vector<Predictor> predictors;
        if (by_ != nullptr)
            add_levels(
                options_.by, complete, [](const Observation& o) { return o.group; }, predictors);
        for (const DataColumn* c : adjust_) {
            if (!c->is_number()) {
                add_levels(
                    c->name, complete, [c](const Observation& o) { return cell_text(*c, o.rows.front()); }, predictors);
                continue;
            }
            Predictor p{c->name, {}};
            for (const Observation* o : complete) p.values.push_back(mean_over(*c, *o));
            predictors.push_back(std::move(p));
        }
        line.model = fit_linear(y, predictors, options_.confidence);
        study_.regressions.push_back(std::move(line));
    }

    /// One predictor for each level but the first: 1 where an observation has it.
    template <class Level>
    static void add_levels(const std::string& name, const std::vector<const Observation*>& observations, Level level,
                           std::vector<Predictor>& predictors) {
        std::set<std::string, NaturalLess> levels;
        for (const Observation* o : observations) levels.insert(level(*o));
        for (const std::string& value : levels) {
            if (value == *levels.begin()) continue;
            Predictor p{name + "=" + value, {}};
            for (const Observation* o : observations) p.values.push_back(level(*o) == value ? 1 : 0);
            predictors.push_back(std::move(p));
        }
    }

    void compare_occasions(const std::vector<std::size_t>& rows) {
        std::map<std::string, std::map<std::string, Mean>, NaturalLess> occasions;
        for (const std::size_t row : rows)
            if (const std::string occasion = cell_text(*retest_, row); !occasion.empty())
                occasions[occasion][subject_of(row)].add(value_of(row));
        AgreementLine line{stratum_, "", "", coverage_, {}, {}};
        if (occasions.size() < 2)
            throw StudyError("the column '" + options_.retest + "' names fewer than two occasions to compare");
        const auto& [first_name, first] = *occasions.begin();
        const auto& [second_name, second] = *std::next(occasions.begin());
        std::tie(line.first, line.second) = std::tie(first_name, second_name);
        std::vector<double> a, b;
        for (const auto& [subject, value] : first) {
            const auto other = second.find(subject);
            if (other == second.end() || value.count == 0 || other->second.count == 0) continue;
            a.push_back(value.value());
            b.push_back(other->second.value());
            line.subjects.push_back({subject, {a.back(), b.back()}});
        }
        line.agreement = agreement(a, b, options_.confidence);
        study_.agreements.push_back(std::move(line));
    }

    void adjust_p_values() {
        const auto adjust = [](auto& lines, auto p, auto q) {
            std::vector<double> values;
            for (const auto& line : lines) values.push_back(p(line));
            const std::vector<double> adjusted = benjamini_hochberg(values);
            for (std::size_t i = 0; i < lines.size(); ++i) lines[i].*q = adjusted[i];
        };
        auto& c = study_.comparisons;
        adjust(
            c, [](const ComparisonLine& l) { return l.welch.test.p; }, &ComparisonLine::welch_q);
        adjust(
            c, [](const ComparisonLine& l) { return l.mann_whitney.p; }, &ComparisonLine::mann_whitney_q);
        adjust(
            c, [](const ComparisonLine& l) { return l.brown_forsythe.p; }, &ComparisonLine::brown_forsythe_q);
        auto& r = study_.correlations;
        adjust(
            r, [](const CorrelationLine& l) { return l.pearson.p; }, &CorrelationLine::pearson_q);
        adjust(
            r, [](const CorrelationLine& l) { return l.spearman.p; }, &CorrelationLine::spearman_q);
    }

    const DataTable& table_;
    const StudyOptions& options_;
    const DataColumn *by_ = nullptr, *label_ = nullptr, *retest_ = nullptr, *subject_ = nullptr, *id_ = nullptr;
    const DataColumn *bin_by_ = nullptr, *normalize_by_ = nullptr, *measure_ = nullptr;
    std::vector<const DataColumn*> measures_, correlate_, adjust_;
    Study study_;
    std::vector<std::size_t> rows_;
    Stratum stratum_;
    Coverage coverage_;
    std::vector<Observation> observations_;
};

}  // namespace

Study study_table(const DataTable& table, const StudyOptions& options) { return Studying(table, options).run(); }

}  // namespace lumenline
