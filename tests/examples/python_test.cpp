// examples/python, on an archive of two phantoms and a failure.
#include <gtest/gtest.h>

#include "tests/cli/process.h"

namespace lumenline {
namespace {

using cli_test::Finished;
using cli_test::run_lumenline;
using cli_test::run_shell;

TEST(PythonExamples, ReadAnArchiveAndAnalyseIt) {
    const auto folder = cli_test::fresh_folder();
    const std::string modules = "import h5py, pandas, matplotlib";
    const std::string python =
        "$(for p in python3 /usr/bin/python3; do $p -c '" + modules + "' 2>/dev/null && echo $p && break; done)";
    if (run_shell("test -n \"" + python + "\"", folder).status != 0)
        GTEST_SKIP() << "h5py, pandas or matplotlib are not installed (Debian: python3-h5py python3-pandas "
                        "python3-matplotlib)";
    const auto phantom = [&](const std::vector<std::string>& arguments) {
        std::vector<std::string> all{"phantom"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        ASSERT_EQ(run_lumenline(all, folder).status, 0);
    };
    phantom({"cylinder", "-o", "wide.ply", "--length", "20", "--points-around", "20"});
    phantom({"stenosis", "-o", "narrow.ply", "--length", "20", "--severity", "0.5", "--points-around", "32"});
    cli_test::write_text(folder / "broken.ply", "ply\n");
    cli_test::write_text(folder / "models.tsv",
                         "id\tsurface\tgroup\nwide\twide.ply\ta\nnarrow\tnarrow.ply\tb\nbroken\tbroken.ply\tb\n");
    cli_test::write_text(folder / "cohort.yaml",
                         "cohort: a\nlength_unit: mm\nmodels: {table: models.tsv}\narchive: {directory: results}\n");
    ASSERT_EQ(run_lumenline({"run", "cohort.yaml"}, folder).status, 1);
    const Finished tested =
        run_shell(python + " " LUMENLINE_SOURCE_DIR "/tests/examples/python_test.py results", folder);
    EXPECT_EQ(tested.status, 0) << tested.err;
}

}  // namespace
}  // namespace lumenline
