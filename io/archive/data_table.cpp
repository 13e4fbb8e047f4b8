// Tables are taken as they stand in the index: one dataset per column, of any name. A column that is as long as no
// other, or of more than one dimension, is refused: rows would not belong together.

#include <algorithm>
#include <limits>
#include <map>

#include "io/archive/index_names.h"
#include "io/archive/read.h"

namespace lumenline {

namespace {

constexpr std::string_view kTables = "/tables/";
constexpr std::string_view kModelKey = "id";

DataColumn read_column(const ArchiveFile& file, const ArchiveNode& node, std::string name) {
    DataColumn column{std::move(name), node.units, node.description, false, {}};
    if (node.type == "string") {
        column.values = file.strings(node.path);
        return column;
    }
    column.values = file.numbers(node.path);
    column.is_whole = node.type.starts_with("int") || node.type.starts_with("uint");
    column.is_measure = node.type.starts_with("float") && node.description != names::kCovariateDescription;
    return column;
}

DataTable read_own(const ArchiveFile& file, const std::string& name) {
    DataTable table{name, 0, {}};
    std::vector<std::string> tables;
    const std::string prefix = std::string(kTables) + name + "/";
    for (const ArchiveNode& node : file.nodes()) {
        if (node.is_group && node.path.starts_with(kTables)) tables.push_back(node.path.substr(kTables.size()));
        if (node.is_group || !node.path.starts_with(prefix)) continue;
        if (node.shape.size() != 1 || (!table.columns.empty() && node.shape[0] != table.rows))
            throw ArchiveError("cannot use '" + file.file().string() + "': " + node.path + " has the shape " +
                               shape_text(node.shape) + ", other columns of its table are of another length");
        table.rows = node.shape[0];
        table.columns.push_back(read_column(file, node, node.path.substr(prefix.size())));
    }
    if (table.columns.empty())
        throw UnknownName("the index '" + file.file().string() + "' has no table '" + name + "'" +
                          nearest_names(name, tables));
    return table;
}

/// Values of `column` at `rows`; none where a row is past its end.
DataColumn at_rows(const DataColumn& column, const std::vector<std::size_t>& rows) {
    DataColumn result{column.name, column.units, column.description, false, {}, column.is_whole};
    if (column.is_number()) {
        std::vector<double> values;
        for (const std::size_t r : rows)
            values.push_back(r < column.numbers().size() ? column.numbers()[r]
                                                         : std::numeric_limits<double>::quiet_NaN());
        result.values = std::move(values);
    } else {
        std::vector<std::string> values;
        for (const std::size_t r : rows) values.push_back(r < column.texts().size() ? column.texts()[r] : "");
        result.values = std::move(values);
    }
    return result;
}

}  // namespace

DataTable read_data_table(const std::filesystem::path& archive, const std::string& table) {
    const ArchiveFile file(index_or_file(archive));
    if (file.format() != names::kCohortFormat)
        throw UnknownName("'" + archive.string() + "' is one model: tables stand in the index of a cohort");
    DataTable own = read_own(file, table);
    const std::string all = std::string(names::kModelTable).substr(kTables.size());
    const DataColumn* key = own.find(kModelKey);
    if (table == all || key == nullptr || key->is_number()) return own;
    const DataTable models = read_own(file, all);
    const DataColumn* ids = models.find(kModelKey);
    if (ids == nullptr || ids->is_number()) return own;
    std::map<std::string, std::size_t> row_of;
    for (std::size_t i = 0; i < models.rows; ++i) row_of.emplace(ids->texts()[i], i);
    std::vector<std::size_t> rows;
    for (const std::string& id : key->texts()) {
        const auto row = row_of.find(id);
        rows.push_back(row != row_of.end() ? row->second : models.rows);
    }
    for (const DataColumn& column : models.columns)
        if (own.find(column.name) == nullptr) own.columns.push_back(at_rows(column, rows));
    return own;
}

}  // namespace lumenline
