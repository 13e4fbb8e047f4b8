// What the engine adds to the stages, each question in a run of its own, so that peaks of memory do not mix:
//
//   overhead  what share of a thread's time goes to anything but stages and the writing of files
//   tail      what share of a run's time some core had nothing to do, on models whose costs span 1:100
//   memory    the peak of resident memory beside the budget of the admission
//   writer    bytes a second that reach the disk, with nothing computed; and how many cores' models that takes
//
// Work on models is what the records say of their stages. A run with T threads offers T times its length; what the
// stages leave of that is overhead where there is always work, and idle time at the end.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/inputs.h"
#include "engine/schedule/memory.h"
#include "engine/schedule/run_models.h"
#include "io/archive/model_file.h"

namespace lumenline::bench {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

TriangleSoup tube(int points_around, std::uint64_t seed) {
    PhantomOptions options;
    options.a = 5;
    options.b = 3;
    options.points_around = points_around;
    options.jitter = 0.2;
    options.rotate = true;
    options.seed = seed;
    return to_soup(make_phantom(options));
}

/// Models whose number of sites goes from `least` to `most` in equal ratios, largest first.
struct Cohort {
    std::vector<ModelTask> tasks;
    std::map<std::string, TriangleSoup> soups;

    void add(int points_around) {
        ModelTask task;
        task.identity.id = "m" + std::to_string(tasks.size());
        soups[task.identity.id] = tube(points_around, tasks.size() + 1);
        tasks.push_back(task);
    }
    [[nodiscard]] Loader loader() const {
        return [this](const ModelTask& task) { return soups.at(task.identity.id); };
    }
    [[nodiscard]] double sites(const ModelTask& task) const {
        return static_cast<double>(soups.at(task.identity.id).points.size());
    }
};

struct Measured {
    RunReport report;
    double busy = 0;             ///< in stages, all threads together [s]
    double least = 0, most = 0;  ///< of a model [s]
};

Measured run(const Cohort& cohort, ScheduleOptions options) {
    Measured measured;
    measured.least = 1e300;
    measured.report = run_models(cohort.tasks, options, cohort.loader(), [&](ModelRecord&& record) {
        if (record.failure) throw std::runtime_error("a model failed: " + record.failure->sentence);
        measured.busy += record.facts.total_seconds;
        measured.least = std::min(measured.least, record.facts.total_seconds);
        measured.most = std::max(measured.most, record.facts.total_seconds);
    });
    return measured;
}

void overhead() {
    Cohort cohort;
    for (int i = 0; i < 60; ++i) cohort.add(20);
    ScheduleOptions options;
    options.threads = 1;
    run(cohort, options);
    for (int repeat = 0; repeat < 3; ++repeat) {
        const Measured m = run(cohort, options);
        std::printf("overhead: %.2f %% of %.2f s, 60 models of %.0f sites, 1 thread\n",
                    100 * (1 - m.busy / m.report.seconds), m.report.seconds, cohort.sites(cohort.tasks.front()));
    }
}

void tail() {
    Cohort cohort;
    constexpr int kModels = 40;
    // Sites grow as the square of the points around.
    for (int i = 0; i < kModels; ++i)
        cohort.add(static_cast<int>(std::lround(130 * std::pow(0.1, static_cast<double>(i) / (kModels - 1)))));
    for (int repeat = 0; repeat < 3; ++repeat) {
        ScheduleOptions options;
        const Measured m = run(cohort, options);
        const double idle = m.report.threads * m.report.seconds - m.busy;
        std::printf("tail: %.2f core-seconds idle or lost of %d x %.2f s (%.2f %%); costs %.3f to %.2f s\n", idle,
                    m.report.threads, m.report.seconds, 100 * idle / m.report.seconds / m.report.threads, m.least,
                    m.most);
    }
}

void memory() {
    Cohort cohort;
    for (int i = 0; i < 12; ++i) cohort.add(110);
    const double baseline = peak_resident_bytes();
    ScheduleOptions options;
    options.models_in_flight = 8;
    options.memory_of = [&](const ModelTask& task) { return estimated_memory(cohort.sites(task)); };
    options.refined_memory_of = estimated_memory;
    options.memory = 3.5 * options.memory_of(cohort.tasks.front());
    run(cohort, options);
    const double used = peak_resident_bytes() - baseline;
    std::printf(
        "memory: peak %.0f MB for a budget of %.0f MB (%.2f); 12 models of %.0f sites, estimated %.0f MB each\n",
        used / 1e6, options.memory / 1e6, used / options.memory, cohort.sites(cohort.tasks.front()),
        options.memory_of(cohort.tasks.front()) / 1e6);
}

void writer(const fs::path& folder) {
    for (const int points_around : {20, 64, 130}) {
        Cohort cohort;
        cohort.add(points_around);
        ModelRecord record;
        ScheduleOptions options;
        options.threads = 1;
        run_models(cohort.tasks, options, cohort.loader(), [&](ModelRecord&& made) { record = std::move(made); });
        constexpr int kFiles = 20;
        const fs::path file = folder / "bench.hdf";
        const auto start = Clock::now();
        for (int i = 0; i < kFiles; ++i) write_model_file(file, record);
        const double seconds = seconds_since(start) / kFiles;
        const auto bytes = static_cast<double>(fs::file_size(file));
        fs::remove(file);
        std::printf(
            "writer: %.0f MB/s, %.1f ms a file of %.2f MB (%zu sites), which one core computes in %.2f s: "
            "takes the output of %.0f cores\n",
            bytes / seconds / 1e6, 1e3 * seconds, bytes / 1e6, record.surface->site_count(), record.facts.total_seconds,
            record.facts.total_seconds / seconds);
    }
}

}  // namespace

}  // namespace lumenline::bench

int main(int argc, char** argv) {
    namespace bench = lumenline::bench;
    const std::string what = argc > 1 ? argv[1] : "";
    try {
        if (what == "overhead")
            bench::overhead();
        else if (what == "tail")
            bench::tail();
        else if (what == "memory")
            bench::memory();
        else if (what == "writer" && argc == 3)
            bench::writer(argv[2]);
        else
            throw std::runtime_error("usage: bench_engine overhead | tail | memory | writer FOLDER");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_engine: %s\n", error.what());
        return 2;
    }
    return 0;
}
