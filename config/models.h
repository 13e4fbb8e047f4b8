#pragma once

#include <filesystem>
#include <vector>

#include "config/reader.h"
#include "engine/core/options.h"

namespace lumenline {

/// The models of a cohort: list, table or glob.
///
/// @param top        the document's top level
/// @param prototype  what all models share: options, length unit, coordinate system
/// @param folder     that relative paths are relative to
/// @returns          at least one task; ids unique without regard to case; every task with the same covariates
/// @throws ConfigError
std::vector<ModelTask> read_models(const MapReader& top, const ModelTask& prototype,
                                   const std::filesystem::path& folder);

}  // namespace lumenline
