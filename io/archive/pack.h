#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "io/archive/errors.h"

namespace lumenline {

/// What became of an archive's models.
struct Packed {
    std::size_t models = 0;
    std::size_t missing = 0;  ///< named by the index, without a file: left out
};

/// Copies an archive into one file: the index, with every model's record as a real group in the place of its link, for
/// viewers that follow no links to other files (myHDF5, H5Web) and for sending. The file appears when it is complete.
/// @param progress  called after each model with the numbers done and in all; may be null
/// @throws ArchiveError if a file cannot be read or written; UnknownName if there is no archive
/// @cost copies all bytes
Packed pack_archive(const std::filesystem::path& archive, const std::filesystem::path& file,
                    const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace lumenline
