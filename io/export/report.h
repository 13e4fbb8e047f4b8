#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

namespace lumenline {

/// A model of a report.
struct ReportModel {
    std::string id, group, status, sentence;  ///< sentence: why it failed
    std::string rating, note;                 ///< by hand; empty = none
    std::string png;                          ///< its picture; empty = none
    std::string caption;                      ///< of the picture, or why there is none
    bool left_out = false;                    ///< failed, or rated bad
};

/// Values of one measure in one group, with its box.
struct ReportGroup {
    struct Point {
        double value = 0;
        std::size_t model = 0;  ///< place in Report::models
        bool is_outlier = false;
    };
    std::string name;
    std::vector<Point> points;
    double lower_quartile = 0, median = 0, upper_quartile = 0;
};

struct ReportMeasure {
    std::string name, unit, definition;
    std::vector<ReportGroup> groups;  ///< the same ones for each measure, also without a point
};

/// A value far from the others: z = (value - median) / (1.4826 MAD), over all models that count.
struct ReportOutlier {
    std::size_t model = 0;
    std::string measure, unit;
    double value = 0, median = 0, z = 0;
};

/// Findings of one code over the cohort.
struct ReportFinding {
    std::string code, severity;
    std::size_t models = 0;
};

/// What a report shows, made ready. Nothing in it is trusted: all text is escaped where it is written.
struct Report {
    std::string title;
    std::vector<std::pair<std::string, std::string>> counts;   ///< what, how many
    std::string coverage;                                      ///< of the distributions, one sentence
    std::vector<std::string> methods, references;              ///< paragraphs; entries
    std::vector<std::pair<std::string, std::string>> options;  ///< as the models were computed with
    std::string by;                                            ///< column of the groups
    double outlier_limit = 0;                                  ///< of |z|
    std::vector<ReportModel> models;
    std::vector<ReportMeasure> measures;
    std::vector<ReportOutlier> outliers;
    std::vector<ReportFinding> findings;
    std::size_t picture_size = 0;  ///< of the pictures' sides in pixels
    std::size_t unread = 0;        ///< models whose records are damaged or missing
    std::string ratings;           ///< the table to fill in, as a file
};

/// Writes one HTML page that needs nothing else: no script, no style, font or picture from outside, which its
/// content-security policy forbids as well. Light and dark as the reader's system is. The same bytes for the same
/// report.
void write_report(const Report& report, std::ostream& out);

}  // namespace lumenline
