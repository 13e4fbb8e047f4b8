#pragma once

#include <vector>

#include "engine/core/branch_labels.h"
#include "engine/core/branch_tables.h"
#include "engine/core/endpoints.h"
#include "engine/core/table.h"

namespace lumenline {

/// The tables of an index: those of a model but patches, and endpoints. The last two columns of each are branch_label
/// and branch_label_confidence, which only a cohort can fill: here they are empty and NaN.
std::vector<Table> index_tables(const Branches& branches, const Endpoints& endpoints);

/// Fills the last two columns of each of index_tables by the branch that a row names.
void set_labels(const BranchLabels& labels, std::vector<Table>& tables);

/// What correspondence needs, from the table of branches, which index_tables has first.
BranchTree branch_tree(const Table& branches);

}  // namespace lumenline
