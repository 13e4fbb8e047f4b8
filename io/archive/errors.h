#pragma once

#include <stdexcept>

namespace lumenline {

/// An archive or model file that cannot be read: not HDF5, truncated, of another format, or
/// inconsistent in itself. `what()` is one sentence with the file and the place.
class ArchiveError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A name that the archive does not have: the archive itself, a model, a dataset, an attribute.
/// `what()` is one sentence with the nearest names.
class UnknownName : public ArchiveError {
public:
    using ArchiveError::ArchiveError;
};

}  // namespace lumenline
