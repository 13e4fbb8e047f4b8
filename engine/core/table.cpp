#include "engine/core/table.h"

#include <cassert>
#include <cstddef>

namespace lumenline {

TableRows rows_of(const Table& table) {
    TableRows rows;
    rows.rows = table.rows();
    for (const Column& column : table.columns) {
        assert(column.rows() == rows.rows);
        rows.numbers.insert(rows.numbers.end(), column.numbers.begin(), column.numbers.end());
        rows.texts.insert(rows.texts.end(), column.texts.begin(), column.texts.end());
    }
    return rows;
}

void append_rows(const TableRows& rows, Table& table) {
    const auto count = static_cast<std::ptrdiff_t>(rows.rows);
    auto number = rows.numbers.begin();
    auto text = rows.texts.begin();
    for (Column& column : table.columns) {
        if (column.kind == ColumnKind::kText) {
            column.texts.insert(column.texts.end(), text, text + count);
            text += count;
        } else {
            column.numbers.insert(column.numbers.end(), number, number + count);
            number += count;
        }
    }
}

}  // namespace lumenline
