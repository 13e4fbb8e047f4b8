#include "engine/cli/ratings.h"

#include <algorithm>
#include <map>
#include <optional>

#include "config/table.h"
#include "io/archive/utf8.h"

namespace lumenline {

namespace {

constexpr const char* kRating = "rating";
constexpr const char* kNote = "rating_note";

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
    std::map<std::string, const DelimitedTable::Row*> row_of;
    for (const DelimitedTable::Row& row : given.rows) row_of[row.cells[id]] = &row;
    const DataColumn* key = table.find("id");
    std::vector<std::string> values(table.rows), notes(table.rows);
    for (std::size_t i = 0; key != nullptr && !key->is_number() && i < table.rows; ++i)
        if (const auto found = row_of.find(key->texts()[i]); found != row_of.end()) {
            values[i] = found->second->cells[rating];
            if (note) notes[i] = found->second->cells[*note];
        }
    table.columns.push_back({kRating, "1", "of the model, by hand", false, std::move(values)});
    table.columns.push_back({kNote, "1", "to the rating, by hand", false, std::move(notes)});
}

std::string ratings_table(const DataTable& table) {
    const auto text = [&](const char* name, std::size_t row) {
        const DataColumn* column = table.find(name);
        return column == nullptr || column->is_number() ? std::string() : printable(column->texts()[row]);
    };
    std::string file = "model\trating\tnote\n";
    for (std::size_t row = 0; row < table.rows; ++row)
        file += text("id", row) + "\t" + text(kRating, row) + "\t" + text(kNote, row) + "\n";
    return file;
}

}  // namespace lumenline
