#include "engine/population/labels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/population/tree_matching.h"

namespace lumenline {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

BranchLabels unlabelled(const BranchTree& tree) {
    return {std::vector<std::string>(tree.size()), std::vector<double>(tree.size(), kNaN)};
}

/// Labels by hand stand instead of what was found; what was found elsewhere under the same name is withdrawn.
void put_given(const LabelledModel& model, BranchLabels& labels, std::vector<std::string>& complaints) {
    for (const auto& [branch, label] : model.given)
        for (std::size_t b = 0; b < labels.label.size(); ++b)
            if (labels.label[b] == label) {
                labels.label[b].clear();
                labels.confidence[b] = kNaN;
            }
    for (const auto& [branch, label] : model.given) {
        if (branch < labels.label.size()) {
            labels.label[branch] = label;
            labels.confidence[branch] = 1;
        } else if (labels.label.empty()) {
            complaints.push_back("the model '" + model.id + "' has no branches, but a label for its branch " +
                                 std::to_string(branch) + ", '" + label + "'");
        } else {
            complaints.push_back("the model '" + model.id + "' has the branches 0 to " +
                                 std::to_string(labels.label.size() - 1) + ", but a label for " +
                                 std::to_string(branch) + ", '" + label + "'");
        }
    }
}

BranchLabels matched_labels(const BranchTree& tree, const BranchTree& pattern, const BranchLabels& names, bool axes) {
    const TreeMatch match = match_trees(tree, pattern, axes);
    BranchLabels labels = unlabelled(tree);
    for (std::size_t b = 0; b < tree.size(); ++b) {
        if (match.partners[b].empty()) continue;
        for (const std::size_t partner : match.partners[b])
            labels.label[b].append(labels.label[b].empty() ? "" : "+").append(names.label[partner]);
        if (match.part[b] > 0) labels.label[b].append(":").append(std::to_string(match.part[b]));
        labels.confidence[b] = match.confidence[b];
    }
    return labels;
}

/// The template's own labels: those given by hand, else the positions.
BranchLabels template_labels(const LabelledModel& model) {
    BranchLabels labels = position_labels(*model.tree);
    std::fill(labels.confidence.begin(), labels.confidence.end(), 1.0);
    for (const auto& [branch, label] : model.given)
        if (branch < labels.label.size()) labels.label[branch] = label;
    return labels;
}

}  // namespace

BranchLabels position_labels(const BranchTree& tree) {
    const std::size_t n = tree.size();
    std::vector<std::vector<std::size_t>> siblings(n + 1);
    BranchLabels labels{std::vector<std::string>(n), std::vector<double>(n, 1)};
    for (std::size_t b = 0; b < n; ++b) siblings[tree.parent[b].is_none() ? n : at(tree.parent[b])].push_back(b);
    std::vector<std::size_t> place(n);
    for (const auto& group : siblings)
        for (std::size_t k = 0; k < group.size(); ++k) place[group[k]] = k + 1;
    for (std::size_t b = 0; b < n; ++b) {
        const bool root = tree.parent[b].is_none();
        const std::size_t count = siblings[root ? n : at(tree.parent[b])].size();
        std::string step = std::to_string(place[b]);
        if (count != (root ? 1 : 2)) step.append("of").append(std::to_string(count));
        labels.label[b] = root ? step : labels.label[at(tree.parent[b])] + "." + step;
        // fmin: a branch without sibling has no margin, and takes nothing from that of its way.
        labels.confidence[b] = std::fmin(root ? 1 : labels.confidence[at(tree.parent[b])], tree.order_margin[b]);
    }
    return labels;
}

CohortLabels label_branches(const LabelOptions& options, std::span<const LabelledModel> models) {
    CohortLabels result;
    const auto pattern = std::find_if(models.begin(), models.end(),
                                      [&](const LabelledModel& m) { return m.id == options.template_model; });
    const bool match = options.rule == LabelRule::kTemplate && pattern != models.end() && pattern->tree->size() > 0;
    BranchLabels names;
    if (match) names = template_labels(*pattern);
    if (options.rule == LabelRule::kTemplate && !match)
        result.complaints.push_back("the template '" + options.template_model +
                                    "' has no branches: only labels given by hand stand");
    for (const LabelledModel& model : models) {
        BranchLabels labels = options.rule == LabelRule::kPosition ? position_labels(*model.tree)
                              : match && model.id == pattern->id   ? names
                              : match ? matched_labels(*model.tree, *pattern->tree, names, options.axes)
                                      : unlabelled(*model.tree);
        const bool hand = options.rule == LabelRule::kGiven || options.rule == LabelRule::kTemplate;
        if (hand) put_given(model, labels, result.complaints);
        result.of.push_back(std::move(labels));
    }
    return result;
}

}  // namespace lumenline
