#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "engine/core/table.h"

namespace lumenline::hdf {

/// The rows of tables in one piece: an index is made of some two hundred columns of each model, and to open that many
/// datasets costs a hundred times what their values do.
///
/// Little-endian: CRC-32 of the columns' names and kinds and of all that follows (uint32); rows of each table (uint32);
/// then column by column numbers (float64), or texts, each as its length (uint32) and bytes.
std::vector<std::uint8_t> pack_rows(const std::vector<Table>& tables);

/// @param tables  their columns; their rows are replaced
/// @returns false where the bytes are damaged or are of other columns; the rows are then any
bool unpack_rows(std::string_view bytes, std::vector<Table>& tables);

}  // namespace lumenline::hdf
