// The moment of a kill is drawn between nothing and somewhat more than a whole run takes, so that some runs end before
// it. As long as every kill came before the first file (the machine may be slower than when the whole run was timed),
// it is drawn later, and kills do not count as enough. What stands is then thinned out at random, lest the later runs
// have nothing left to do.
#include "tests/cli/kill_support.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <random>
#include <thread>

#include "tests/cli/cohort_support.h"
#include "tests/cli/hdf_contents.h"

namespace lumenline::cli_test {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Opens every file that stands, while the run goes on until `end`.
std::size_t poll_until(Process& run, const fs::path& archive, Clock::time_point end) {
    std::size_t opened = 0;
    while (run.running() && Clock::now() < end) {
        for (const fs::path& file : hdf_files(archive)) {
            if (Clock::now() >= end) break;
            EXPECT_NO_THROW(hdf_contents(file)) << file << " is torn";
            ++opened;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return opened;
}

}  // namespace

void expect_kills_leave_no_trace(int kills, unsigned seed, const std::vector<std::string>& arguments) {
    const fs::path folder = small_cohort();
    write_text(folder / "junk.stl", "no surface\n");
    write_text(folder / "cohort.yaml", read_text(folder / "cohort.yaml") +
                                           "  - {id: junk, surface: junk.stl}\n"
                                           "  - {id: lost, surface: missing.stl}\n");
    const auto start = Clock::now();
    ASSERT_EQ(run_cohort(folder).status, 1) << "two models fail";
    double latest = 1.2 * std::chrono::duration<double>(Clock::now() - start).count();
    const fs::path archive = folder / "results";
    ASSERT_EQ(hdf_files(archive).size(), 7U);
    const auto expected = archive_contents(archive);
    fs::remove_all(archive);

    std::vector<std::string> command{LUMENLINE_BINARY, "run", "cohort.yaml", "--threads", "2"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    std::mt19937 random(seed);
    int killed = 0;
    std::size_t opened = 0;
    while ((killed < kills || opened == 0) && !::testing::Test::HasFailure()) {
        const std::chrono::duration<double> moment(std::uniform_real_distribution(0.0, latest)(random));
        Process run(command, folder);
        opened += poll_until(run, archive, Clock::now() + std::chrono::duration_cast<Clock::duration>(moment));
        if (opened == 0) latest *= 1.5;
        if (run.running()) {
            run.send(SIGKILL);
            ++killed;
        }
        const Finished ended = run.wait();
        if (ended.signal == 0) {
            EXPECT_EQ(ended.status, 1) << ended.err;
        }
        for (const fs::path& file : hdf_files(archive)) {
            EXPECT_NO_THROW(hdf_contents(file)) << file << " is torn";
            if (random() % 3 == 0) fs::remove(file);
        }
    }
    const Finished last = run_cohort(folder);
    EXPECT_EQ(last.status, 1) << last.err;
    EXPECT_EQ(differences(expected, archive_contents(archive)), std::vector<std::string>{});
    EXPECT_TRUE(temporary_files(folder).empty());
}

}  // namespace lumenline::cli_test
