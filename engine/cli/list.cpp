// Columns are looked up in the table as the index has it, plus two that people see printed: `seconds`, which stands
// elsewhere in the index, and `lines`, the printed name of `centerlines`.

#include "engine/cli/list.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <ostream>

#include "engine/cli/table.h"
#include "engine/population/rows.h"
#include "io/archive/read.h"
#include "io/export/tables.h"

namespace lumenline {

namespace {

constexpr const char* kTableOfModels = "models";

/// Stable, with models without a value last in either direction.
void sort_rows(const DataColumn& column, bool descending, std::vector<std::size_t>& rows) {
    const auto less = [&](std::size_t a, std::size_t b) {
        return column.is_number() ? column.numbers()[a] < column.numbers()[b]
                                  : natural_less(column.texts()[a], column.texts()[b]);
    };
    const auto values_end =
        std::stable_partition(rows.begin(), rows.end(), [&](std::size_t row) { return !is_missing(column, row); });
    std::stable_sort(rows.begin(), values_end,
                     [&](std::size_t a, std::size_t b) { return descending ? less(b, a) : less(a, b); });
}

void print_json(const DataTable& table, const std::vector<std::size_t>& rows, std::ostream& out) {
    nlohmann::ordered_json document = nlohmann::ordered_json::array();
    for (const std::size_t row : rows) {
        nlohmann::ordered_json& object = document.emplace_back(nlohmann::ordered_json::object());
        for (const DataColumn& column : table.columns) {
            nlohmann::ordered_json& value = object[column.name];  // null where a number is not finite
            if (!column.is_number())
                value = column.texts()[row];
            else if (column.is_whole && std::isfinite(column.numbers()[row]))
                value = static_cast<std::int64_t>(column.numbers()[row]);
            else
                value = column.numbers()[row];
        }
    }
    out << document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
}

/// The columns that conditions and order name and the printed table has not.
std::vector<const DataColumn*> named_columns(const DataTable& table, const ListOptions& options) {
    std::vector<std::string> names = condition_columns(table, options.where);
    if (!options.sort.empty()) names.push_back(options.sort);
    std::vector<const DataColumn*> columns;
    for (const std::string& name : names) {
        const DataColumn* column = &column_of(table, name);
        if (!is_printed_column(name) && std::find(columns.begin(), columns.end(), column) == columns.end())
            columns.push_back(column);
    }
    return columns;
}

}  // namespace

void print_list(const std::filesystem::path& archive, const ListOptions& options, std::ostream& out) {
    if (options.sort.empty() && options.where.empty() && !options.json && !options.csv)
        return print_models(out, list_models(archive));
    DataTable table = read_data_table(archive, kTableOfModels);
    const std::vector<ModelSummary> models = list_models(archive);
    std::vector<double> seconds;
    for (const ModelSummary& model : models) seconds.push_back(model.seconds);
    table.columns.push_back({"seconds", "s", "time of work on the model, without waiting", false, std::move(seconds)});
    DataTable known = table;
    if (const DataColumn* lines = table.find("centerlines"); lines != nullptr) {
        known.columns.push_back(*lines);
        known.columns.back().name = "lines";
    }
    std::vector<std::size_t> rows = rows_where(known, options.where);
    if (!options.sort.empty()) sort_rows(column_of(known, options.sort), options.descending, rows);
    if (options.json) return print_json(table, rows, out);
    if (options.csv) return write_rows(table, rows, TableFormat::kCsv, out);
    std::vector<ModelSummary> shown;
    for (const std::size_t row : rows) shown.push_back(models.at(row));
    std::vector<MoreColumn> more;
    for (const DataColumn* column : named_columns(known, options)) {
        MoreColumn& shown_column = more.emplace_back(MoreColumn{column->name, column->is_number(), {}});
        for (const std::size_t row : rows)
            shown_column.cells.push_back(!column->is_number() || column->is_whole
                                             ? cell_text(*column, row)
                                             : table_number(column->numbers()[row]));
    }
    print_models(out, shown, more);
}

}  // namespace lumenline
