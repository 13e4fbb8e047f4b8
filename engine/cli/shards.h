#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/core/options.h"
#include "io/archive/lease.h"

namespace lumenline {

/// Shard of each model, 1 to `count`: longest first, each to the shard that has least to do, the first of those that
/// are equal. Depends on the costs and their order alone.
std::vector<int> assign_shards(std::span<const double> costs, int count);

/// "2/5" as a shard. @throws CLI::ValidationError
Shard parse_shard(const std::string& text);

/// The models of a shard, as `shards.tsv` in the archive says. If that file is not there, or is of another number of
/// shards or other models, it is made from the sizes of the surfaces; then it stands, whatever becomes of them, so that
/// shards that start later share none with those before.
/// @throws std::runtime_error if it cannot be written
std::vector<const ModelTask*> tasks_of_shard(const std::filesystem::path& archive_dir, std::span<const ModelTask> tasks,
                                             Shard shard);

}  // namespace lumenline
