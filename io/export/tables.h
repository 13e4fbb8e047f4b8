#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "engine/core/data_table.h"
#include "io/archive/errors.h"

namespace lumenline {

/// RFC 4180 (.csv: commas, missing values empty), or as BIDS has it (.tsv: tabs, missing values n/a).
enum class TableFormat { kCsv, kTsv };

/// Text as a cell of a file, in quotes where it needs them to be read back.
std::string quoted_cell(const std::string& text, TableFormat format);

/// Writes rows of a table: a heading, quotes doubled, numbers as decimals that read back as the same.
void write_rows(const DataTable& table, std::span<const std::size_t> rows, TableFormat format, std::ostream& out);

/// Writes every table of an archive's index as `<table>.csv` or `<table>.tsv`, and `dictionary.json`: table, column, type,
/// unit, definition and source of each column, as /dictionary of the index has them.
/// @returns the files written
/// @throws ArchiveError, UnknownName as read_data_table; std::system_error
std::vector<std::filesystem::path> export_tables(const std::filesystem::path& archive,
                                                 const std::filesystem::path& directory, TableFormat format);

}  // namespace lumenline
