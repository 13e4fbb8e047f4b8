// A run that is stopped while models are on their way. The signal is sent when the first model file stands, which
// needs no clock; there are so many models that the run cannot be over by then.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <thread>

#include "tests/cli/cohort_support.h"
#include "tests/cli/hdf_contents.h"

namespace lumenline::cli_test {
namespace {

namespace fs = std::filesystem;

constexpr int kModels = 300;

fs::path long_cohort() {
    const fs::path folder = fresh_folder();
    make_phantom_file(folder / "tube.ply", {"cylinder", "--b", "4", "--length", "60"});
    std::string text = "cohort: long\nmodels:\n";
    for (int i = 0; i < kModels; ++i) text += "  - {id: m" + std::to_string(i) + ", surface: tube.ply}\n";
    write_text(folder / "cohort.yaml", text);
    return folder;
}

std::vector<fs::path> model_files(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code none_yet;
    for (const auto& entry : fs::directory_iterator(folder / "results/models", none_yet))
        if (entry.path().extension() == ".hdf") files.push_back(entry.path());
    return files;
}

void wait_for_first_model(Process& run, const fs::path& folder) {
    while (run.running() && model_files(folder).empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

class Stop : public ::testing::TestWithParam<int> {};

TEST_P(Stop, LeavesWholeFilesAnIndexAndStatusThree) {
    const fs::path folder = long_cohort();
    Process run({LUMENLINE_BINARY, "run", "cohort.yaml", "--threads", "2"}, folder);
    wait_for_first_model(run, folder);
    ASSERT_TRUE(run.running());
    run.send(GetParam());
    const Finished stopped = run.wait();
    EXPECT_EQ(stopped.signal, 0);
    EXPECT_EQ(stopped.status, 3) << stopped.err;
    EXPECT_NE(stopped.err.find("stopped: "), std::string::npos) << stopped.err;

    const auto files = model_files(folder);
    EXPECT_GE(files.size(), 1U);
    EXPECT_LT(files.size(), static_cast<std::size_t>(kModels));
    for (const fs::path& file : files) {
        const auto contents = hdf_contents(file);
        EXPECT_TRUE(contents.contains("/centerlines/points")) << file;
        EXPECT_NE(get_attribute(folder, file.string(), file.stem().string(), "status"), "failed");
    }
    EXPECT_TRUE(temporary_files(folder).empty());
    // The index lists what stands, no more and no less.
    const Finished list = run_lumenline({"browse", "results"}, folder);
    EXPECT_EQ(list.status, 0) << list.err;
    EXPECT_EQ(lines_of(list.out).size(), files.size() + 1);
}

INSTANTIATE_TEST_SUITE_P(Signals, Stop, ::testing::Values(SIGTERM, SIGINT),
                         [](const auto& tested) { return tested.param == SIGTERM ? "Terminate" : "Interrupt"; });

TEST(Kill, KilledRunLeavesNothingThatIsTakenForAModel) {
    const fs::path folder = long_cohort();
    Process run({LUMENLINE_BINARY, "run", "cohort.yaml", "--threads", "2"}, folder);
    wait_for_first_model(run, folder);
    ASSERT_TRUE(run.running());
    run.send(SIGKILL);
    EXPECT_EQ(run.wait().signal, SIGKILL);
    for (const fs::path& file : model_files(folder)) EXPECT_NO_THROW(hdf_contents(file)) << file;
    // The next run takes what stands into its index and ignores what was being written.
    write_text(folder / "results/models/m299.hdf.tmp", "half a model");
    const std::size_t before = model_files(folder).size();
    const Finished next = run_lumenline({"run", "cohort.yaml", "--only", "m298"}, folder);
    EXPECT_EQ(next.status, 0) << next.err;
    EXPECT_EQ(lines_of(run_lumenline({"browse", "results"}, folder).out).size(), before + 2);
}

}  // namespace
}  // namespace lumenline::cli_test
