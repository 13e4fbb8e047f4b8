#pragma once

#include <vector>

#include "engine/core/endpoints.h"
#include "engine/core/table.h"
#include "io/archive/read.h"

namespace lumenline::hdf {

/// Kinds, roles, points and radii of a model file's endpoints.
/// @throws ArchiveError for what is none
Endpoints read_endpoints(const ArchiveFile& file);

/// The rows of a model for index_tables, without labels, from their copy in one piece where there is a sound one; else
/// from their columns. @throws ArchiveError
/// @cost a tenth of a millisecond; from columns fifty times that
std::vector<Table> read_index_tables(const ArchiveFile& file);
std::vector<Table> read_columns_of_index_tables(const ArchiveFile& file);

}  // namespace lumenline::hdf
