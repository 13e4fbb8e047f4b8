#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "io/archive/errors.h"

namespace lumenline {

/// One thing that is not as io/ARCHIVE.md has it.
struct Finding {
    std::string file;   ///< path, with the model's id where a file holds several
    std::string place;  ///< dataset, attribute "object@name", or empty: the file as a whole
    std::string what;   ///< what is wrong, and where

    [[nodiscard]] std::string sentence() const;  ///< "FILE: PLACE: WHAT"; control characters as '?'
};

struct Validation {
    std::vector<Finding> findings;
    std::size_t files = 0;     ///< records looked at: models and the index
    std::size_t datasets = 0;  ///< that the specification names
    std::size_t others = 0;    ///< datasets that it does not name, which the format allows
};

/// Holds an archive against its specification: what is there and what belongs together, types, ranks, lengths and
/// units, the range of every value, references from one dataset to another, and what follows from the method (Antiga et
/// al. 2003): the surface is closed and manifold, Voronoi balls touch their sites, eqs. 7 and 8 hold site by site,
/// lines have the length of their points, the index says what its models say.
///
/// @param archive  directory with a cohort.h5, packed archive, index, or one model file
/// @throws UnknownName if there is no archive. All else that is wrong is a finding, also a file that cannot be read.
/// @cost   reads all of each file once; memory for the largest
Validation validate_archive(const std::filesystem::path& archive);

}  // namespace lumenline
