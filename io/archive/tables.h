#pragma once

#include <string>
#include <vector>

#include "engine/core/branch_tables.h"
#include "io/archive/model_file.h"
#include "io/archive/read.h"
#include "io/archive/writer.h"

namespace lumenline::hdf {

/// A field of scalars, in the precision that was asked for.
void write_scalars(Writer& writer, const names::Field& field, const std::vector<double>& values, std::size_t expected,
                   const ArchiveOptions& options);

/// Writes each column as a dataset below `group`, its definition as `description`, and its `source` where it has one.
void write_table(Writer& writer, const std::string& group, const Table& table);

/// /graph, the tables of branches, and what they add to /centerlines and /surface.
void write_branches(Writer& writer, const Branches& branches, std::size_t sites, std::size_t points,
                    const ArchiveOptions& options);

/// Can a column of kIndex have that value? NaN can not.
bool is_index(double value);

/// Reads the columns of `table` from below `group`. @returns false where the file has no such group
/// @throws ArchiveError for columns of different length
bool read_table(const ArchiveFile& file, const std::string& group, Table& table);

}  // namespace lumenline::hdf
