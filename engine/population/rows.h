#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/data_table.h"
#include "engine/population/study.h"

namespace lumenline {

/// Has a table's cell no value: NaN, no text, or "n/a"?
bool is_missing(const DataColumn& column, std::size_t row);

/// Text of a table's cell: numbers as they are written elsewhere, what is missing as empty.
std::string cell_text(const DataColumn& column, std::size_t row);

/// The column of that name. @throws StudyError with the nearest names
const DataColumn& column_of(const DataTable& table, std::string_view name);
/// The same, of numbers.
const DataColumn& numbers_of(const DataTable& table, std::string_view name);

/// Rows that take part: of models that did not fail, are not rated bad and meet the conditions.
/// @param coverage  counts the rest, by reason
std::vector<std::size_t> select_rows(const DataTable& table, const StudyOptions& options, Coverage& coverage);

/// Rows that meet all conditions, whatever became of their models.
///
/// A condition is "COLUMN OP VALUE", OP one of = != < <= > >=. What is missing meets none but "COLUMN =", and all else
/// meets "COLUMN !=". Text is compared as it stands, but ordered as the numbers that it says.
/// @throws StudyError for what is no condition, and where there is no number to compare with
std::vector<std::size_t> rows_where(const DataTable& table, const std::vector<std::string>& conditions);

/// The columns that conditions name. @throws StudyError
std::vector<std::string> condition_columns(const DataTable& table, const std::vector<std::string>& conditions);

/// Counts `rows` for a reason; reasons keep the order in which they first came.
void leave_out(Coverage& coverage, const std::string& reason, std::size_t rows = 1);

/// Orders names as people do: numbers in them by value ("visit2" before "visit10").
bool natural_less(std::string_view a, std::string_view b);

}  // namespace lumenline
