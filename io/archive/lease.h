#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace lumenline {

/// Part `index` (from 1) of `count` parts of a cohort; 1 of 1 is all of it.
struct Shard {
    int index = 1;
    int count = 1;

    bool operator==(const Shard&) const = default;
};

/// Who holds, or held, a part of an archive.
struct LeaseHolder {
    Shard shard;
    std::string host;
    long process = 0;
    std::string since;         ///< "2026-01-31 12:00:00 UTC"
    double heartbeat_age = 0;  ///< since the last sign of life, by the clock of the file system [s]
    bool alive = true;
};

/// A part of an archive is held by another run. `what()` is one sentence that says by whom.
class LeaseHeld : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The right to write a part of an archive, held by one process at a time: the file
/// `runs/<index>-of-<count>.lease` in the archive, which says who holds it. Parts of the same count
/// may be held side by side; parts of different counts may share models and exclude each other.
///
/// A process on this machine is probed. One on another machine cannot be: it shows that it lives by
/// touching its lease (`beat`), and a lease that was not touched for kLeaseExpirySeconds is taken
/// over. Ages are taken from the file system's clock alone, so that clocks of machines may differ.
class Lease {
public:
    /// @throws LeaseHeld; std::system_error if the archive cannot be written
    Lease(const std::filesystem::path& archive_dir, Shard shard);
    ~Lease();
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;

    /// A sign of life.
    /// @returns false if the lease was taken away: another run writes now
    bool beat();
    /// Gives the part back.
    void release();
    /// One sentence on the dead run whose lease was taken over; empty = there was none.
    [[nodiscard]] const std::string& taken_over() const { return taken_over_; }

private:
    std::filesystem::path file_;
    int descriptor_ = -1;
    std::string taken_over_;
};

inline constexpr double kLeaseExpirySeconds = 120;
inline constexpr double kLeaseBeatSeconds = 10;

/// All leases of an archive, those of dead runs too, by shard. Cost: a small file each.
std::vector<LeaseHolder> read_leases(const std::filesystem::path& archive_dir);

}  // namespace lumenline
