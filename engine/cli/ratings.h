#pragma once

#include <filesystem>

#include "engine/core/data_table.h"

namespace lumenline {

/// Adds the column `rating` of a table of ratings (columns `id` and `rating`, as `report` writes it) to a table by the
/// models' ids; models without a row stay unrated.
/// @throws ConfigError if the file is no such table
void add_ratings(const std::filesystem::path& ratings, DataTable& table);

}  // namespace lumenline
