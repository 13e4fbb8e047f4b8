#include "io/export/tables.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "engine/core/text.h"
#include "io/archive/commit.h"
#include "io/archive/read.h"

namespace lumenline {

namespace {

constexpr std::string_view kTables = "/tables/";

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == text.npos) return text;
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
    return result + "\"";
}

void write_csv(const DataTable& table, std::ostream& out) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) out << (c > 0 ? "," : "") << quoted(table.columns[c].name);
    out << "\r\n";
    for (std::size_t row = 0; row < table.rows; ++row) {
        for (std::size_t c = 0; c < table.columns.size(); ++c) {
            const DataColumn& column = table.columns[c];
            out << (c > 0 ? "," : "");
            if (!column.is_number())
                out << quoted(column.texts()[row]);
            else if (!std::isnan(column.numbers()[row]))
                out << exact_text(column.numbers()[row]);
        }
        out << "\r\n";
    }
}

}  // namespace

std::vector<std::filesystem::path> export_tables(const std::filesystem::path& archive,
                                                 const std::filesystem::path& directory) {
    std::vector<std::string> tables;
    {
        const ArchiveFile index(index_or_file(archive));
        for (const ArchiveNode& node : index.nodes())
            if (node.is_group && node.path.starts_with(kTables)) tables.push_back(node.path.substr(kTables.size()));
    }
    std::vector<std::filesystem::path> written;
    nlohmann::ordered_json dictionary = nlohmann::ordered_json::array();
    for (const std::string& name : tables) {
        const DataTable table = read_data_table(archive, name);
        for (const DataColumn& c : table.columns)
            dictionary.push_back(
                {{"table", name}, {"column", c.name}, {"unit", c.units}, {"definition", c.description}});
        written.push_back(directory / (name + ".csv"));
        write_file(written.back(), [&](std::ostream& out) { write_csv(table, out); });
    }
    if (tables.empty()) throw UnknownName("'" + archive.string() + "' has no tables: it is no archive of a cohort");
    written.push_back(directory / "dictionary.json");
    write_file(written.back(), [&](std::ostream& out) {
        out << dictionary.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
    });
    return written;
}

}  // namespace lumenline
