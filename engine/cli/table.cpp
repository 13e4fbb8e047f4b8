// Columns are as wide as their widest cell, in code points: exact for the scripts that ids are
// written in, one off for wide and combining characters, which only shifts a column.

#include "engine/cli/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>

#include "engine/core/text.h"
#include "io/archive/utf8.h"

namespace lumenline {

namespace {

constexpr int kSignificantDigits = 4;

std::string common_unit(const std::vector<ModelSummary>& models) {
    if (models.empty()) return "";
    const std::string& unit = models.front().identity.length_unit;
    const bool shared = std::all_of(models.begin(), models.end(),
                                    [&](const ModelSummary& model) { return model.identity.length_unit == unit; });
    return shared && !unit.empty() && unit != "unknown" ? " [" + unit + "]" : "";
}

}  // namespace

void TextTable::add_column(std::string heading, Align align) {
    rows_.front().push_back(printable(heading));
    aligns_.push_back(align);
}

void TextTable::add_row(const std::vector<std::string>& cells) {
    std::vector<std::string>& row = rows_.emplace_back();
    for (const std::string& cell : cells) row.push_back(printable(cell));
}

void TextTable::print(std::ostream& out) const {
    std::vector<std::size_t> widths(aligns_.size(), 0);
    for (const auto& row : rows_)
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], code_points(row[c]));
    for (const auto& row : rows_) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c) {
            const std::string gap(widths[c] - code_points(row[c]), ' ');
            line += c == 0 ? "" : "  ";
            line += aligns_[c] == Align::kRight ? gap + row[c] : row[c] + gap;
        }
        line.erase(line.find_last_not_of(' ') + 1);
        out << line << '\n';
    }
}

std::string table_number(double value) {
    if (std::isnan(value)) return "-";
    const double size = std::fabs(value);
    if (size != 0 && !(size >= 1e-4 && size < 1e9)) return short_text(value, kSignificantDigits);
    const int before_point = size < 1 ? (size == 0 ? 1 : static_cast<int>(std::floor(std::log10(size))) + 1)
                                      : static_cast<int>(std::log10(size)) + 1;
    return fmt::format("{:.{}f}", value, std::max(0, kSignificantDigits - before_point));
}

bool is_printed_column(std::string_view name) {
    constexpr std::array kNames{"id", "status", "inlets", "outlets", "sites", "lines", "centerlines",
                                "length", "radius_min", "radius_mean", "radius_max", "seconds"};
    return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

void print_models(std::ostream& out, const std::vector<ModelSummary>& models, const std::vector<MoreColumn>& more) {
    using enum TextTable::Align;
    const std::string unit = common_unit(models);
    TextTable table;
    table.add_column("id", kLeft);
    table.add_column("status", kLeft);
    for (const char* heading : {"inlets", "outlets", "sites", "lines"}) table.add_column(heading, kRight);
    for (const char* heading : {"length", "radius_min", "radius_mean", "radius_max"})
        table.add_column(heading + unit, kRight);
    table.add_column("seconds", kRight);
    for (const MoreColumn& column : more) table.add_column(column.heading, column.is_number ? kRight : kLeft);
    std::size_t row = 0;
    for (const ModelSummary& m : models) {
        const auto count = [](std::size_t n) { return n == 0 ? std::string("-") : std::to_string(n); };
        const auto length = [&](double value) { return m.centerlines == 0 ? std::string("-") : table_number(value); };
        std::vector<std::string> cells{m.identity.id, std::string(status_name(m.status)), count(m.inlets), count(m.outlets),
                       count(m.sites), count(m.centerlines), length(m.length), length(m.radius_min),
                       length(m.radius_mean), length(m.radius_max), table_number(m.seconds)};
        for (const MoreColumn& column : more) cells.push_back(column.cells.at(row));
        table.add_row(cells);
        ++row;
    }
    table.print(out);
}

}  // namespace lumenline
