#include "engine/cli/ratings.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "config/table.h"
#include "engine/core/text.h"
#include "io/archive/utf8.h"
#include "io/export/tables.h"

namespace lumenline {

namespace {

constexpr const char* kRating = "rating";
constexpr const char* kNote = "rating_note";
constexpr std::string_view kBad = "bad";

using Rows = std::map<std::string, const DelimitedTable::Row*>;

/// Rows by the models' ids, each of which has one.
/// @throws ConfigError also for what is meant as `bad` and would count as good
Rows rows_by_model(const DelimitedTable& given, std::size_t id, std::size_t rating) {
    Rows rows;
    for (const DelimitedTable::Row& row : given.rows) {
        const std::string& word = row.cells[rating];
        if (word != kBad && lower_case(trimmed(word)) == kBad)
            fail({given.file, row.line, "column 'rating'"}, "holds " + in_quotes(word) + ": write 'bad'");
        const auto [first, is_new] = rows.try_emplace(row.cells[id], &row);
        if (!is_new)
            fail({given.file, row.line, "model " + in_quotes(row.cells[id])},
                 "has a rating in line " + std::to_string(first->second->line) + " already: leave one of them");
    }
    return rows;
}

/// Says how many ratings are of models that the table has not: they change nothing.
void say_unknown(const DelimitedTable& given, std::size_t id, const DataColumn* models) {
    std::set<std::string> known;
    if (models != nullptr && !models->is_number()) known.insert(models->texts().begin(), models->texts().end());
    const auto is_unknown = [&](const DelimitedTable::Row& row) { return !known.contains(row.cells[id]); };
    const auto first = std::find_if(given.rows.begin(), given.rows.end(), is_unknown);
    if (first == given.rows.end()) return;
    const auto all = static_cast<std::size_t>(std::count_if(first, given.rows.end(), is_unknown));
    fmt::print(stderr, "lumenline: {} in {} {} of no model of the archive and not used, the first of {} in line {}\n",
               counted(all, "rating"), path_in_quotes(given.file), all == 1 ? "is" : "are", in_quotes(first->cells[id]),
               first->line);
}

/// Adds a column of text, in the place of one that has its name.
void set_column(DataTable& table, DataColumn column) {
    const auto own = std::find_if(table.columns.begin(), table.columns.end(),
                                  [&](const DataColumn& c) { return c.name == column.name; });
    if (own == table.columns.end())
        table.columns.push_back(std::move(column));
    else
        *own = std::move(column);
}

}  // namespace

void add_ratings(const std::filesystem::path& ratings, DataTable& table) {
    const DelimitedTable given = read_table(ratings, {ratings, 0, "option --ratings"});
    const auto column = [&](const char* name) -> std::optional<std::size_t> {
        const auto found = std::find(given.columns.begin(), given.columns.end(), name);
        if (found == given.columns.end()) return std::nullopt;
        return static_cast<std::size_t>(found - given.columns.begin());
    };
    const auto needed = [&](std::optional<std::size_t> found, const char* name) {
        if (!found)
            fail({given.file, given.header_line, std::string("column '") + name + "'"},
                 "is missing: a table of ratings has the columns model, rating and note");
        return *found;
    };
    const std::size_t id = needed(column("model") ? column("model") : column("id"), "model");
    const std::size_t rating = needed(column("rating"), "rating");
    const std::optional<std::size_t> note = column("note");
    const Rows row_of = rows_by_model(given, id, rating);
    const DataColumn* key = table.find("id");
    say_unknown(given, id, key);
    std::vector<std::string> values(table.rows), notes(table.rows);
    for (std::size_t i = 0; key != nullptr && !key->is_number() && i < table.rows; ++i)
        if (const auto found = row_of.find(key->texts()[i]); found != row_of.end()) {
            values[i] = found->second->cells[rating];
            if (note) notes[i] = found->second->cells[*note];
        }
    set_column(table, {kRating, "1", "of the model, by hand", false, std::move(values)});
    set_column(table, {kNote, "1", "to the rating, by hand", false, std::move(notes)});
}

std::string ratings_table(const DataTable& table) {
    const auto text = [&](const char* name, std::size_t row) {
        const DataColumn* column = table.find(name);
        return column == nullptr || column->is_number()
                   ? std::string()
                   : quoted_cell(printable(column->texts()[row]), TableFormat::kTsv);
    };
    std::string file = "model\trating\tnote\n";
    for (std::size_t row = 0; row < table.rows; ++row)
        file += text("id", row) + "\t" + text(kRating, row) + "\t" + text(kNote, row) + "\n";
    return file;
}

}  // namespace lumenline
