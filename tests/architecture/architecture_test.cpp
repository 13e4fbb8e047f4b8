// The rules on the repository as it is; rules_test.cpp shows that each of them can fail.
#include <gtest/gtest.h>

#include "tests/architecture/rules.h"

namespace lumenline::architecture {
namespace {

std::string listed(const Violations& violations) {
    std::string text;
    for (const std::string& violation : violations) text += "\n  " + violation;
    return text;
}

Tree product() {
    Tree tree = read_tree(LUMENLINE_SOURCE_DIR, {"engine", "io", "config"});
    // A wrong folder would make every test below pass on nothing.
    EXPECT_TRUE(tree.contains("engine/core/vec3.h") && tree.contains("io/mesh/mesh_io.h") &&
                tree.contains("config/cohort.h") && tree.contains("engine/cli/main.cpp"));
    return tree;
}

TEST(Architecture, RoomsSeeOnlyWhatTheyMay) {
    const Violations violations = include_violations(product());
    EXPECT_TRUE(violations.empty()) << listed(violations);
}

TEST(Architecture, FilesKeepTheirSize) {
    Tree tree = product();
    tree.merge(read_tree(LUMENLINE_SOURCE_DIR, {"tests", "bench"}));
    const Violations violations = size_violations(tree);
    EXPECT_TRUE(violations.empty()) << listed(violations);
}

TEST(Architecture, NothingIsMarkedUnfinished) {
    Tree tree = product();
    tree.merge(read_tree(LUMENLINE_SOURCE_DIR, {"tests", "bench"}));
    const Violations violations = wording_violations(tree);
    EXPECT_TRUE(violations.empty()) << listed(violations);
}

TEST(Architecture, EverySourceIsBuilt) {
    Tree tree = product();
    tree.merge(read_tree(LUMENLINE_SOURCE_DIR, {"tests"}));
    const Violations violations = listing_violations(tree);
    EXPECT_TRUE(violations.empty()) << listed(violations);
}

}  // namespace
}  // namespace lumenline::architecture
