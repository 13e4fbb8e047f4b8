#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "config/cohort.h"

namespace lumenline {

/// What models are estimated to take. For order, admission and people; never a part of a result.
class Estimates {
public:
    /// Looks at the surfaces' files.
    explicit Estimates(std::span<const ModelTask* const> tasks);

    [[nodiscard]] double sites(const ModelTask& task) const { return sites_.at(task.identity.id); }

    /// The tasks, longest first; those of equal cost in the order given.
    [[nodiscard]] std::vector<const ModelTask*> longest_first(std::span<const ModelTask* const> tasks) const;

    /// Sums over `tasks`.
    struct Total {
        double seconds = 0;        ///< of work, in one thread
        double file_bytes = 0;     ///< in the archive
        double largest_bytes = 0;  ///< memory of the model that needs most
    };
    [[nodiscard]] Total total(std::span<const ModelTask* const> tasks, const ArchiveOptions& archive) const;

private:
    std::map<std::string, double> sites_;
};

/// Bytes that the models in flight may take together.
double memory_budget(const RunOptions& run);

/// What computing `tasks` may take on so many threads: time, disk and what archive.fields would save of it, memory. A
/// sentence without a full stop.
std::string estimate_text(const CohortConfig& config, std::span<const ModelTask* const> tasks, int threads);

std::string duration_text(double seconds);  ///< "2:05" minutes, "1:02:05" hours
std::string size_text(double bytes);        ///< "12.3 GB"

}  // namespace lumenline
