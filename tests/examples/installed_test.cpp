// The installed package, as another project uses it.
#include <gtest/gtest.h>

#include "tests/cli/process.h"

namespace lumenline {
namespace {

using cli_test::Finished;
using cli_test::run_shell;

TEST(InstalledPackage, BuildsTheExampleAndTracesASurface) {
    const auto folder = cli_test::fresh_folder();
    const std::string source = LUMENLINE_SOURCE_DIR, build = LUMENLINE_BUILD_DIR;
    const Finished installed =
        run_shell("cmake --install '" + build + "' --prefix '" + (folder / "root").string() + "'", folder);
    ASSERT_EQ(installed.status, 0) << installed.err;
    const Finished built =
        run_shell("cmake -S '" + source + "/tests/examples/installed' -B build -DCMAKE_PREFIX_PATH='" +
                      (folder / "root").string() + "' -DONE_MODEL_SOURCE='" + source +
                      "/examples/one_model.cpp' '-DCMAKE_CXX_FLAGS=" LUMENLINE_LINK_FLAGS "' && cmake --build build",
                  folder);
    ASSERT_EQ(built.status, 0) << built.out << built.err;
    const Finished run = run_shell("build/one_model '" + source + "/examples/phantoms/torus_arc.ply'", folder);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("line 0: length"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("tangency deviation, mean over the wall: 0."), std::string::npos) << run.out;
    EXPECT_EQ(run_shell("build/one_model missing.ply", folder).status, 1);
    EXPECT_EQ(run_shell("root/bin/lumenline --version", folder).status, 0);
}

}  // namespace
}  // namespace lumenline
