#pragma once

#include <functional>
#include <iosfwd>

namespace lumenline {

/// Runs `body` with a buffered stream on standard output.
///
/// @returns false if the reader of the output has gone (a broken pipe), in which case `body` was
///          left where it stood
/// @throws  std::system_error if standard output cannot be written for another reason; what `body` throws
bool to_standard_output(const std::function<void(std::ostream&)>& body);

}  // namespace lumenline
