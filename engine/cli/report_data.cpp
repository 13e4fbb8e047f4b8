#include "engine/cli/report_data.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "config/cohort.h"
#include "engine/cli/ratings.h"
#include "engine/cli/report_methods.h"
#include "engine/cli/table.h"
#include "engine/core/text.h"
#include "engine/population/describe.h"
#include "engine/population/rows.h"
#include "io/archive/index_names.h"
#include "io/archive/read.h"
#include "io/archive/utf8.h"
#include "io/export/thumbnail.h"

namespace lumenline {

namespace {

constexpr double kOutlierLimit = 3.5;    ///< Iglewicz & Hoaglin 1993
constexpr double kConsistent = 1.4826;   ///< MAD to standard deviation of a normal distribution
constexpr std::size_t kMostGroups = 12;  ///< more than these are one group, "others"
constexpr const char* kDiffers = "differs between models";

/// What the records of the models say of how they were made.
class Provenance {
public:
    void add(const ArchiveFile& model) {
        note(facts_.program, model, names::kProgram);
        note(facts_.commit, model, names::kCommit);
        note(facts_.hdf5, model, names::kHdf5Version);
        std::istringstream options(model.strings(names::kOptions.path).at(0));
        for (std::string line; std::getline(options, line);) {
            const std::size_t at = line.find('=');
            if (at == line.npos) continue;
            const std::string key = line.substr(0, at), value = line.substr(at + 1);
            const auto [entry, is_new] = facts_.options.try_emplace(key, value);
            if (!is_new && entry->second != value) entry->second = kDiffers;
        }
        std::set<std::pair<std::string, std::string>> own;
        const std::vector<std::string> code = model.strings(names::kCode.path),
                                       severity = model.strings(names::kSeverity.path);
        for (std::size_t k = 0; k < std::min(code.size(), severity.size()); ++k) own.emplace(code[k], severity[k]);
        for (const auto& finding : own) ++findings_[finding];
        facts_.characterized = facts_.characterized || model.has(names::kStatisticsGeodesic.path);
        facts_.branched = facts_.branched || model.has("/branches");
    }

    [[nodiscard]] const MethodsFacts& facts() const { return facts_; }

    [[nodiscard]] std::vector<ReportFinding> findings() const {
        std::vector<ReportFinding> all;
        for (const auto& [what, models] : findings_) all.push_back({what.first, what.second, models});
        std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.models > b.models; });
        return all;
    }

private:
    static void note(std::string& known, const ArchiveFile& model, const names::Field& field) {
        const std::string own = model.strings(field.path).at(0);
        if (known.empty() || known == own)
            known = own;
        else
            known = "several versions";
    }

    MethodsFacts facts_;  ///< without counts
    std::map<std::pair<std::string, std::string>, std::size_t> findings_;
};

/// @returns whether its record could be read
bool look_at_model(const std::filesystem::path& archive, std::size_t size, const std::string& unit, ReportModel& model,
                   Provenance& provenance) {
    try {
        const ArchiveFile file = open_model(archive, model.id);
        provenance.add(file);
        const Thumbnail drawn = draw_model(file, size);
        if (!drawn.picture.pixels.empty()) model.png = png_of(drawn.picture);
        if (drawn.largest > 0)
            model.caption = "0 to " + table_number(drawn.largest) + (unit == "unknown" ? "" : " " + unit);
        return true;
    } catch (const ArchiveError& error) {
        model.caption = error.what();
        return false;
    }
}

/// Groups in natural order; beyond the most, the small ones are one.
std::vector<std::string> group_names(const DataColumn& by, const std::vector<std::size_t>& rows) {
    std::map<std::string, std::size_t> sizes;
    for (const std::size_t row : rows) ++sizes[cell_text(by, row)];
    std::vector<std::string> names;
    for (const auto& [name, size] : sizes) names.push_back(name);
    std::stable_sort(names.begin(), names.end(),
                     [&](const auto& a, const auto& b) { return sizes.at(a) > sizes.at(b); });
    if (names.size() > kMostGroups) names.resize(kMostGroups);
    std::sort(names.begin(), names.end(), natural_less);
    return names;
}

struct Selection {
    std::vector<std::size_t> rows;      ///< that count
    std::vector<std::string> groups;    ///< their names
    std::vector<std::size_t> group_of;  ///< per row of the table
};

double median_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return quantile(values, 0.5);
}

ReportMeasure measure_of(const DataColumn& column, const Selection& chosen, std::vector<ReportOutlier>& outliers) {
    ReportMeasure measure{column.name, column.units, column.description, {}};
    for (const std::string& name : chosen.groups) measure.groups.push_back({name.empty() ? "none" : name, {}, 0, 0, 0});
    std::vector<double> all, distances;
    for (const std::size_t row : chosen.rows)
        if (std::isfinite(column.numbers()[row])) all.push_back(column.numbers()[row]);
    if (all.empty()) return measure;
    const double median = median_of(all);
    for (const double value : all) distances.push_back(std::fabs(value - median));
    const double spread = kConsistent * median_of(distances);
    for (const std::size_t row : chosen.rows) {
        const double value = column.numbers()[row], z = spread > 0 ? (value - median) / spread : 0;
        if (!std::isfinite(value)) continue;
        const bool is_outlier = std::fabs(z) > kOutlierLimit;
        measure.groups[chosen.group_of[row]].points.push_back({value, row, is_outlier});
        if (is_outlier) outliers.push_back({row, column.name, column.units, value, median, z});
    }
    for (ReportGroup& group : measure.groups) {
        std::vector<double> values;
        for (const ReportGroup::Point& point : group.points) values.push_back(point.value);
        const Description d = describe(values);
        group.lower_quartile = d.lower_quartile;
        group.median = d.median;
        group.upper_quartile = d.upper_quartile;
    }
    return measure;
}

