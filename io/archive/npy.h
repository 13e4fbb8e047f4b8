#pragma once

#include <iosfwd>

#include "io/archive/dataset.h"

namespace lumenline::hdf {

/// Writes values in numpy's .npy format, version 1.0 (numpy.lib.format): numbers in the type they have in the file,
/// little-endian, in C order; text as `<U` of the longest one. Bytes that are no UTF-8 become U+FFFD.
/// @throws Error for values of a type that we do not read
void write_npy(const Values& values, std::ostream& out);

}  // namespace lumenline::hdf
