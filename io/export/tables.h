#pragma once

#include <filesystem>
#include <vector>

#include "io/archive/errors.h"

namespace lumenline {

/// Writes every table of an archive's index as `<table>.csv` (RFC 4180: commas, quotes doubled, a heading; numbers as
/// decimals that read back as the same, empty where there is none), and `dictionary.json`: table, column, unit and
/// definition of each column.
/// @returns the files written
/// @throws ArchiveError, UnknownName as read_data_table; std::system_error
std::vector<std::filesystem::path> export_tables(const std::filesystem::path& archive,
                                                 const std::filesystem::path& directory);

}  // namespace lumenline
