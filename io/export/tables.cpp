#include "io/export/tables.h"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <ostream>
#include <string>
#include <vector>

#include "engine/core/text.h"
#include "io/archive/commit.h"
#include "io/archive/read.h"

namespace lumenline {

namespace {

constexpr std::string_view kTables = "/tables/";

/// How a format writes its cells.
struct Style {
    const char *separator, *line_end, *missing;
    const char* to_quote;  ///< characters that put a cell into quotes
};

const Style& style_of(TableFormat format) {
    static constexpr Style kCsv{",", "\r\n", "", ",\"\r\n"};
    static constexpr Style kTsv{"\t", "\n", "n/a", "\t\"\r\n"};
    return format == TableFormat::kCsv ? kCsv : kTsv;
}

std::string quoted(const std::string& text, const Style& style) {
    if (text.find_first_of(style.to_quote) == text.npos) return text;
    std::string result = "\"";
    for (const char c : text) result.append(c == '"' ? 2 : 1, c);
    return result + "\"";
}

}  // namespace

std::string quoted_cell(const std::string& text, TableFormat format) { return quoted(text, style_of(format)); }

void write_rows(const DataTable& table, std::span<const std::size_t> rows, TableFormat format, std::ostream& out) {
    const Style style = style_of(format);
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        out << (c > 0 ? style.separator : "") << quoted(table.columns[c].name, style);
    out << style.line_end;
    for (const std::size_t row : rows) {
        for (std::size_t c = 0; c < table.columns.size(); ++c) {
            const DataColumn& column = table.columns[c];
            out << (c > 0 ? style.separator : "");
            if (!column.is_number())
                out << (is_missing(column.texts()[row]) ? style.missing : quoted(column.texts()[row], style));
            else if (std::isnan(column.numbers()[row]))
                out << style.missing;
            else
                out << exact_text(column.numbers()[row]);
        }
        out << style.line_end;
    }
}

namespace {

/// What the index says of the columns below /tables: type and source by path.
class ColumnFacts {
public:
    explicit ColumnFacts(const std::filesystem::path& archive) : index_(index_or_file(archive)) {
        for (const ArchiveNode& node : index_.nodes()) {
            if (!node.path.starts_with(kTables)) continue;
            if (node.is_group)
                tables_.push_back(node.path.substr(kTables.size()));
            else
                types_.emplace(node.path, node.type);
        }
    }

    [[nodiscard]] const std::vector<std::string>& tables() const { return tables_; }

    /// A column that a table lacks is joined from that of the models.
    [[nodiscard]] nlohmann::ordered_json entry(const std::string& table, const DataColumn& c) const {
        std::string path = std::string(kTables) + table + "/" + c.name;
        if (!types_.contains(path)) path = std::string(kTables) + "models/" + c.name;
        const auto type = types_.find(path);
        return {{"table", table},
                {"column", c.name},
                {"type", type == types_.end() ? "" : type->second},
                {"unit", c.units},
                {"definition", c.description},
                {"source", type == types_.end() ? "" : index_.attribute(path, "source").value_or("")}};
    }

private:
    ArchiveFile index_;
    std::vector<std::string> tables_;
    std::map<std::string, std::string> types_;
};

}  // namespace

std::vector<std::filesystem::path> export_tables(const std::filesystem::path& archive,
                                                 const std::filesystem::path& directory, TableFormat format) {
    const ColumnFacts facts(archive);
    if (facts.tables().empty())
        throw UnknownName("'" + archive.string() + "' has no tables: it is no archive of a cohort");
    std::vector<std::filesystem::path> written;
    nlohmann::ordered_json dictionary = nlohmann::ordered_json::array();
    for (const std::string& name : facts.tables()) {
        const DataTable table = read_data_table(archive, name);
        for (const DataColumn& c : table.columns) dictionary.push_back(facts.entry(name, c));
        written.push_back(directory / (name + (format == TableFormat::kCsv ? ".csv" : ".tsv")));
        std::vector<std::size_t> rows(table.rows);
        std::iota(rows.begin(), rows.end(), std::size_t{0});
        write_file(written.back(), [&](std::ostream& out) { write_rows(table, rows, format, out); });
    }
    written.push_back(directory / "dictionary.json");
    write_file(written.back(), [&](std::ostream& out) {
        out << dictionary.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
    });
    return written;
}

}  // namespace lumenline
