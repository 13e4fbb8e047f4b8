#pragma once

#include <memory>

#include "io/archive/lease.h"

namespace lumenline {

/// Takes a lease, and says on standard error if it was that of a dead run.
/// @param wait  while another run holds it, try again every second until StopOnSignal's flag is set
/// @returns null if it was stopped while it waited
/// @throws LeaseHeld unless `wait`; std::system_error if the archive cannot be written
std::unique_ptr<Lease> take_lease(const std::filesystem::path& archive_dir, Shard shard, bool wait);

}  // namespace lumenline
