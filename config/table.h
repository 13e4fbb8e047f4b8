#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "config/values.h"

namespace lumenline {

/// A table of text: header and rows of equal length.
struct DelimitedTable {
    struct Row {
        std::size_t line = 0;  ///< in the file, 1-based
        std::vector<std::string> cells;
    };

    std::filesystem::path file;
    std::size_t header_line = 0;       ///< 1-based
    std::vector<std::string> columns;  ///< distinct, not empty
    std::vector<Row> rows;             ///< each with columns.size() cells
};

/// Reads a TSV (.tsv) or CSV (.csv) file with a header row.
///
/// A cell that starts with '"' ends at the next lone '"' ('""' inside stands for one) and does not span
/// lines; other cells lose the blanks at their ends. Lines that are entirely blank are passed over.
/// @param asked_by  where the table is named: the place of the error when it cannot be read
/// @throws ConfigError with the table's file and line
DelimitedTable read_table(const std::filesystem::path& file, const Place& asked_by);

}  // namespace lumenline
