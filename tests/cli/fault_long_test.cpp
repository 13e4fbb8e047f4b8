// The faults of fault_test.cpp at length.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <thread>

#include "tests/cli/cohort_support.h"
#include "tests/cli/kill_support.h"

namespace lumenline::cli_test {
namespace {

namespace fs = std::filesystem;

TEST(FaultLong, HundredKillsAtRandomMomentsLeaveNoTrace) { expect_kills_leave_no_trace(100, 2); }

TEST(FaultLong, StageThatHeedsNoSignalIsAbandonedWithinSeconds) {
    const fs::path folder = fresh_folder();
    // A Delaunay triangulation of this many points takes longer than the run grants.
    const Finished made = run_lumenline({"phantom", "cylinder", "--points-around", "700", "--length", "60", "--jitter",
                                         "0.2", "-o", (folder / "large.ply").string()},
                                        folder);
    ASSERT_EQ(made.status, 0) << made.err;
    make_phantom_file(folder / "small.ply", {"cylinder", "--b", "4", "--length", "30"});
    write_text(folder / "cohort.yaml",
               "cohort: slow\ncondition: {check_self_intersections: false, refine_undersampled: false}\nmodels:\n"
               "  - {id: large, surface: large.ply}\n  - {id: small, surface: small.ply}\n");
    Process run({LUMENLINE_BINARY, "run", "cohort.yaml", "--threads", "2"}, folder);
    while (run.running() && !fs::exists(folder / "results/models/small.hdf"))
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ASSERT_TRUE(run.running());
    run.send(SIGTERM);
    const Finished stopped = run.wait();
    EXPECT_EQ(stopped.status, 3) << stopped.err;
    EXPECT_NE(stopped.err.find("stopped: 1 model not done"), std::string::npos) << stopped.err;
    EXPECT_EQ(lines_of(run_lumenline({"browse", "results"}, folder).out).size(), 2U) << "the index lists what stands";
    EXPECT_TRUE(fs::is_empty(folder / "results/runs") || !fs::exists(folder / "results/runs/1-of-1.lease"));
}

}  // namespace
}  // namespace lumenline::cli_test
