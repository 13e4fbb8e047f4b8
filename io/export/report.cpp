// One page from top to bottom: what was done, what came of it, what stands out, and every model. Colours are variables
// of the style, so that the same marks serve on light and dark ground.

#include "io/export/report.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <ostream>

#include "engine/core/text.h"
#include "io/archive/utf8.h"
#include "io/export/report_parts.h"

namespace lumenline {

namespace {

constexpr std::size_t kMostOutliers = 200;  ///< rows of the table

constexpr const char* kStyle = R"(
:root{color-scheme:light dark;--ink:#1b1f24;--soft:#5b6570;--line:#d5dae0;--ground:#fff;--panel:#f5f7f9;--mark:#0072b2;
--box:#0072b226;--odd:#d55e00;--bad:#b3261e;--warn:#8a5a00;--ok:#1a7f4b}
@media(prefers-color-scheme:dark){:root{--ink:#e6e9ed;--soft:#9aa5b1;--line:#343c46;--ground:#14181d;--panel:#1d232a;
--mark:#56b4e9;--box:#56b4e92e;--odd:#f0883e;--bad:#ff8a80;--warn:#e3b341;--ok:#5fd38d}}
*{box-sizing:border-box}
body{margin:0 auto;max-width:1160px;padding:24px 28px 64px;background:var(--ground);color:var(--ink);
font:15px/1.5 system-ui,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif}
h1{font-size:27px;margin:0 0 4px}h2{font-size:20px;margin:44px 0 10px;padding-bottom:4px;border-bottom:1px solid var(--line)}
h3{font-size:14px;margin:0;font-weight:600}p{margin:8px 0;max-width:78ch}.soft{color:var(--soft)}
nav a{margin-right:16px}a{color:var(--mark)}
.counts{display:flex;flex-wrap:wrap;gap:12px;margin:18px 0}.counts div{background:var(--panel);border:1px solid var(--line);
border-radius:8px;padding:10px 16px;min-width:104px}.counts b{display:block;font-size:23px;font-variant-numeric:tabular-nums}
.counts span{color:var(--soft)}
table{border-collapse:collapse;margin:10px 0;font-variant-numeric:tabular-nums}th{text-align:left;font-weight:600}
th,td{padding:4px 18px 4px 0;border-bottom:1px solid var(--line);vertical-align:top}td.n,th.n{text-align:right}
.spreads{display:grid;grid-template-columns:repeat(auto-fill,minmax(500px,1fr));gap:22px 28px}
.spreads figure{margin:0}figcaption{color:var(--soft);font-size:13px}
svg{width:100%;height:auto;display:block;margin-top:4px}svg text{font-size:12px;fill:var(--soft)}svg .count{fill:var(--soft);
font-size:10px}svg .unit{font-style:italic}.axis{stroke:var(--soft)}.grid{stroke:var(--line)}
.dots{stroke:var(--mark);stroke-width:5;stroke-linecap:round;stroke-opacity:.55;fill:none}.box{fill:var(--box);
stroke:var(--mark)}.whisker{stroke:var(--mark)}.median{stroke:var(--mark);stroke-width:2.5}
.outlier{fill:var(--odd);stroke:var(--ground)}
.sheet{display:grid;grid-template-columns:repeat(auto-fill,minmax(164px,1fr));gap:12px}
.sheet div{background:var(--panel);border:1px solid var(--line);border-radius:8px;padding:8px;overflow-wrap:anywhere;
scroll-margin-top:16px}.sheet div:target{outline:3px solid var(--odd)}.sheet img,.sheet .none{width:100%;aspect-ratio:1;
display:block}.sheet .none{display:grid;place-items:center;color:var(--soft);font-size:13px;text-align:center}
.sheet small{color:var(--soft);display:block}.out img{opacity:.4}
.ok{color:var(--ok)}.warning{color:var(--warn)}.failed,.rated{color:var(--bad)}
details{margin:12px 0}summary{cursor:pointer}code{font-size:13px;overflow-wrap:anywhere}
.swatch{display:inline-block;width:140px;height:10px;border-radius:5px;vertical-align:middle;background:linear-gradient(90deg,
#440154,#482878,#3e4a89,#31688e,#26828e,#1f9e89,#35b779,#6dcd59,#b4de2c,#fde725)}
@media print{body{max-width:none}.sheet div,figure{break-inside:avoid}}
)";

std::string base64(const std::string& bytes) {
    std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');
    const int length =
        EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                        reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
    text.resize(static_cast<std::size_t>(length));
    return text;
}

std::string cell(const std::string& text) { return "<td>" + html_text(text) + "</td>"; }
std::string number_cell(const std::string& text) { return "<td class=\"n\">" + html_text(text) + "</td>"; }
std::string link(const Report& report, std::size_t model) {
    return "<a href=\"#" + model_anchor(model) + "\">" + html_text(report.models[model].id) + "</a>";
}

void write_head(const Report& report, std::ostream& out) {
    out << "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
           "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src "
           "'unsafe-inline'\">\n<meta name=\"viewport\" content=\"width=device-width\">\n<title>"
        << html_text(report.title) << "</title><style>" << kStyle << "</style></head><body>\n<h1>"
        << html_text(report.title)
        << "</h1>\n<nav><a href=\"#methods\">Methods</a><a href=\"#failures\">Failures and "
           "findings</a><a href=\"#measures\">Measures</a><a href=\"#outliers\">Outliers</a><a href=\"#models\">Models"
           "</a><a href=\"#ratings\">Ratings</a></nav>\n<div class=\"counts\">";
    for (const auto& [what, count] : report.counts)
        out << "<div><b>" << html_text(count) << "</b><span>" << html_text(what) << "</span></div>";
    out << "</div>\n";
}

void write_methods(const Report& report, std::ostream& out) {
    out << "<h2 id=\"methods\">Methods</h2>\n";
    for (const std::string& paragraph : report.methods) out << "<p>" << html_text(paragraph) << "</p>\n";
    out << "<ol class=\"soft\">";
    for (const std::string& reference : report.references) out << "<li>" << html_text(reference) << "</li>\n";
    out << "</ol>\n<details><summary>Options of all stages</summary><table>";
    for (const auto& [key, value] : report.options)
        out << "<tr><td><code>" << html_text(key) << "</code></td><td><code>" << html_text(value)
            << "</code></td></tr>\n";
    out << "</table></details>\n";
}

void write_failures(const Report& report, std::ostream& out) {
    out << "<h2 id=\"failures\">Failures and findings</h2>\n";
    std::string rows;
    for (std::size_t m = 0; m < report.models.size(); ++m)
        if (!report.models[m].sentence.empty())
            rows += "<tr><td>" + link(report, m) + "</td>" + cell(report.models[m].sentence) + "</tr>\n";
    if (rows.empty())
        out << "<p>No model failed.</p>\n";
    else
        out << "<table><tr><th>model</th><th>why it failed</th></tr>\n" << rows << "</table>\n";
    if (report.findings.empty()) return;
    out << "<table><tr><th>finding</th><th>severity</th><th class=\"n\">models</th></tr>\n";
    for (const ReportFinding& finding : report.findings)
        out << "<tr><td><code>" << html_text(finding.code) << "</code></td>" << cell(finding.severity)
            << number_cell(std::to_string(finding.models)) << "</tr>\n";
    out << "</table>\n";
}

void write_measures(const Report& report, std::ostream& out) {
    out << "<h2 id=\"measures\">Measures by " << html_text(report.by) << "</h2>\n<p>" << html_text(report.coverage)
        << " Boxes: quartiles and median; whiskers: the last values within 1.5 interquartile ranges. Orange: "
           "outliers.</p>\n"
           "<div class=\"spreads\">\n";
    for (const ReportMeasure& measure : report.measures) {
        out << "<figure><h3>" << html_text(measure.name) << "</h3><figcaption>" << html_text(measure.definition)
            << "</figcaption>" << spread_svg(measure, report) << "</figure>\n";
    }
    out << "</div>\n";
}

void write_outliers(const Report& report, std::ostream& out) {
    out << "<h2 id=\"outliers\">Outliers</h2>\n<p>Robust z = (x \xE2\x88\x92 median) / (1.4826 MAD) over all models "
           "that "
           "count; listed where |z| > "
        << html_number(report.outlier_limit) << " (Iglewicz and Hoaglin 1993), the largest first.</p>\n";
    if (report.outliers.empty()) {
        out << "<p>There are none.</p>\n";
        return;
    }
    out << "<table><tr><th>model</th><th>measure</th><th class=\"n\">value</th><th class=\"n\">median</th><th>unit</th>"
           "<th class=\"n\">z</th></tr>\n";
    for (std::size_t k = 0; k < std::min(report.outliers.size(), kMostOutliers); ++k) {
        const ReportOutlier& o = report.outliers[k];
        out << "<tr><td>" << link(report, o.model) << "</td>" << cell(o.measure) << number_cell(html_number(o.value))
            << number_cell(html_number(o.median)) << cell(o.unit == "1" ? "" : o.unit)
            << number_cell(fmt::format("{:+.1f}", o.z)) << "</tr>\n";
    }
    out << "</table>\n";
    if (report.outliers.size() > kMostOutliers)
        out << "<p>" << report.outliers.size() - kMostOutliers << " more are not listed.</p>\n";
}

void write_models(const Report& report, std::ostream& out) {
    out << "<h2 id=\"models\">Models</h2>\n<p class=\"soft\">Each wall along the least of its principal axes, coloured "
           "by its "
           "geodesic distance to the centerline, D<sub>g</sub>, from 0 <span class=\"swatch\"></span> to the value "
           "stated; "
           "centerlines in red.</p>\n<div class=\"sheet\">\n";
    const std::string side = std::to_string(report.picture_size);
    for (std::size_t m = 0; m < report.models.size(); ++m) {
        const ReportModel& model = report.models[m];
        out << "<div id=\"" << model_anchor(m) << "\"" << (model.left_out ? " class=\"out\"" : "") << ">";
        if (model.png.empty())
            out << "<span class=\"none\">no picture</span>";
        else
            out << "<img alt=\"\" loading=\"lazy\" width=\"" << side << "\" height=\"" << side
                << "\" src=\"data:image/png;base64," << base64(model.png) << "\">";
        out << "<b>" << html_text(model.id) << "</b> <span class=\"" << html_text(model.status) << "\">"
            << html_text(model.status) << "</span><small>" << html_text(model.group) << "</small><small>"
            << html_text(model.caption) << "</small>";
        if (!model.rating.empty())
            out << "<small" << (model.rating == "bad" ? " class=\"rated\"" : "") << ">rated " << html_text(model.rating)
                << (model.note.empty() ? "" : ": " + html_text(model.note)) << "</small>";
        out << "</div>\n";
    }
    out << "</div>\n";
}

void write_ratings(const Report& report, std::ostream& out) {
    out << "<h2 id=\"ratings\">Ratings</h2>\n<p><a download=\"ratings.tsv\" "
           "href=\"data:text/tab-separated-values;base64,"
        << base64(report.ratings)
        << "\">ratings.tsv</a>: one line a model, with tabs between model, rating and note. Write a rating where one "
           "is "
           "due; a model rated <code>bad</code> is left out and counted by the next <code>lumenline report --ratings "
           "ratings.tsv</code> and <code>lumenline stats --ratings ratings.tsv</code>.</p>\n";
}

}  // namespace

std::string html_text(std::string_view text) {
    std::string result;
    for (const char c : printable(valid_text(text))) switch (c) {
            case '<': result += "&lt;"; break;
            case '>': result += "&gt;"; break;
            case '&': result += "&amp;"; break;
            case '"': result += "&quot;"; break;
            case '\'': result += "&#39;"; break;
            default: result += c;
        }
    return result;
}

std::string model_anchor(std::size_t model) { return "m" + std::to_string(model); }

std::string html_number(double value) { return short_text(value); }

void write_report(const Report& report, std::ostream& out) {
    write_head(report, out);
    write_methods(report, out);
    write_failures(report, out);
    write_measures(report, out);
    write_outliers(report, out);
    write_models(report, out);
    write_ratings(report, out);
    out << "</body></html>\n";
}

}  // namespace lumenline
