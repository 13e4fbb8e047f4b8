#include "engine/core/index_tables.h"

#include <cassert>
#include <cstddef>

namespace lumenline {

namespace {

/// The column that names the branch of a row.
const Column& branch_column(const Table& table) {
    for (const char* name : {"branch_id", "child", "parent"})
        for (const Column& c : table.columns)
            if (c.name == name) return c;
    assert(false);
    return table.columns.front();
}

}  // namespace

std::vector<Table> index_tables(const Branches& branches, const Endpoints& endpoints) {
    std::vector<Table> tables = branch_tables(branches);
    tables.pop_back();  // patches are for maps, not for statistics of cohorts
    tables.push_back(endpoint_table(endpoints, branches.graph));
    for (Table& table : tables) {
        const std::size_t rows = table.rows();
        const std::string of = branch_column(table).name == "branch_id" ? "the branch" : branch_column(table).name;
        table.columns.push_back({"branch_label",
                                 "1",
                                 "of " + of + ": the same in models where it is the same vessel; empty = none",
                                 "",
                                 ColumnKind::kText,
                                 {},
                                 std::vector<std::string>(rows)});
        table.columns.push_back({"branch_label_confidence",
                                 "1",
                                 "how safe the label is, 0 to 1, by the rule of population.labels; NaN = no label",
                                 "",
                                 ColumnKind::kNumber,
                                 std::vector<double>(rows, Distribution::kNone),
                                 {}});
    }
    return tables;
}

void set_labels(const BranchLabels& labels, std::vector<Table>& tables) {
    for (Table& table : tables) {
        const std::vector<double>& branches = branch_column(table).numbers;
        Column &label = table.columns[table.columns.size() - 2], &confidence = table.columns.back();
        for (std::size_t row = 0; row < branches.size(); ++row) {
            if (!(branches[row] >= 0 && branches[row] < static_cast<double>(labels.label.size()))) continue;
            const auto branch = static_cast<std::size_t>(branches[row]);
            label.texts[row] = labels.label[branch];
            confidence.numbers[row] = labels.confidence[branch];
        }
    }
}

BranchTree branch_tree(const Table& branches) {
    const auto values = [&](const char* name) -> const std::vector<double>& {
        for (const Column& c : branches.columns)
            if (c.name == name) return c.numbers;
        assert(false);
        return branches.columns.front().numbers;
    };
    BranchTree tree;
    tree.length = values("length");
    tree.radius = values("radius_mean");
    tree.order_margin = values("order_margin");
    const std::vector<double>&chord = values("chord"), &x = values("direction_x"), &y = values("direction_y"),
          &z = values("direction_z"), &parent = values("parent");
    for (std::size_t b = 0; b < parent.size(); ++b) {
        // Branches are numbered level by level: what does not come before is no parent.
        const bool known = parent[b] >= 0 && parent[b] < static_cast<double>(b);
        tree.parent.push_back(known ? BranchId(static_cast<std::size_t>(parent[b])) : BranchId());
        tree.chord.push_back(chord[b] * Vec3{x[b], y[b], z[b]});
    }
    return tree;
}

}  // namespace lumenline
