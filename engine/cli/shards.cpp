// Two shards that start at once both find no file, and both make one: from the same sizes the same. Should a surface
// change in between, a link decides: it is made by one alone, and the other reads what stands.

#include "engine/cli/shards.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <system_error>

#include "io/mesh/estimate.h"

namespace lumenline {

namespace {

namespace fs = std::filesystem;
using Assignment = std::map<std::string, int>;  // id -> shard

constexpr const char* kShardFile = "shards.tsv";
constexpr const char* kHeading = "id\tshard\tof";

/// What the file says; empty unless it is of `count` shards and holds these models and no others.
std::optional<Assignment> read_assignment(const fs::path& file, std::span<const ModelTask> tasks, int count) {
    std::ifstream in(file);
    std::string line;
    if (!std::getline(in, line) || line != kHeading) return std::nullopt;
    Assignment shard_of;
    while (std::getline(in, line)) {
        const std::size_t first = line.find('\t'), second = line.find('\t', first + 1);
        int shard = 0, of = 0;
        if (second == std::string::npos) return std::nullopt;
        std::from_chars(line.data() + first + 1, line.data() + second, shard);
        std::from_chars(line.data() + second + 1, line.data() + line.size(), of);
        if (of != count || shard < 1 || shard > count) return std::nullopt;
        shard_of[line.substr(0, first)] = shard;
    }
    const bool all = shard_of.size() == tasks.size() && std::ranges::all_of(tasks, [&](const ModelTask& task) {
                         return shard_of.contains(task.identity.id);
                     });
    return all ? std::optional(std::move(shard_of)) : std::nullopt;
}

void write_assignment(const fs::path& file, std::span<const ModelTask> tasks, int count) {
    std::vector<double> costs;
    for (const ModelTask& task : tasks) costs.push_back(estimate_surface(task.surface_path).sites);
    const std::vector<int> shards = assign_shards(costs, count);
    fs::path temporary = file;
    temporary += fmt::format(".{}.tmp", ::getpid());
    {
        std::ofstream out(temporary);
        out << kHeading << '\n';
        for (std::size_t i = 0; i < tasks.size(); ++i)
            out << tasks[i].identity.id << '\t' << shards[i] << '\t' << count << '\n';
        if (!out.flush()) throw std::runtime_error("cannot write '" + temporary.string() + "'");
    }
    std::error_code ignored;
    fs::remove(file, ignored);
    fs::create_hard_link(temporary, file, ignored);  // fails where another has just made it
    fs::remove(temporary, ignored);
}

}  // namespace

std::vector<int> assign_shards(std::span<const double> costs, int count) {
    std::vector<std::size_t> order(costs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return costs[a] > costs[b]; });
    std::vector<double> loads(static_cast<std::size_t>(count), 0);
    std::vector<std::size_t> models(loads.size(), 0);  // costs of nothing are shared out too
    std::vector<int> shards(costs.size());
    for (const std::size_t i : order) {
        std::size_t least = 0;
        for (std::size_t s = 1; s < loads.size(); ++s)
            if (std::pair(loads[s], models[s]) < std::pair(loads[least], models[least])) least = s;
        loads[least] += costs[i];
        ++models[least];
        shards[i] = static_cast<int>(least) + 1;
    }
    return shards;
}

Shard parse_shard(const std::string& text) {
    Shard shard{0, 0};
    const char* const end = text.data() + text.size();
    const auto index = std::from_chars(text.data(), end, shard.index);
    if (index.ec == std::errc() && index.ptr != end && *index.ptr == '/') {
        const auto count = std::from_chars(index.ptr + 1, end, shard.count);
        constexpr int kMost = 100000;
        if (count.ec == std::errc() && count.ptr == end && shard.index >= 1 && shard.index <= shard.count &&
            shard.count <= kMost)
            return shard;
    }
    throw CLI::ValidationError("--shard", "must be I/N with I from 1 to N, not '" + text + "'");
}

std::vector<const ModelTask*> tasks_of_shard(const fs::path& archive_dir, std::span<const ModelTask> tasks,
                                             Shard shard) {
    const fs::path file = archive_dir / kShardFile;
    std::optional<Assignment> shard_of = read_assignment(file, tasks, shard.count);
    if (!shard_of) {
        write_assignment(file, tasks, shard.count);
        shard_of = read_assignment(file, tasks, shard.count);
    }
    if (!shard_of) throw std::runtime_error("cannot make '" + file.string() + "', which says what each shard computes");
    std::vector<const ModelTask*> chosen;
    for (const ModelTask& task : tasks)
        if (shard_of->at(task.identity.id) == shard.index) chosen.push_back(&task);
    return chosen;
}

}  // namespace lumenline
