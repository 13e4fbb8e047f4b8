#pragma once

#include <filesystem>
#include <string>

#include "engine/core/data_table.h"

namespace lumenline {

/// Adds the columns `rating` and `rating_note` of a table of ratings (columns `model`, or `id`, `rating` and perhaps
/// `note`) to a table by the models' ids, in the place of covariates of these names; models without a row stay unrated,
/// and ratings of other models are counted on standard error.
/// @throws ConfigError if the file is no such table, rates a model twice, or writes `bad` in another way
void add_ratings(const std::filesystem::path& ratings, DataTable& table);

/// A table of ratings to be filled in, as a TSV file: model, rating, note, one row per row of the table of models, with
/// what it has from `add_ratings`.
std::string ratings_table(const DataTable& table);

}  // namespace lumenline
