#pragma once

#include <span>

#include "config/cohort.h"
#include "engine/core/model_record.h"

namespace lumenline {

/// Writes the index of a cohort's archive, with labels by the rule of its configuration. What is odd about labels or
/// files is said on standard error.
/// @throws StageError as write_index
void make_index(const CohortConfig& config, std::span<const ModelSummary> rows);

}  // namespace lumenline
