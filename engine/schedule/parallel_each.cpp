#include "engine/schedule/parallel_each.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "engine/schedule/run_models.h"

namespace lumenline {

void parallel_each(int threads, std::size_t count, const std::function<void(std::size_t)>& body) {
    tbb::task_arena arena(threads > 0 ? threads : available_threads());
    arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, body); });
}

}  // namespace lumenline
