#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "config/reader.h"
#include "engine/core/branch_labels.h"
#include "engine/core/options.h"

namespace lumenline {

/// Labels of branches in a table's cell: "0=aorta;1=left".
GivenLabels parse_branch_labels(const Place& place, std::string_view cell);

/// The same as a map under `branch_labels` of a model; empty when absent.
GivenLabels read_branch_labels(const MapReader& model);

/// The section `population`. Labels of its table are added to those of the tasks.
/// @param folder  that relative paths are relative to
/// @throws ConfigError, also where a template or a row names no model, or a branch is labelled twice
LabelOptions read_population(const MapReader& top, const std::filesystem::path& folder, std::vector<ModelTask>& tasks);

std::string_view label_rule_name(LabelRule rule);  ///< "position" | "given" | "template" | "none"

}  // namespace lumenline
