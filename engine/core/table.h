#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lumenline {

/// Kind of a column's values.
enum class ColumnKind : std::uint8_t {
    kNumber,  ///< NaN = could not be computed
    kIndex,   ///< whole numbers; -1 = none
    kText,
};

/// A column of a table, with what a data dictionary says of it.
struct Column {
    std::string name;
    const char* unit;  ///< "length", "length^2", ... stand for the model's unit; "1" = none
    std::string definition;
    const char* source;  ///< publication that the definition follows; "" = ours, or plain
    ColumnKind kind = ColumnKind::kNumber;
    std::vector<double> numbers;     ///< one per row; of kIndex whole
    std::vector<std::string> texts;  ///< one per row, of kText

    [[nodiscard]] std::size_t rows() const { return kind == ColumnKind::kText ? texts.size() : numbers.size(); }
};

/// Rows of numbers and texts of one model, under a name that the archive uses as a group.
struct Table {
    const char* name;
    std::vector<Column> columns;

    [[nodiscard]] std::size_t rows() const { return columns.empty() ? 0 : columns.front().rows(); }
};

}  // namespace lumenline
