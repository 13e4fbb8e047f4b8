#include "engine/cli/model_io.h"

#include <csignal>

#include "io/archive/names.h"
#include "io/mesh/mesh_io.h"
#include "io/mesh/sha256.h"

namespace lumenline {

namespace {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch it");

void request_stop(int signal) {
    stop_requested = true;
    std::signal(signal, SIG_DFL);
}

}  // namespace

TriangleSoup load_task(const ModelTask& task) {
    // The path depends on where the program is started, and the sentence of a failure is archived.
    TriangleSoup soup = read_surface(task.surface_path, task.identity.source_file);
    if (task.scale != 1) {
        for (Vec3& p : soup.points) p = task.scale * p;
        soup.coordinate_rounding *= task.scale;
    }
    return soup;
}

std::string inputs_digest(const ModelTask& task, const std::string& source_sha256, const ArchiveOptions& archive) {
    return sha256_hex(
        "format=" + std::to_string(names::kFormatVersion) + "\nfields=" + std::string(fields_name(archive.fields)) +
        "\nprecision=" + (archive.float32_fields ? "float32" : "float64") +
        "\nlength_unit=" + task.identity.length_unit + "\ncoordinate_system=" + task.identity.coordinate_system +
        "\nsource=" + source_sha256 + "\n" + canonical_text(task));
}

StopOnSignal::StopOnSignal() {
    stop_requested = false;
    std::signal(SIGINT, request_stop);
    std::signal(SIGTERM, request_stop);
}

StopOnSignal::~StopOnSignal() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

void StopOnSignal::request() { stop_requested = true; }

const std::atomic<bool>* StopOnSignal::flag() { return &stop_requested; }

}  // namespace lumenline
