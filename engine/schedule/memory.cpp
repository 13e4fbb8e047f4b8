#include "engine/schedule/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace lumenline {

namespace {

/// Lowers `bytes` to the number in a file, if it holds one.
void lower_to(const std::string& file, double& bytes) {
    std::ifstream in(file);
    double limit = 0;
    if (in >> limit && limit > 0) bytes = std::min(bytes, limit);
}

/// Limits of the control group and of those around it, version 2.
void lower_to_groups(double& bytes) {
    std::ifstream groups("/proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {
        if (!line.starts_with("0::/")) continue;
        for (std::string group = line.substr(3); !group.empty(); group.erase(group.rfind('/')))
            lower_to("/sys/fs/cgroup" + group + "/memory.max", bytes);
    }
    lower_to("/sys/fs/cgroup/memory.max", bytes);
    lower_to("/sys/fs/cgroup/memory/memory.limit_in_bytes", bytes);  // version 1
}

}  // namespace

double available_memory() {
    double bytes = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
    lower_to_groups(bytes);
    for (const auto resource : {RLIMIT_AS, RLIMIT_DATA}) {
        rlimit limit{};
        if (::getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
            bytes = std::min(bytes, static_cast<double>(limit.rlim_cur));
    }
    return bytes;
}

double estimated_memory(double sites) {
    constexpr double kFixed = 4e6, kPerSite = 3500;
    return kFixed + kPerSite * sites;
}

double estimated_seconds(double sites) {
    constexpr double kFixed = 0.05, kPerSite = 100e-6;
    return kFixed + kPerSite * sites;
}

double estimated_file_bytes(double sites, bool float32_fields) {
    constexpr double kFixed = 60e3, kPerSite = 930, kMoreInDouble = 60;
    return kFixed + (kPerSite + (float32_fields ? 0 : kMoreInDouble)) * sites;
}

}  // namespace lumenline
