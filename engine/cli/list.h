#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace lumenline {

/// What `browse list` is asked for.
struct ListOptions {
    std::string sort;                ///< column; empty = order of the configuration
    bool descending = false;         ///< largest first
    std::vector<std::string> where;  ///< conditions, see `rows_where`
    bool json = false, csv = false;  ///< every column; else a table for people
};

/// Prints the models of an archive, sorted and selected by the columns of its table of models and by `seconds`. The
/// table for people shows the columns that were asked for beside its own.
/// @throws ArchiveError, UnknownName; StudyError for a column or condition that the table cannot meet
/// @cost  half a second for every column of 10,000 models
void print_list(const std::filesystem::path& archive, const ListOptions& options, std::ostream& out);

}  // namespace lumenline
