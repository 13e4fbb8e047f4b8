#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "io/export/report.h"

namespace lumenline {

/// What `report` is asked for.
struct ReportOptions {
    std::string by = "group";           ///< column of the table of models
    std::vector<std::string> measures;  ///< columns; empty = all measures
    std::filesystem::path ratings;      ///< a table of ratings; empty = none
    std::size_t picture_size = 160;     ///< of a side in pixels
};

/// Gathers a report from an archive. A model whose file cannot be read has a sentence in the place of its picture, and
/// is counted.
/// @param progress  called with the models done and all of them
/// @throws ArchiveError, UnknownName where the index cannot be used; StudyError for a column that there is not;
///         ConfigError for the table of ratings
/// @cost   a read and a picture per model: about 50 ms each
Report gather_report(const std::filesystem::path& archive, const ReportOptions& options,
                     const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace lumenline
