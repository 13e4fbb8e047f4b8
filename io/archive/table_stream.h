#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/core/table.h"
#include "io/archive/writer.h"

namespace lumenline::hdf {

/// Writes a table bit by bit, so that memory does not grow with its rows: the datasets are those of write_table, and
/// hold the same.
class TableStream {
public:
    /// @param table   the columns; its rows are not written
    /// @param rows    that will come in all
    /// @param widths  of text, per column: bytes of the longest as valid UTF-8; 0 for numbers
    TableStream(Writer& writer, const std::string& group, const Table& table, std::size_t rows,
                std::vector<std::size_t> widths);

    /// @param table  of the same columns
    void append(const Table& table);
    /// Writes what is left and closes the datasets. @throws Inconsistent where other than the rows announced came
    void finish();

private:
    void flush();

    Writer& writer_;
    std::string group_;
    Table buffer_;
    std::size_t rows_, written_ = 0;
    std::vector<std::size_t> widths_;
    std::vector<Handle> datasets_;
};

}  // namespace lumenline::hdf
