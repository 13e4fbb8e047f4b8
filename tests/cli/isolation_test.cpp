// Worker processes: the same bytes as without, and what becomes of a model whose worker dies, takes too long or too
// much memory. Workers are made to crash from outside, by the signal that the crash would raise.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "tests/cli/cohort_support.h"
#include "tests/cli/hdf_contents.h"
#include "tests/cli/kill_support.h"

namespace lumenline::cli_test {
namespace {

namespace fs = std::filesystem;

void pause() { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }

/// State and parent of a process; state 'X' if there is none.
std::pair<char, long> state_of(long process) {
    std::ifstream in("/proc/" + std::to_string(process) + "/stat");
    std::string line;
    if (!std::getline(in, line)) return {'X', 0};
    std::istringstream fields(line.substr(line.rfind(')') + 1));
    char state = 'X';
    long parent = 0;
    fields >> state >> parent;
    return {state, parent};
}

bool lives(long process) {
    const char state = state_of(process).first;
    return state != 'X' && state != 'Z';
}

/// Has a process used a fifth of a second of a processor? Then it is inside of a model.
bool computes(long process) {
    std::ifstream in("/proc/" + std::to_string(process) + "/stat");
    std::string line, field;
    std::getline(in, line);
    std::istringstream fields(line.substr(std::min(line.rfind(')') + 1, line.size())));
    constexpr int kFieldsToUserTime = 12;
    for (int i = 0; i < kFieldsToUserTime; ++i) fields >> field;
    return std::atol(field.c_str()) > ::sysconf(_SC_CLK_TCK) / 5;
}

std::vector<long> children_of(long parent) {
    std::vector<long> children;
    for (const auto& entry : fs::directory_iterator("/proc")) {
        const std::string name = entry.path().filename().string();
        if (name.find_first_not_of("0123456789") != std::string::npos) continue;
        if (state_of(std::stol(name)).second == parent && lives(std::stol(name))) children.push_back(std::stol(name));
    }
    return children;
}

/// The small cohort with a model `large` beside it, which takes seconds.
fs::path cohort_with_large() {
    const fs::path folder = small_cohort();
    const Finished made = run_lumenline(
        {"phantom", "cylinder", "--points-around", "150", "--length", "60", "--jitter", "0.2", "-o", "large.ply"},
        folder);
    EXPECT_EQ(made.status, 0) << made.err;
    write_text(folder / "cohort.yaml", read_text(folder / "cohort.yaml") + "  - {id: large, surface: large.ply}\n");
    return folder;
}

bool small_ones_stand(const fs::path& folder) {
    return std::ranges::all_of(std::vector{"tube", "bend", "coil", "narrow"}, [&](const std::string& id) {
        return fs::exists(folder / "results/models" / (id + ".hdf"));
    });
}

/// Runs until only `large` is left, and then sends its worker a signal.
Finished run_and_end_worker(const fs::path& folder, int signal, std::vector<std::string> arguments = {}) {
    arguments.insert(arguments.begin(), {LUMENLINE_BINARY, "run", "cohort.yaml", "--threads", "2"});
    arguments.insert(arguments.end(), {"--isolation", "process"});
    Process run(arguments, folder);
    while (run.running() && !(small_ones_stand(folder) && std::ranges::any_of(children_of(run.id()), computes)))
        pause();
    EXPECT_TRUE(run.running()) << "large takes longer than the others";
    for (const long worker : children_of(run.id())) ::kill(static_cast<pid_t>(worker), signal);
    return run.wait();
}

std::string failure(const fs::path& folder, const std::string& name) {
    return get_attribute(folder, "results", "large", "failure_" + name);
}

TEST(Isolation, GivesTheSameBytesAtAnyNumberOfThreads) {
    const fs::path folder = small_cohort();
    write_text(folder / "junk.stl", "no surface\n");
    write_text(folder / "cohort.yaml", read_text(folder / "cohort.yaml") + "  - {id: junk, surface: junk.stl}\n");
    ASSERT_EQ(run_cohort(folder).status, 1);
    ASSERT_EQ(hdf_files(folder / "results").size(), 6U);
    const auto expected = archive_contents(folder / "results");
    fs::remove_all(folder / "results");
    for (const char* threads : {"1", "2", "7"}) {
        fs::remove_all(folder / "results");
        const Finished run = run_cohort(folder, {"--isolation", "process", "--threads", threads});
        EXPECT_EQ(run.status, 1) << run.err;
        EXPECT_NE(run.err.find("junk: failed in load"), std::string::npos) << run.err;
        EXPECT_EQ(differences(expected, archive_contents(folder / "results")), std::vector<std::string>{});
        EXPECT_TRUE(temporary_files(folder).empty());
    }
    const Finished again = run_cohort(folder, {"--dry-run"});
    EXPECT_NE(again.out.find("0 would run"), std::string::npos) << again.out;
}

TEST(Isolation, CrashFailsItsModelAndTheOthersComplete) {
    const fs::path folder = cohort_with_large();
    const Finished crashed = run_and_end_worker(folder, SIGSEGV);
    EXPECT_EQ(crashed.status, 1) << crashed.err;
    EXPECT_NE(crashed.err.find("signal 11 (SIGSEGV)"), std::string::npos) << crashed.err;
    EXPECT_EQ(failure(folder, "code"), "crashed");
    EXPECT_EQ(failure(folder, "signal"), "11");
    const std::vector<std::string> stages{"load",  "condition",    "voronoi",  "endpoints", "eikonal",
                                          "trace", "characterize", "branches", "archive"};
    EXPECT_TRUE(std::ranges::count(stages, failure(folder, "stage")) == 1) << failure(folder, "stage");
    EXPECT_TRUE(small_ones_stand(folder));
    EXPECT_TRUE(temporary_files(folder).empty());
    EXPECT_EQ(lines_of(run_lumenline({"browse", "results"}, folder).out).size(), 6U);
    EXPECT_NE(run_cohort(folder, {"--dry-run"}).out.find("0 would run"), std::string::npos) << "it would crash again";
    // A kill is another matter: it came from outside.
    EXPECT_EQ(run_and_end_worker(folder, SIGKILL, {"--retry-failed"}).status, 1);
    EXPECT_EQ(failure(folder, "code"), "crashed");
    EXPECT_EQ(failure(folder, "signal"), "9");
    EXPECT_NE(run_cohort(folder, {"--dry-run"}).out.find("1 would run"), std::string::npos);
    EXPECT_NE(run_lumenline({"status", "cohort.yaml"}, folder).out.find("1 pending"), std::string::npos);
}

TEST(Isolation, LimitsOfTimeAndMemoryHoldInsideAStage) {
    const fs::path folder = cohort_with_large();
    const std::string plain = read_text(folder / "cohort.yaml");
    write_text(folder / "cohort.yaml", "run: {isolation: process, model_timeout: 1 s}\n" + plain);
    EXPECT_EQ(run_cohort(folder, {"--only", "large"}).status, 1);
    EXPECT_EQ(failure(folder, "code"), "timeout");
    EXPECT_NE(failure(folder, "sentence").find("its process was ended"), std::string::npos);
#ifndef __SANITIZE_ADDRESS__
    // large needs some 200 MB, the others below 20.
    write_text(folder / "cohort.yaml", "run: {isolation: process, model_memory: 60 MB}\n" + plain);
    EXPECT_EQ(run_cohort(folder).status, 1);
    EXPECT_EQ(failure(folder, "code"), "out_of_memory") << failure(folder, "sentence");
    EXPECT_TRUE(small_ones_stand(folder));
#endif
    // Without worker processes limits are looked at between stages.
    write_text(folder / "cohort.yaml", "run: {model_memory: 60 MB}\n" + plain);
    EXPECT_EQ(run_cohort(folder).status, 1);
    EXPECT_EQ(failure(folder, "code"), "out_of_memory");
    EXPECT_EQ(failure(folder, "stage"), "voronoi");
    EXPECT_NE(failure(folder, "sentence").find("run.model_memory"), std::string::npos);
    EXPECT_TRUE(small_ones_stand(folder));
}

TEST(Isolation, WorkersEndWithAKilledRun) {
    const fs::path folder = cohort_with_large();
    Process run({LUMENLINE_BINARY, "run", "cohort.yaml", "--threads", "2", "--isolation", "process"}, folder);
    while (run.running() && children_of(run.id()).size() < 2) pause();
    const std::vector<long> workers = children_of(run.id());
    ASSERT_GE(workers.size(), 2U);
    run.send(SIGKILL);
    EXPECT_EQ(run.wait().signal, SIGKILL);
    for (const long worker : workers)
        while (lives(worker)) pause();
    const Finished next = run_cohort(folder, {"--only", "tube"});
    EXPECT_EQ(next.status, 0) << next.err;
}

TEST(Isolation, SignalEndsTheRunWithItsWorkersAndItCanBeResumed) {
    const fs::path folder = cohort_with_large();
    Process run({LUMENLINE_BINARY, "run", "cohort.yaml", "--threads", "2", "--isolation", "process"}, folder);
    while (run.running() && !small_ones_stand(folder)) pause();
    ASSERT_TRUE(run.running());
    const std::vector<long> workers = children_of(run.id());
    run.send(SIGTERM);
    const Finished stopped = run.wait();
    EXPECT_EQ(stopped.status, 3) << stopped.err;
    EXPECT_NE(stopped.err.find("stopped: "), std::string::npos) << stopped.err;
    EXPECT_TRUE(std::ranges::none_of(workers, lives));
    EXPECT_TRUE(temporary_files(folder).empty());
    EXPECT_FALSE(fs::exists(folder / "results/runs/1-of-1.lease"));
    EXPECT_EQ(lines_of(run_lumenline({"browse", "results"}, folder).out).size(), 5U) << "the index lists what stands";
}

TEST(Isolation, KillsAtRandomMomentsLeaveNoTrace) { expect_kills_leave_no_trace(5, 3, {"--isolation", "process"}); }

TEST(Isolation, FlagAndKeyAreChecked) {
    const fs::path folder = small_cohort();
    const Finished run = run_cohort(folder, {"--isolation", "thread"});
    EXPECT_EQ(run.status, 2);
    EXPECT_NE(run.err.find("--isolation"), std::string::npos) << run.err;
    EXPECT_EQ(run_lumenline({"--help"}, folder).out.find("worker"), std::string::npos) << "a verb for runs alone";
}

}  // namespace
}  // namespace lumenline::cli_test
