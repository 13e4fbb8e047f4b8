#include "engine/cli/make_index.h"

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <vector>

#include "engine/population/labels.h"
#include "io/archive/index.h"
#include "io/archive/utf8.h"

namespace lumenline {

void make_index(const CohortConfig& config, std::span<const ModelSummary> rows) {
    const auto say = [](const std::vector<std::string>& sentences) {
        for (const std::string& sentence : sentences) fmt::print(stderr, "lumenline: {}\n", printable(sentence));
    };
    const BranchLabeller label = [&](std::span<const BranchTree> trees) {
        std::vector<LabelledModel> models;
        for (std::size_t m = 0; m < rows.size(); ++m)
            models.push_back({rows[m].identity.id, rows[m].identity.branch_labels, &trees[m]});
        CohortLabels labels = label_branches(config.labels, models);
        say(labels.complaints);
        return std::move(labels.of);
    };
    say(write_index(config.archive.directory, rows, config.text, resolved_text(config), label));
}

}  // namespace lumenline
