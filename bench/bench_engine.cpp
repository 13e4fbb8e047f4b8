// What the engine adds to the stages, each question in a run of its own, so that peaks of memory do not mix:
//
//   overhead  what share of a thread's time goes to anything but stages and the writing of files
//   tail      what share of a run's time fewer models than threads were left, on models whose costs span 1:100
//   memory    the peak of resident memory beside the budget of the admission
//   writer    bytes a second that reach the disk, with nothing computed; and how many cores' models that takes
//
// Work on models is what the records say of their stages, in time of the clock. What they leave of a run on one thread
// is overhead. On several threads they leave more: a thread that has no model of its own helps with another's loops.

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

TriangleSoup tube(int points_around, double length, std::uint64_t seed) {
    PhantomOptions options;
    options.a = 5;
    options.b = 3;
    options.length = length;
    options.points_around = points_around;
    options.jitter = 0.2;
    options.rotate = true;
    options.seed = seed;
    return to_soup(make_phantom(options));
}

struct Cohort {
    std::vector<ModelTask> tasks;
    std::map<std::string, TriangleSoup> soups;

    void add(int points_around, double length = PhantomOptions().length) {
        ModelTask task;
        task.identity.id = "m" + std::to_string(tasks.size());
        soups[task.identity.id] = tube(points_around, length, tasks.size() + 1);
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
    std::vector<double> ends;    ///< when each model was done, ascending [s]
};

Measured run(const Cohort& cohort, const ScheduleOptions& options) {
    Measured measured;
    measured.least = 1e300;
    const auto start = Clock::now();
    measured.report = run_models(cohort.tasks, options, cohort.loader(), [&](ModelRecord&& record) {
        if (record.failure) throw std::runtime_error("a model failed: " + record.failure->sentence);
        measured.busy += record.facts.total_seconds;
        measured.least = std::min(measured.least, record.facts.total_seconds);
        measured.most = std::max(measured.most, record.facts.total_seconds);
        measured.ends.push_back(seconds_since(start));
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
    // Sites grow as the square of the points around; short models are cheap in lines too.
    for (int i = 0; i < kModels; ++i) {
        const double share = static_cast<double>(i) / (kModels - 1);
        cohort.add(static_cast<int>(std::lround(130 * std::pow(0.1, share))), 60 * std::pow(0.2, share));
    }
    for (int repeat = 0; repeat < 3; ++repeat) {
        const Measured m = run(cohort, {});
        const auto threads = static_cast<std::size_t>(m.report.threads);
        const double last = m.ends.back() - m.ends[m.ends.size() - std::min(threads, m.ends.size())];
        std::printf("tail: %.3f s of %.2f s (%.2f %%) with fewer models than the %zu threads; costs %.3f to %.2f s\n",
                    last, m.report.seconds, 100 * last / m.report.seconds, threads, m.least, m.most);
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
