#pragma once

#include <atomic>
#include <string>

#include "engine/core/archive_options.h"
#include "engine/core/model_record.h"
#include "engine/core/options.h"
#include "engine/core/soup.h"

namespace lumenline {

/// Reads the surface of a task and applies its scale.
/// @throws StageError as read_surface
TriangleSoup load_task(const ModelTask& task);

/// SHA-256 of everything that determines a model's file: the surface's bytes, scale, points, options, units and
/// axes, versions of the algorithms and of the format. Covariates, threads and times play no part.
std::string inputs_digest(const ModelTask& task, const std::string& source_sha256, const ArchiveOptions& archive);

/// While it lives, SIGINT and SIGTERM set a flag instead of ending the process; a second one ends it.
class StopOnSignal {
public:
    StopOnSignal();
    ~StopOnSignal();
    StopOnSignal(const StopOnSignal&) = delete;
    StopOnSignal& operator=(const StopOnSignal&) = delete;
    /// Sets the flag, as a signal does.
    static void request();
    [[nodiscard]] static const std::atomic<bool>* flag();
};

}  // namespace lumenline
