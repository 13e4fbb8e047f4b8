// Datasets are contiguous, as all of ours: their lengths must be known before the first row. HDF5 gives a dataset its
// place at the first write, and writing some thousand rows at a time costs what writing them at once does.
#include "io/archive/table_stream.h"

#include <algorithm>
#include <utility>

#include "io/archive/errors.h"

namespace lumenline::hdf {

namespace {

constexpr std::size_t kBlock = 4096;  // rows

}  // namespace

TableStream::TableStream(Writer& writer, const std::string& group, const Table& table, std::size_t rows,
                         std::vector<std::size_t> widths)
    : writer_(writer), group_(group), buffer_(table), rows_(rows), widths_(std::move(widths)) {
    for (std::size_t c = 0; c < buffer_.columns.size(); ++c) {
        Column& column = buffer_.columns[c];
        column.numbers.clear();
        column.texts.clear();
        const std::string path = group + "/" + column.name;
        const names::Field field{path.c_str(), column.unit, column.definition.c_str()};
        if (column.kind == ColumnKind::kText)
            datasets_.push_back(writer.begin_strings(field, rows, std::max<std::size_t>(widths_[c], 1)));
        else
            datasets_.push_back(writer.begin_numbers(
                field, rows, column.kind == ColumnKind::kIndex ? Number::kInt32 : Number::kFloat64));
        if (column.source[0] != '\0') writer.attribute(path, "source", column.source);
    }
}

void TableStream::append(const Table& table) {
    for (std::size_t c = 0; c < buffer_.columns.size(); ++c) {
        Column& column = buffer_.columns[c];
        const Column& more = table.columns[c];
        column.numbers.insert(column.numbers.end(), more.numbers.begin(), more.numbers.end());
        column.texts.insert(column.texts.end(), more.texts.begin(), more.texts.end());
    }
    if (buffer_.rows() >= kBlock) flush();
}

void TableStream::flush() {
    const std::size_t rows = buffer_.rows();
    if (written_ + rows > rows_) throw Inconsistent(group_ + " gets more rows than were announced");
    for (std::size_t c = 0; c < buffer_.columns.size(); ++c) {
        Column& column = buffer_.columns[c];
        const std::string path = group_ + "/" + column.name;
        if (column.rows() != rows) throw Inconsistent(path + " is not as long as the other columns");
        if (column.kind == ColumnKind::kText)
            writer_.put(datasets_[c], path, written_, column.texts, std::max<std::size_t>(widths_[c], 1));
        else
            writer_.put(datasets_[c], path, written_, column.numbers);
        column.numbers.clear();
        column.texts.clear();
    }
    written_ += rows;
}

void TableStream::finish() {
    flush();
    datasets_.clear();  // a file is closed only after all that is open in it
    if (written_ != rows_)
        throw Inconsistent(group_ + " has " + std::to_string(written_) + " rows where " + std::to_string(rows_) +
                           " were announced");
}

}  // namespace lumenline::hdf
