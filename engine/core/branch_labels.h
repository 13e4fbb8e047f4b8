#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/branches.h"
#include "engine/core/vec3.h"

namespace lumenline {

/// Where the labels come from that say which branches of different models are the same vessel.
enum class LabelRule : std::uint8_t {
    kPosition,  ///< the place in the model's own tree, by the rule of the branches' numbers
    kGiven,     ///< by hand, with the models
    kTemplate,  ///< matching to the tree of one of the models
    kNone,
};

struct LabelOptions {
    LabelRule rule = LabelRule::kPosition;
    std::string template_model;  ///< id; of kTemplate
    bool axes = false;           ///< compare directions in the coordinates themselves, beside angles within the tree
};

/// Labels given by hand: number of the branch, label.
using GivenLabels = std::vector<std::pair<std::size_t, std::string>>;

/// What correspondence needs to know of a model's branches, one value per branch.
struct BranchTree {
    std::vector<BranchId> parent;      ///< of lower number; none = from an inlet
    std::vector<double> length;        ///< from node to node [length]
    std::vector<double> radius;        ///< mean; NaN = unknown [length]
    std::vector<double> order_margin;  ///< as BranchTable's
    std::vector<Vec3> chord;           ///< from the first node to the last; NaN = unknown [length]

    [[nodiscard]] std::size_t size() const { return parent.size(); }
};

/// The labels of a model's branches, one per branch.
struct BranchLabels {
    std::vector<std::string> label;  ///< empty = the branch corresponds to none
    std::vector<double> confidence;  ///< 0 to 1; NaN where there is no label
};

}  // namespace lumenline
