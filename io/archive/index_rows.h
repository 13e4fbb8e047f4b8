#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/archive/index.h"
#include "io/archive/writer.h"

namespace lumenline::hdf {

/// Writes the rows of all models below /tables, with the model's id in front and their labels behind.
/// @returns a sentence for each file that cannot be read
std::vector<std::string> write_branch_tables(Writer& writer, const std::filesystem::path& archive_dir,
                                             std::span<const ModelSummary> models, const BranchLabeller& label);

/// Writes /dictionary: one row for each column that was written below /tables.
void write_dictionary(Writer& writer);

}  // namespace lumenline::hdf
