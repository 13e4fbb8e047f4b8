// Threads against processes. run_models computes a cohort of equal models on k threads of this
// process; then, in the same iteration, k processes of one thread each compute the same models
// between them. Processes share nothing but the machine: what they reach is what it gives at that
// moment, so their ratio tells what our scheduler and allocator lose. Workers are started once, read
// their models, and wait for a byte; reading is not timed.
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/inputs.h"
#include "bench/measure.h"
#include "engine/schedule/run_models.h"

namespace lumenline::bench {

namespace {

double wall_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Models first, first + step, ... of `count` jittered copies of an input.
class Cohort {
public:
    Cohort(const Input& input, int first, int step, int count) {
        for (int i = first; i < count; i += step) {
            ModelTask task;
            task.identity.id = std::to_string(i);
            task.surface_path = std::to_string(soups_.size());
            task.options = input.options;
            tasks_.push_back(task);
            soups_.push_back(jittered(input.soup, static_cast<std::uint64_t>(i + 1)));
        }
    }

    /// Seconds that run_models takes on so many threads.
    /// @throws std::runtime_error when a model has no lines
    [[nodiscard]] double run(int threads) const {
        ScheduleOptions options;
        options.threads = threads;
        std::size_t good = 0;
        const double start = wall_seconds();
        run_models(
            tasks_, options, [this](const ModelTask& task) { return soups_[std::stoul(task.surface_path)]; },
            [&](ModelRecord&& record) { good += record.centerlines && record.centerlines->line_count() > 0 ? 1 : 0; });
        const double seconds = wall_seconds() - start;
        if (good != tasks_.size()) throw std::runtime_error("a model of the cohort has no lines");
        return seconds;
    }

private:
    std::vector<ModelTask> tasks_;
    std::vector<TriangleSoup> soups_;
};

/// This program as a worker in a process of its own.
class Worker {
public:
    explicit Worker(const std::vector<std::string>& arguments) {
        int to[2], from[2];
        if (pipe2(to, O_CLOEXEC) != 0 || pipe2(from, O_CLOEXEC) != 0) throw std::runtime_error("pipe failed");
        process_ = fork();
        if (process_ < 0) throw std::runtime_error("fork failed");
        if (process_ == 0) {
            dup2(to[0], STDIN_FILENO);
            dup2(from[1], STDOUT_FILENO);
            std::vector<char*> argv;
            for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
            argv.push_back(nullptr);
            execv("/proc/self/exe", argv.data());
            _exit(127);
        }
        close(to[0]);
        close(from[1]);
        go_ = to[1];
        done_ = from[0];
        wait();
    }
    ~Worker() {
        close(go_);
        close(done_);
        waitpid(process_, nullptr, 0);
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    void start() const {
        if (write(go_, "g", 1) != 1) throw std::runtime_error("a worker process died");
    }
    void wait() const {
        char byte = 0;
        if (read(done_, &byte, 1) != 1) throw std::runtime_error("a worker process died");
    }

private:
    pid_t process_ = -1;
    int go_ = -1, done_ = -1;
};

/// Body of a worker: "--worker" input first step count.
int run_worker(char** argv) {
    const Cohort cohort(find_input(argv[2]), std::atoi(argv[3]), std::atoi(argv[4]), std::atoi(argv[5]));
    char byte = 'r';
    while (write(STDOUT_FILENO, &byte, 1) == 1 && read(STDIN_FILENO, &byte, 1) == 1) static_cast<void>(cohort.run(1));
    return 0;
}

double run_workers(const std::vector<std::unique_ptr<Worker>>& workers) {
    const double start = wall_seconds();
    for (const auto& worker : workers) worker->start();
    for (const auto& worker : workers) worker->wait();
    return wall_seconds() - start;
}

void compare(benchmark::State& state, const std::string& name, const Cohort& cohort, int count) {
    const int threads = static_cast<int>(state.range(0));
    std::vector<std::unique_ptr<Worker>> workers;
    for (int w = 0; w < threads; ++w)
        workers.push_back(std::make_unique<Worker>(std::vector<std::string>{
            "bench_cohort", "--worker", name, std::to_string(w), std::to_string(threads), std::to_string(count)}));
    static_cast<void>(cohort.run(threads));
    run_workers(workers);
    std::vector<double> inside, outside, ratio;
    for ([[maybe_unused]] auto iteration : state) {
        const bool threads_first = inside.size() % 2 == 0;
        const double before = threads_first ? 0 : run_workers(workers);
        inside.push_back(cohort.run(threads));
        outside.push_back(threads_first ? run_workers(workers) : before);
        ratio.push_back(outside.back() / inside.back());
        state.SetIterationTime(inside.back());
    }
    state.counters["models"] = count;
    state.counters["models_per_s"] = count / median(inside);
    state.counters["processes_models_per_s"] = count / median(outside);
    state.counters["efficiency"] = median(ratio);
    state.counters["e_least"] = *std::min_element(ratio.begin(), ratio.end());
    state.counters["e_most"] = *std::max_element(ratio.begin(), ratio.end());
}

int model_count() {
    const char* text = std::getenv("LUMENLINE_BENCH_MODELS");
    const int count = text == nullptr ? 12 : std::atoi(text);
    if (count < 1) throw std::runtime_error("LUMENLINE_BENCH_MODELS must be a number above 0");
    return count;
}

void register_input(const std::string& name) {
    const Input input = find_input(name);
    const int count = model_count();
    const auto cohort = std::make_shared<const Cohort>(input, 0, 1, count);
    benchmark::RegisterBenchmark((input.name + "/threads").c_str(),
                                 [name, cohort, count](benchmark::State& state) {
                                     try {
                                         compare(state, name, *cohort, count);
                                     } catch (const std::exception& error) {
                                         state.SkipWithError(error.what());
                                     }
                                 })
        ->DenseRange(1, available_threads())
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond)
        ->Iterations(input.soup.points.size() < 100000 ? 7 : 3);
}

}  // namespace

}  // namespace lumenline::bench

/// Arguments that are no option of Google Benchmark name inputs: known ones, or surface files.
int main(int argc, char** argv) {
    namespace bench = lumenline::bench;
    try {
        if (argc == 6 && std::string(argv[1]) == "--worker") return bench::run_worker(argv);
        std::signal(SIGPIPE, SIG_IGN);  // a worker that died is an error of its benchmark
        benchmark::Initialize(&argc, argv);
        std::vector<std::string> names(argv + 1, argv + argc);
        if (names.empty())
            names = std::getenv("LUMENLINE_BENCH_SURFACE") != nullptr ? bench::default_inputs()
                                                                      : std::vector<std::string>{"cylinder_12k"};
        for (const std::string& name : names) bench::register_input(name);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_cohort: %s\n", error.what());
        return 2;
    }
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
