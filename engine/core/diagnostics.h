#pragma once

#include <limits>
#include <string>
#include <vector>

#include "engine/core/errors.h"

namespace lumenline {

enum class Severity { kNote, kWarning, kError };

/// Lower-case name of a severity, as written in the archive.
std::string_view severity_name(Severity severity);

/// One finding about a model, archived with it (`/diagnostics`).
struct Diagnostic {
    std::string code;  ///< stable snake_case name
    Severity severity = Severity::kNote;
    Stage stage = Stage::kLoad;
    std::string message;                                      ///< one sentence
    double value = std::numeric_limits<double>::quiet_NaN();  ///< what was measured; NaN = none
    double limit = std::numeric_limits<double>::quiet_NaN();  ///< what it was held against; NaN = none
};

/// Findings in the order in which the stages made them.
using Diagnostics = std::vector<Diagnostic>;

}  // namespace lumenline