Selection select(const DataTable& table, const std::string& by, Coverage& coverage) {
    Selection chosen;
    chosen.rows = select_rows(table, StudyOptions(), coverage);
    const DataColumn& column = column_of(table, by);
    chosen.groups = group_names(column, chosen.rows);
    const std::size_t others = chosen.groups.size();
    chosen.group_of.resize(table.rows);
    bool any_other = false;
    for (const std::size_t row : chosen.rows) {
        const auto found = std::find(chosen.groups.begin(), chosen.groups.end(), cell_text(column, row));
        chosen.group_of[row] = static_cast<std::size_t>(found - chosen.groups.begin());
        any_other = any_other || chosen.group_of[row] == others;
    }
    if (any_other) chosen.groups.emplace_back("others");
    return chosen;
}

/// The text of a column where it has one for each model.
std::string text_at(const DataTable& table, const char* name, std::size_t row) {
    const DataColumn* column = table.find(name);
    return column == nullptr ? "" : cell_text(*column, row);
}

std::vector<ReportModel> list(const DataTable& table, const DataTable& failures, const std::string& by,
                              const Selection& chosen) {
    std::map<std::string, std::string> sentence;
    for (std::size_t row = 0; row < failures.rows; ++row)
        sentence[text_at(failures, "id", row)] = text_at(failures, "sentence", row);
    std::vector<ReportModel> models(table.rows);
    for (std::size_t row = 0; row < table.rows; ++row) {
        ReportModel& model = models[row];
        model.id = text_at(table, "id", row);
        model.status = text_at(table, "status", row);
        model.group = text_at(table, by.c_str(), row);
        model.rating = text_at(table, "rating", row);
        model.note = text_at(table, "rating_note", row);
        if (model.status == "failed") model.sentence = sentence.contains(model.id) ? sentence.at(model.id) : "unknown";
        model.left_out = !std::binary_search(chosen.rows.begin(), chosen.rows.end(), row);
    }
    return models;
}

std::size_t count_if(const std::vector<ReportModel>& models, const std::function<bool(const ReportModel&)>& is) {
    return static_cast<std::size_t>(std::count_if(models.begin(), models.end(), is));
}

}  // namespace

Report gather_report(const std::filesystem::path& archive, const ReportOptions& options,
                     const std::function<void(std::size_t, std::size_t)>& progress) {
    DataTable table = read_data_table(archive, "models");
    if (!options.ratings.empty()) add_ratings(options.ratings, table);
    Coverage coverage;
    const Selection chosen = select(table, options.by, coverage);
    Report report;
    report.title =
        cohort_name(ArchiveFile(index_or_file(archive)).strings(names::kConfigResolved.path).at(0)) + ": report";
    report.by = options.by;
    report.outlier_limit = kOutlierLimit;
    report.picture_size = options.picture_size;
    report.models = list(table, read_data_table(archive, "failures"), options.by, chosen);
    std::vector<const DataColumn*> columns;
    for (const std::string& name : options.measures) columns.push_back(&numbers_of(table, name));
    for (const DataColumn& column : table.columns)
        if (options.measures.empty() && column.is_measure) columns.push_back(&column);
    for (const DataColumn* column : columns) report.measures.push_back(measure_of(*column, chosen, report.outliers));
    std::stable_sort(report.outliers.begin(), report.outliers.end(),
                     [](const auto& a, const auto& b) { return std::fabs(a.z) > std::fabs(b.z); });

    Provenance provenance;
    for (std::size_t m = 0; m < report.models.size(); ++m) {
        progress(m, report.models.size());
        if (!look_at_model(archive, options.picture_size, text_at(table, "length_unit", m), report.models[m],
                           provenance))
            ++report.unread;
    }
    MethodsFacts facts = provenance.facts();
    facts.models = table.rows;
    facts.failed = count_if(report.models, [](const auto& m) { return m.status == "failed"; });
    facts.rated_bad = count_if(report.models, [](const auto& m) { return m.rating == "bad" && m.status != "failed"; });
    report.methods = methods_text(facts);
    report.references = methods_references();
    report.options = {facts.options.begin(), facts.options.end()};
    report.findings = provenance.findings();
    report.coverage = std::to_string(coverage.rows_used) + " of " + counted(coverage.rows_in, "model") + " count" +
                      (coverage.left_out.empty() ? "" : "; left out: " + coverage.reasons()) + ".";
    report.counts = {{"models", std::to_string(table.rows)}};
    for (const char* status : {"ok", "warning", "failed"})
        report.counts.emplace_back(
            status, std::to_string(count_if(report.models, [&](const auto& m) { return m.status == status; })));
    if (report.unread > 0) report.counts.emplace_back("could not be read", std::to_string(report.unread));
    if (!options.ratings.empty()) report.counts.emplace_back("rated bad", std::to_string(facts.rated_bad));
    report.counts.emplace_back("in the measures", std::to_string(coverage.rows_used));
    report.ratings = ratings_table(table);
    return report;
}

}  // namespace lumenline
