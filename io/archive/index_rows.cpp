// Two passes over the model files. The first learns how many rows there will be, and the trees, which are small, so
// that all models can be labelled before any row is written: labels may depend on another model. The second carries the
// rows over. What memory holds beside is a block of rows.
#include "io/archive/index_rows.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <system_error>

#include "engine/core/index_tables.h"
#include "io/archive/index_names.h"
#include "io/archive/model_file.h"
#include "io/archive/model_tables.h"
#include "io/archive/read.h"
#include "io/archive/table_stream.h"
#include "io/archive/utf8.h"

namespace lumenline::hdf {

namespace {

constexpr const char* kTables = "/tables/";

/// Bytes of the longest text of each column that text may stand in.
struct Widths {
    std::size_t id = 0, kind = 0, role = 0, label = 0;

    std::size_t& of(const Column& column) {
        return column.name == "id" ? id : column.name == "kind" ? kind : column.name == "role" ? role : label;
    }
};

void widen(std::size_t& width, const std::string& text) { width = std::max(width, valid_text(text).size()); }

class IndexRows {
public:
    IndexRows(const std::filesystem::path& archive_dir, std::span<const ModelSummary> models)
        : archive_dir_(archive_dir), models_(models), trees_(models.size()), rows_(models.size()) {}

    std::vector<std::string> write(Writer& writer, const BranchLabeller& label) {
        look();
        if (label) labels_ = label(trees_);
        labels_.resize(models_.size());
        for (std::size_t m = 0; m < models_.size(); ++m)
            for (const std::string& text : labels_[m].label) widen(widths_.label, text);
        std::vector<TableStream> streams;
        std::vector<Table> tables = index_tables(Branches(), Endpoints());
        for (std::size_t t = 0; t < tables.size(); ++t) {
            add_id(tables[t], "");
            std::vector<std::size_t> widths;
            for (const Column& column : tables[t].columns)
                widths.push_back(column.kind == ColumnKind::kText ? widths_.of(column) : 0);
            streams.emplace_back(writer, kTables + std::string(tables[t].name), tables[t], count_[t], widths);
        }
        for (std::size_t m = 0; m < models_.size(); ++m) carry_over(m, streams);
        for (TableStream& stream : streams) stream.finish();
        return std::move(unread_);
    }

private:
    void look() {
        count_.resize(index_tables(Branches(), Endpoints()).size(), 0);
        for (std::size_t m = 0; m < models_.size(); ++m) {
            const std::filesystem::path file = path(m);
            const std::optional<Failure>& failure = models_[m].failure;
            std::error_code error;
            // What a model left that could not be written is of an earlier run.
            if ((failure && failure->stage == Stage::kArchive) || !std::filesystem::exists(file, error)) continue;
            try {
                look_at(read_index_tables(ArchiveFile(file)), m);
            } catch (const ArchiveError& damage) {
                unread_.emplace_back(damage.what());
            }
        }
    }

    void look_at(const std::vector<Table>& tables, std::size_t m) {
        if (std::all_of(tables.begin(), tables.end(), [](const Table& t) { return t.rows() == 0; })) return;
        for (std::size_t t = 0; t < tables.size(); ++t) {
            rows_[m].push_back(tables[t].rows());
            count_[t] += tables[t].rows();
            for (const Column& column : tables[t].columns)
                if (column.kind == ColumnKind::kText)
                    for (const std::string& text : column.texts) widen(widths_.of(column), text);
        }
        widen(widths_.id, models_[m].identity.id);
        trees_[m] = branch_tree(tables.front());
    }

    void carry_over(std::size_t m, std::vector<TableStream>& streams) {
        if (rows_[m].empty()) return;
        std::vector<Table> tables;
        try {
            tables = read_index_tables(ArchiveFile(path(m)));
            for (std::size_t t = 0; t < tables.size(); ++t)
                if (tables[t].rows() != rows_[m][t])
                    throw ArchiveError("cannot use '" + path(m).string() +
                                       "': it was replaced while the index was made; run 'lumenline merge'");
        } catch (const ArchiveError& damage) {
            unread_.emplace_back(damage.what());
            tables = missing_rows(rows_[m]);  // room was made for them
        }
        set_labels(labels_[m], tables);
        for (std::size_t t = 0; t < tables.size(); ++t) {
            add_id(tables[t], models_[m].identity.id);
            streams[t].append(tables[t]);
        }
    }

    /// As many rows as announced, of missing values.
    static std::vector<Table> missing_rows(const std::vector<std::size_t>& rows) {
        std::vector<Table> tables = index_tables(Branches(), Endpoints());
        for (std::size_t t = 0; t < tables.size(); ++t)
            for (Column& column : tables[t].columns) {
                if (column.kind == ColumnKind::kText)
                    column.texts.resize(rows[t]);
                else
                    column.numbers.resize(
                        rows[t], column.kind == ColumnKind::kIndex ? -1 : std::numeric_limits<double>::quiet_NaN());
            }
        return tables;
    }

    [[nodiscard]] std::filesystem::path path(std::size_t m) const {
        return model_path(archive_dir_, models_[m].identity.id);
    }

    static void add_id(Table& table, const std::string& id) {
        const std::size_t rows = table.rows();
        table.columns.insert(
            table.columns.begin(),
            {"id", "1", "name of the model", "", ColumnKind::kText, {}, std::vector<std::string>(rows, id)});
    }

    const std::filesystem::path& archive_dir_;
    std::span<const ModelSummary> models_;
    std::vector<BranchTree> trees_;
    std::vector<BranchLabels> labels_;
    std::vector<std::vector<std::size_t>> rows_;  // per model and table; none where there are none
    std::vector<std::size_t> count_;
    Widths widths_;
    std::vector<std::string> unread_;
};

}  // namespace

std::vector<std::string> write_branch_tables(Writer& writer, const std::filesystem::path& archive_dir,
                                             std::span<const ModelSummary> models, const BranchLabeller& label) {
    return IndexRows(archive_dir, models).write(writer, label);
}

void write_dictionary(Writer& writer) {
    std::map<std::string, std::string> source_of;
    for (const Table& table : index_tables(Branches(), Endpoints()))
        for (const Column& column : table.columns)
            source_of[kTables + std::string(table.name) + "/" + column.name] = column.source;
    std::vector<std::string> tables, columns, types, units, definitions, sources;
    const std::string prefix = kTables;
    for (const Writer::Described& d : writer.described()) {
        if (!d.path.starts_with(prefix)) continue;
        const std::size_t slash = d.path.find('/', prefix.size());
        tables.push_back(d.path.substr(prefix.size(), slash - prefix.size()));
        columns.push_back(d.path.substr(slash + 1));
        types.push_back(d.type);
        units.push_back(d.units);
        definitions.push_back(d.description);
        const auto source = source_of.find(d.path);
        sources.push_back(source == source_of.end() ? "" : source->second);
    }
    writer.strings(names::kDictionaryTable, tables);
    writer.strings(names::kDictionaryColumn, columns);
    writer.strings(names::kDictionaryType, types);
    writer.strings(names::kDictionaryUnit, units);
    writer.strings(names::kDictionaryDefinition, definitions);
    writer.strings(names::kDictionarySource, sources);
}

}  // namespace lumenline::hdf
