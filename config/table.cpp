// Line by line: quoted cells may not span lines, so that one stray quote is an error in its own line
// instead of an appetite for the rest of the file. Quotes are read in TSV files too, because Excel
// writes them there around every cell that holds a comma, as points do.

#include "config/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "config/cohort.h"
#include "config/text_file.h"
#include "engine/core/text.h"

namespace lumenline {

namespace {

/// The quoted cell at the start of `rest`, which is cut up to the separator behind the closing quote.
std::string take_quoted(const Place& place, std::string_view& rest, char separator) {
    std::string cell;
    std::size_t i = 1;
    for (;; ++i) {
        if (i >= rest.size()) fail(place, "has a quote that is not closed on its line");
        if (rest[i] != '"') {
            cell += rest[i];
        } else if (i + 1 < rest.size() && rest[i + 1] == '"') {
            cell += rest[++i];
        } else {
            break;
        }
    }
    rest.remove_prefix(i + 1);
    const std::size_t end = std::min(rest.find(separator), rest.size());
    if (!std::ranges::all_of(rest.substr(0, end), [](char c) { return c == ' '; }))
        fail(place, fmt::format("goes on after its closing quote: {}", in_quotes(rest.substr(0, end))));
    rest.remove_prefix(end);
    return cell;
}

std::vector<std::string> split(const Place& line, std::string_view rest, char separator) {
    std::vector<std::string> cells;
    for (bool more = true; more;) {
        const std::size_t blanks = std::min(rest.find_first_not_of(' '), rest.size());
        if (blanks < rest.size() && rest[blanks] == '"') {
            rest.remove_prefix(blanks);
            const Place place{line.file, line.line, fmt::format("cell {}", cells.size() + 1)};
            cells.push_back(take_quoted(place, rest, separator));
        } else {
            const std::size_t end = std::min(rest.find(separator), rest.size());
            cells.emplace_back(trimmed(rest.substr(0, end)));
            rest.remove_prefix(end);
        }
        more = !rest.empty();
        if (more) rest.remove_prefix(1);
    }
    return cells;
}

void check_header(const DelimitedTable& table) {
    const std::size_t line = table.header_line;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const std::string& name = table.columns[i];
        if (name.empty()) throw ConfigError(table.file, line, fmt::format("column {} has no name", i + 1));
        for (std::size_t k = 0; k < i; ++k) {
            if (table.columns[k] == name)
                throw ConfigError(
                    table.file, line,
                    fmt::format("the column {} appears twice, as columns {} and {}", in_quotes(name), k + 1, i + 1));
        }
    }
}

}  // namespace

DelimitedTable read_table(const std::filesystem::path& file, const Place& asked_by) {
    const std::string extension = lower_case(file.extension().string());
    if (extension != ".tsv" && extension != ".csv")
        fail(asked_by, fmt::format("must name a .tsv or .csv file, not {}", path_in_quotes(file)));
    const char separator = extension == ".csv" ? ',' : '\t';
    const std::string text = read_text_file(file, asked_by).text;

    DelimitedTable table;
    table.file = file;
    std::string_view rest = text;
    for (std::size_t number = 1; !rest.empty(); ++number) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (line.find_first_not_of(' ') == std::string_view::npos) continue;
        std::vector<std::string> cells = split({file, number, "the line"}, line, separator);
        if (table.columns.empty()) {
            table.columns = std::move(cells);
            table.header_line = number;
            check_header(table);
            continue;
        }
        if (cells.size() != table.columns.size())
            throw ConfigError(file, number,
                              fmt::format("the row has {} where the header has {}; is a {} missing or too many?",
                                          counted(cells.size(), "cell"), counted(table.columns.size(), "column"),
                                          separator == ',' ? "comma" : "tab"));
        table.rows.push_back({number, std::move(cells)});
    }
    if (table.columns.empty()) throw ConfigError(file, 1, "the table is empty; it needs a header row");
    if (table.rows.empty()) throw ConfigError(file, table.header_line, "the table has a header but no rows");
    return table;
}

}  // namespace lumenline
