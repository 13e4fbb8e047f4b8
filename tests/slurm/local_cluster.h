#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/cli/process.h"

namespace lumenline::cli_test {

/// Slurm with one node, this machine, on loopback: munged, slurmctld and slurmd as children of the test, with all their
/// state in one folder of its own. SLURM_CONF names its configuration while it lives. Arrays have indices up to 4.
class LocalCluster {
public:
    LocalCluster();
    ~LocalCluster();
    LocalCluster(const LocalCluster&) = delete;
    LocalCluster& operator=(const LocalCluster&) = delete;

    /// Why there can be no cluster here; empty = there can.
    static std::string reason_against();

    /// Are there jobs that wait or run? @throws std::runtime_error if one is held, and so will never run
    [[nodiscard]] bool busy() const;

    /// Waits until the node takes jobs. @returns what the daemons said if one of them ended instead
    std::string wait_until_ready();

private:
    std::filesystem::path folder_;
    std::vector<std::unique_ptr<Process>> daemons_;
};

}  // namespace lumenline::cli_test
