#include "engine/cli/lease_wait.h"

#include <fmt/format.h>
#include <poll.h>

#include <cstdio>

#include "engine/cli/model_io.h"

namespace lumenline {

std::unique_ptr<Lease> take_lease(const std::filesystem::path& archive_dir, Shard shard, bool wait) {
    for (bool said = false; !StopOnSignal::flag()->load();) {
        try {
            auto lease = std::make_unique<Lease>(archive_dir, shard);
            if (!lease->taken_over().empty()) fmt::print(stderr, "{}\n", lease->taken_over());
            return lease;
        } catch (const LeaseHeld& held) {
            if (!wait) throw;
            if (!said) fmt::print(stderr, "waiting: {}\n", held.what());
            said = true;
        }
        constexpr int kMilliseconds = 1000;
        ::poll(nullptr, 0, kMilliseconds);
    }
    return nullptr;
}

}  // namespace lumenline
