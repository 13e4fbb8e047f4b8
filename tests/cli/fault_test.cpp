// Faults from outside: kills, full and read-only disks, signals. A small file system of its own is mounted where the
// test may do so; elsewhere these tests say that they were left out.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "tests/cli/cohort_support.h"
#include "tests/cli/hdf_contents.h"
#include "tests/cli/kill_support.h"

namespace lumenline::cli_test {
namespace {

namespace fs = std::filesystem;

/// A file system in memory, mounted on a folder as long as it lives.
class SmallDisk {
public:
    SmallDisk(fs::path folder, const std::string& size) : folder_(std::move(folder)) {
        fs::create_directories(folder_);
        mounted_ = ::mount("tmpfs", folder_.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0;
    }
    ~SmallDisk() {
        if (mounted_) ::umount2(folder_.c_str(), MNT_DETACH);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;

    [[nodiscard]] bool mounted() const { return mounted_; }
    [[nodiscard]] bool change(unsigned long flags, const std::string& size) const {
        return ::mount("tmpfs", folder_.c_str(), "tmpfs", MS_REMOUNT | flags, ("size=" + size).c_str()) == 0;
    }

private:
    fs::path folder_;
    bool mounted_ = false;
};

TEST(Fault, KillsAtRandomMomentsLeaveNoTrace) { expect_kills_leave_no_trace(5, 1); }

TEST(Fault, FullDiskFailsModelsAndTheNextRunCompletesThem) {
    const fs::path folder = small_cohort();
    ASSERT_EQ(run_cohort(folder).status, 0);
    fs::rename(folder / "results", folder / "whole");
    const SmallDisk disk(folder / "results", "900k");
    if (!disk.mounted()) GTEST_SKIP() << "this user may not mount a file system";
    const Finished full = run_cohort(folder);
    EXPECT_EQ(full.status, 1) << full.err;
    EXPECT_NE(full.err.find("failed in archive"), std::string::npos) << full.err;
    EXPECT_TRUE(temporary_files(folder).empty()) << "what cannot be completed is removed";
    for (const auto& entry : fs::directory_iterator(folder / "results/models"))
        EXPECT_NO_THROW(hdf_contents(entry.path())) << entry.path();
    ASSERT_TRUE(disk.change(0, "100m"));
    const Finished next = run_cohort(folder);
    EXPECT_EQ(next.status, 0) << next.err;
    for (const auto& entry : fs::directory_iterator(folder / "whole/models")) {
        const auto found = hdf_contents(folder / "results/models" / entry.path().filename());
        EXPECT_TRUE(differences(hdf_contents(entry.path()), found).empty()) << entry.path();
    }
}

TEST(Fault, ReadOnlyArchiveIsOneSentence) {
    const fs::path folder = small_cohort();
    const SmallDisk disk(folder / "results", "10m");
    if (!disk.mounted()) GTEST_SKIP() << "this user may not mount a file system";
    ASSERT_TRUE(disk.change(MS_RDONLY, "10m"));
    const Finished run = run_cohort(folder);
    EXPECT_EQ(run.status, 1);
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(lines_of(run.err).size(), 1U) << run.err;
    EXPECT_NE(run.err.find("results"), std::string::npos) << run.err;
}

TEST(Fault, SecondSignalEndsAtOnceAndTheRunCanBeResumed) {
    const fs::path folder = small_cohort();
    Process run({LUMENLINE_BINARY, "run", "cohort.yaml", "--threads", "1"}, folder);
    const fs::path lease = folder / "results/runs/1-of-1.lease";
    while (run.running() && !fs::exists(lease)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    // The handler of the first gives way to the default, so the second one ends the process wherever it is.
    while (run.running()) {
        run.send(SIGTERM);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const Finished ended = run.wait();
    EXPECT_TRUE(ended.signal == SIGTERM || ended.status == 3 || ended.status == 0) << ended.err;
    const Finished next = run_cohort(folder);
    EXPECT_EQ(next.status, 0) << next.err;
    EXPECT_TRUE(temporary_files(folder).empty());
    EXPECT_FALSE(fs::exists(lease));
}

}  // namespace
}  // namespace lumenline::cli_test
