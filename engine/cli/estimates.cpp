#include "engine/cli/estimates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/text.h"
#include "engine/schedule/memory.h"
#include "io/mesh/estimate.h"

namespace lumenline {

Estimates::Estimates(std::span<const ModelTask* const> tasks) {
    for (const ModelTask* task : tasks) sites_[task->identity.id] = estimate_surface(task->surface_path).sites;
}

std::vector<const ModelTask*> Estimates::longest_first(std::span<const ModelTask* const> tasks) const {
    std::vector<const ModelTask*> sorted(tasks.begin(), tasks.end());
    std::ranges::stable_sort(sorted, [this](const ModelTask* a, const ModelTask* b) { return sites(*a) > sites(*b); });
    return sorted;
}

Estimates::Total Estimates::total(std::span<const ModelTask* const> tasks, const ArchiveOptions& archive) const {
    Total sum;
    for (const ModelTask* task : tasks) {
        const double n = sites(*task);
        sum.seconds += estimated_seconds(n);
        sum.file_bytes += estimated_file_bytes(n, archive);
        sum.largest_bytes = std::max(sum.largest_bytes, estimated_memory(n));
    }
    return sum;
}

double memory_budget(const RunOptions& run) {
    return run.memory_bytes > 0 ? run.memory_bytes : run.memory_percent / 100 * available_memory();
}

std::string estimate_text(const CohortConfig& config, std::span<const ModelTask* const> tasks, int threads) {
    const Estimates estimates(tasks);
    const Estimates::Total total = estimates.total(tasks, config.archive.options);
    const auto with = [&](ArchiveFields fields) {
        ArchiveOptions options = config.archive.options;
        options.fields = fields;
        return size_text(estimates.total(tasks, options).file_bytes);
    };
    std::string less;
    if (config.archive.options.fields == ArchiveFields::kAll)
        less = fmt::format(" ({} with archive.fields: surface, {} with lines)", with(ArchiveFields::kSurface),
                           with(ArchiveFields::kLines));
    return fmt::format("about {} on {}, {} on disk{}; the largest model needs {} of {} of memory",
                       duration_text(total.seconds / threads), counted(static_cast<std::size_t>(threads), "thread"),
                       size_text(total.file_bytes), less, size_text(total.largest_bytes),
                       size_text(memory_budget(config.run)));
}

std::string duration_text(double seconds) {
    const auto whole = static_cast<long>(std::ceil(seconds));
    return whole >= 3600 ? fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
                         : fmt::format("{}:{:02}", whole / 60, whole % 60);
}

std::string size_text(double bytes) {
    if (bytes >= 1e12) return fmt::format("{:.1f} TB", bytes / 1e12);
    if (bytes >= 1e9) return fmt::format("{:.1f} GB", bytes / 1e9);
    return fmt::format("{:.0f} MB", std::ceil(bytes / 1e6));
}

}  // namespace lumenline
