// The same of a larger tree, whose mesh takes a minute.
#include <gtest/gtest.h>

#include "tests/stages/tree.h"

namespace lumenline {
namespace {

TEST(LargeTree, EveryLeafIsReachedAlongItsAxes) {
    TreeOptions options;
    options.leaves = 64;
    test::expect_axes_of_tree(options);
}

}  // namespace
}  // namespace lumenline
