// The loader is the command line's in miniature: read, then scale.
#include "tests/examples/example_models.h"

#include <stdexcept>

#include "config/cohort.h"
#include "engine/schedule/model_job.h"
#include "io/mesh/mesh_io.h"

namespace lumenline::examples {

std::filesystem::path folder() { return std::filesystem::path(LUMENLINE_SOURCE_DIR) / "examples"; }

std::vector<ModelTask> example_tasks() { return load_cohort(folder() / "cohort.yaml").tasks; }

ModelRecord compute(const ModelTask& task) {
    return process_model(task, [](const ModelTask& t) {
        TriangleSoup soup = read_surface(t.surface_path);
        for (Vec3& p : soup.points) p = t.scale * p;
        soup.coordinate_rounding *= t.scale;
        return soup;
    });
}

ModelRecord compute(const std::string& id) {
    for (const ModelTask& task : example_tasks())
        if (task.identity.id == id) return compute(task);
    throw std::runtime_error("no example " + id);
}

}  // namespace lumenline::examples
