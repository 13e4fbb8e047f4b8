// Leases against living, dead and unreachable holders. A dead process is one that really ran; one on another machine
// is a lease of another boot, whose age is set through the file's time.
#include "io/archive/lease.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

namespace lumenline {
namespace {

namespace fs = std::filesystem;

fs::path fresh_archive() {
    const fs::path folder =
        fs::path(::testing::TempDir()) /
        ("lease-" + std::to_string(::getpid()) + "-" + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder);
    fs::create_directories(folder);
    return folder;
}

fs::path lease_file(const fs::path& archive, const std::string& part) { return archive / "runs" / (part + ".lease"); }

/// Takes a lease in a process that dies with it.
void die_with_lease(const fs::path& archive, Shard shard) {
    const pid_t child = ::fork();
    if (child == 0) {
        try {
            const Lease lease(archive, shard);
            ::_exit(0);
        } catch (...) {
            ::_exit(1);
        }
    }
    int status = 1;
    ::waitpid(child, &status, 0);
    ASSERT_EQ(status, 0);
}

/// A lease of a run on another machine, `age` seconds after its last sign of life.
void write_foreign(const fs::path& archive, const std::string& part, int age) {
    fs::create_directories(archive / "runs");
    std::ofstream(lease_file(archive, part)) << "host=elsewhere\nprocess=4711\nstart=1\nsince=2026-01-31 12:00:00 UTC\n"
                                                "boot=another\nprocesses=pid:[1]\n";
    fs::last_write_time(lease_file(archive, part), fs::file_time_type::clock::now() - std::chrono::seconds(age));
}

std::string refusal(const fs::path& archive, Shard shard) {
    try {
        const Lease lease(archive, shard);
    } catch (const LeaseHeld& held) {
        return held.what();
    }
    return "";
}

TEST(Lease, SecondHolderIsToldWhoHoldsIt) {
    const fs::path archive = fresh_archive();
    Lease first(archive, {});
    EXPECT_EQ(first.taken_over(), "");
    const std::string sentence = refusal(archive, {});
    EXPECT_NE(sentence.find("process " + std::to_string(::getpid())), std::string::npos) << sentence;
    EXPECT_NE(sentence.find(" UTC"), std::string::npos) << sentence;
    EXPECT_TRUE(first.beat()) << "the refused one has not touched it";
    first.release();
    EXPECT_EQ(refusal(archive, {}), "");
    EXPECT_TRUE(read_leases(archive).empty());
}

TEST(Lease, LeaseOfADeadProcessIsTakenOverAtOnce) {
    const fs::path archive = fresh_archive();
    die_with_lease(archive, {});
    ASSERT_EQ(read_leases(archive).size(), 1U);
    EXPECT_FALSE(read_leases(archive).front().alive);
    Lease lease(archive, {});
    EXPECT_NE(lease.taken_over().find("expired"), std::string::npos) << lease.taken_over();
    EXPECT_TRUE(lease.beat());
}

TEST(Lease, ProcessThatEndedAndIsNotYetReapedIsDead) {
    const fs::path archive = fresh_archive();
    const pid_t child = ::fork();
    if (child == 0) {
        new Lease(archive, {});
        ::_exit(0);
    }
    siginfo_t ended{};
    ASSERT_EQ(::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT), 0);
    EXPECT_EQ(refusal(archive, {}), "");
    int status = 0;
    ::waitpid(child, &status, 0);
}

TEST(Lease, LeaseOfAnotherMachineHoldsUntilItExpires) {
    const fs::path archive = fresh_archive();
    write_foreign(archive, "1-of-1", static_cast<int>(kLeaseExpirySeconds) / 2);
    const std::string sentence = refusal(archive, {});
    EXPECT_NE(sentence.find("process 4711 on elsewhere since 2026-01-31 12:00:00 UTC"), std::string::npos) << sentence;
    write_foreign(archive, "1-of-1", static_cast<int>(kLeaseExpirySeconds) + 5);
    const Lease lease(archive, {});
    EXPECT_NE(lease.taken_over().find("elsewhere"), std::string::npos);
}

TEST(Lease, ShardsOfOneCountStandSideBySideAndOthersAreExcluded) {
    const fs::path archive = fresh_archive();
    const Lease second(archive, {2, 3});
    const Lease first(archive, {1, 3});
    EXPECT_EQ(read_leases(archive).size(), 2U);
    EXPECT_NE(refusal(archive, {1, 3}).find("shard 1/3"), std::string::npos);
    EXPECT_NE(refusal(archive, {3, 4}), "") << "shards of another count share models with these";
    EXPECT_NE(refusal(archive, {}), "");
    EXPECT_EQ(refusal(archive, {3, 3}), "");
}

TEST(Lease, HolderNoticesThatItsLeaseWasTakenAway) {
    const fs::path archive = fresh_archive();
    Lease lost(archive, {});
    fs::remove(lease_file(archive, "1-of-1"));
    EXPECT_FALSE(lost.beat());
    Lease other(archive, {});
    EXPECT_FALSE(lost.beat());
    lost.release();
    EXPECT_TRUE(other.beat()) << "the loser leaves the other's lease alone";
}

TEST(Lease, LeaseNamesItsHolderFromTheMomentItStands) {
    const fs::path archive = fresh_archive();
    // What one leaves that was killed before it had a lease.
    fs::create_directories(archive / "runs");
    std::ofstream(archive / "runs" / "1-of-1.lease.new") << "host=";
    EXPECT_TRUE(read_leases(archive).empty());
    const Lease lease(archive, {});
    EXPECT_EQ(read_leases(archive).at(0).process, ::getpid());
    EXPECT_FALSE(fs::exists(archive / "runs" / "1-of-1.lease.new"));
}

TEST(Lease, BeatRenewsTheSignOfLife) {
    const fs::path archive = fresh_archive();
    Lease lease(archive, {});
    fs::last_write_time(lease_file(archive, "1-of-1"), fs::file_time_type::clock::now() - std::chrono::seconds(60));
    EXPECT_GT(read_leases(archive).at(0).heartbeat_age, 30);
    EXPECT_TRUE(lease.beat());
    EXPECT_LT(read_leases(archive).at(0).heartbeat_age, 30);
}

TEST(Lease, FoldersOfOtherThingsAreNoLeases) {
    const fs::path archive = fresh_archive();
    fs::create_directories(archive / "runs");
    for (const char* name : {"1-of-1", "01-of-1.lease", "x-of-1.lease", "1-of-.lease", "guard"})
        std::ofstream(archive / "runs" / name) << "x";
    EXPECT_TRUE(read_leases(archive).empty());
    EXPECT_TRUE(read_leases(archive / "nowhere").empty());
}

}  // namespace
}  // namespace lumenline
