#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/core/branch_labels.h"
#include "engine/core/endpoints.h"
#include "engine/core/table.h"
#include "io/archive/read.h"

namespace lumenline::hdf {

/// Kinds, roles, points and radii of a model file's endpoints.
/// @throws ArchiveError for what is none
Endpoints read_endpoints(const ArchiveFile& file);

/// The rows of a model for index_tables, without labels. @throws ArchiveError
std::vector<Table> read_index_tables(const ArchiveFile& file);

/// What an index has to know of a model's tables before it reads them.
struct TableOutline {
    std::vector<std::size_t> rows;               ///< per table of index_tables
    std::size_t kind_width = 0, role_width = 0;  ///< longest text of the endpoints [bytes]
    BranchTree tree;
};

/// @throws ArchiveError
/// @cost a tenth of read_index_tables
TableOutline read_outline(const ArchiveFile& file);

}  // namespace lumenline::hdf
