#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/core/branch_labels.h"

namespace lumenline {

/// The way of each branch from the inlet, "1.2.1": of siblings, 1 is the first by number. Where there are other than
/// two siblings (one inlet) their number stands behind, "1.2of3". Confidence: the least order_margin on the way, at
/// most 1.
BranchLabels position_labels(const BranchTree& tree);

/// A model of the cohort as labelling sees it.
struct LabelledModel {
    std::string id;
    GivenLabels given;
    const BranchTree* tree = nullptr;
};

struct CohortLabels {
    std::vector<BranchLabels> of;         ///< per model
    std::vector<std::string> complaints;  ///< one sentence each: labels without branch, a template without tree
};

/// Labels the branches of all models by the rule of `options` (config/SCHEMA.md). The labels of a model depend on it,
/// on the template and on what is given by hand alone.
CohortLabels label_branches(const LabelOptions& options, std::span<const LabelledModel> models);

}  // namespace lumenline
