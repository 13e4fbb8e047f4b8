// Whole models of a branching lumen whose axes are known.
#include "tests/stages/tree.h"

#include <gtest/gtest.h>

namespace lumenline {
namespace {

TEST(Tree, EveryLeafIsReachedAlongItsAxes) {
    TreeOptions options;
    options.leaves = 8;
    test::expect_axes_of_tree(options);
}

}  // namespace
}  // namespace lumenline
