#include "engine/cli/ratings.h"

#include <algorithm>
#include <map>

#include "config/table.h"

namespace lumenline {

void add_ratings(const std::filesystem::path& ratings, DataTable& table) {
    const DelimitedTable given = read_table(ratings, {ratings, 0, "option --ratings"});
    const auto column = [&](const char* name) {
        const auto found = std::find(given.columns.begin(), given.columns.end(), name);
        if (found == given.columns.end())
            fail({given.file, given.header_line, std::string("column '") + name + "'"},
                 "is missing: a table of ratings has the columns id and rating");
        return static_cast<std::size_t>(found - given.columns.begin());
    };
    const std::size_t id = column("id"), rating = column("rating");
    std::map<std::string, std::string> rating_of;
    for (const DelimitedTable::Row& row : given.rows) rating_of[row.cells[id]] = row.cells[rating];
    const DataColumn* key = table.find("id");
    std::vector<std::string> values(table.rows);
    if (key != nullptr && !key->is_number())
        for (std::size_t i = 0; i < table.rows; ++i)
            if (const auto found = rating_of.find(key->texts()[i]); found != rating_of.end()) values[i] = found->second;
    table.columns.push_back({"rating", "1", "of the model, by hand", false, std::move(values)});
}

}  // namespace lumenline
