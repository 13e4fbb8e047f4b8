#include "engine/schedule/memory.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

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

constexpr double kKilobyte = 1024;

/// A line of /proc/self/status; 0 if there is none.
double status_bytes(std::string_view name) {
    std::ifstream in("/proc/self/status");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with(name)) return kKilobyte * std::strtod(line.c_str() + name.size(), nullptr);
    return 0;
}

/// The memory that Slurm has given this job on this node, where it says so.
void lower_to_job(double& bytes) {
    constexpr double kMegabyte = 1024 * kKilobyte;
    const auto number = [](const char* name) {
        const char* const text = std::getenv(name);
        return text == nullptr ? 0 : std::strtod(text, nullptr);
    };
    const double of_node = number("SLURM_MEM_PER_NODE"),
                 of_processors = number("SLURM_MEM_PER_CPU") * number("SLURM_CPUS_ON_NODE");
    for (const double megabytes : {of_node, of_processors})
        if (megabytes > 0) bytes = std::min(bytes, megabytes * kMegabyte);
}

}  // namespace

double available_memory() {
    double bytes = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
    lower_to_groups(bytes);
    lower_to_job(bytes);
    for (const auto resource : {RLIMIT_AS, RLIMIT_DATA}) {
        rlimit limit{};
        if (::getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
            bytes = std::min(bytes, static_cast<double>(limit.rlim_cur));
    }
    return bytes;
}

double peak_resident_bytes() {
    if (const double peak = status_bytes("VmHWM:"); peak > 0) return peak;
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) * kKilobyte;
}

void forget_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

void give_back_free_memory() { ::malloc_trim(0); }

bool limit_memory(double bytes) {
    // Of data rather than of address space: that is what is really asked for, without the ranges that allocators
    // reserve and the files that are mapped.
    const double now = status_bytes("VmData:");
    rlimit limit{};
    if (now <= 0 || ::getrlimit(RLIMIT_DATA, &limit) != 0) return false;
    limit.rlim_cur = std::min(limit.rlim_max, static_cast<rlim_t>(now + bytes));
    return ::setrlimit(RLIMIT_DATA, &limit) == 0;
}

double estimated_memory(double sites) {
    constexpr double kFixed = 4e6, kPerSite = 3500;
    return kFixed + kPerSite * sites;
}

double estimated_seconds(double sites) {
    constexpr double kFixed = 0.05, kPerSite = 100e-6;
    return kFixed + kPerSite * sites;
}

double estimated_file_bytes(double sites, const ArchiveOptions& archive) {
    constexpr double kFixed = 60e3, kLines = 70, kSurface = 270, kVoronoi = 210;
    constexpr double kMoreSurface = 35, kMoreVoronoi = 30;  // in double precision
    double per_site = kLines;
    if (archive.fields != ArchiveFields::kLines) per_site += kSurface + (archive.float32_fields ? 0 : kMoreSurface);
    if (archive.fields == ArchiveFields::kAll) per_site += kVoronoi + (archive.float32_fields ? 0 : kMoreVoronoi);
    return kFixed + per_site * sites;
}

}  // namespace lumenline
