#pragma once

#include <string>
#include <vector>

#include "engine/core/errors.h"

namespace lumenline::samples {

/// A file that must be refused.
struct Refusal {
    std::string name;
    std::string bytes;
    ErrorCode code;
    std::vector<std::string> parts;  ///< of the sentence
};

/// Fails the test unless reading the file throws a StageError of this code, in one sentence that begins with the
/// file's name and has all the parts.
void expect_refused(const Refusal& refusal);

/// `bytes` with the first `from` replaced by `to`.
std::string replaced(std::string bytes, const std::string& from, const std::string& to);
/// The sample of this name, changed in the same way.
std::string changed(const std::string& sample, const std::string& from, const std::string& to);

}  // namespace lumenline::samples
