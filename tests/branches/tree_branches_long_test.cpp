// The same of 64 leaves, whose mesh takes a minute.
#include <gtest/gtest.h>

#include "tests/branches/shapes.h"

namespace lumenline {
namespace {

TEST(LargeTreeBranches, MeasuresAreThoseOfTheAxes) {
    TreeOptions options;
    options.leaves = 64;
    const test::TreeModel model = test::tree_model(options);
    test::expect_branches_of_tree(model.tree.truth, model.branches);
}

}  // namespace
}  // namespace lumenline
