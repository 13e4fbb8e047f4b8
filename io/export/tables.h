#pragma once

#include <filesystem>
#include <vector>

#include "io/archive/errors.h"

namespace lumenline {

/// RFC 4180 (.csv: commas, missing values empty), or as BIDS has it (.tsv: tabs, missing values n/a).
enum class TableFormat { kCsv, kTsv };

/// Writes every table of an archive's index as `<table>.csv` or `<table>.tsv` (a heading; quotes doubled; numbers as
/// decimals that read back as the same), and `dictionary.json`: table, column, type, unit, definition and source of each
/// column, as /dictionary of the index has them.
/// @returns the files written
/// @throws ArchiveError, UnknownName as read_data_table; std::system_error
std::vector<std::filesystem::path> export_tables(const std::filesystem::path& archive,
                                                 const std::filesystem::path& directory, TableFormat format);

}  // namespace lumenline
