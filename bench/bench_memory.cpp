// Peak memory of the stages after conditioning, per site. Each input is measured in a child process
// of its own: the kernel's high-water mark is reset when the surface is conditioned and what the
// conditioning freed has been given back, so that the baseline holds the surface and nothing else.
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/inputs.h"
#include "bench/pipeline.h"

namespace lumenline::bench {

namespace {

/// A field of /proc/self/status, in bytes.
double status_bytes(const std::string& field) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with(field + ":")) return 1024 * std::stod(line.substr(field.size() + 1));
    throw std::runtime_error("/proc/self/status has no " + field);
}

void reset_peak() {
    std::ofstream file("/proc/self/clear_refs");
    if (!(file << 5 << std::flush)) throw std::runtime_error("cannot write /proc/self/clear_refs");
}

void measure(const std::string& name) {
    const double start = status_bytes("VmRSS");
    Input input = find_input(name);
    reset_peak();
    const Surface surface = condition(input);
    const double conditioning = status_bytes("VmHWM") - start;
    input.soup = {};
    malloc_trim(0);
    const double baseline = status_bytes("VmRSS");
    reset_peak();
    const Solved solved = solve(surface, input.options);
    const double peak = status_bytes("VmHWM");
    verify(input, solved);
    const double sites = static_cast<double>(surface.site_count());
    std::printf(
        "%-40s %8.0f sites  peak - baseline %7.1f MB = %5.0f B/site  baseline %5.0f B/site  "
        "conditioning %5.0f B/site  fields %zu\n",
        input.name.c_str(), sites, 1e-6 * (peak - baseline), (peak - baseline) / sites, (baseline - start) / sites,
        conditioning / sites, solved.fields.size());
}

/// Runs `measure` in a child process. @returns whether it succeeded
bool measure_apart(const std::string& name) {
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("fork failed");
    if (child == 0) {
        int status = 0;
        try {
            measure(name);
        } catch (const std::exception& error) {
            std::fprintf(stderr, "bench_memory: %s\n", error.what());
            status = 1;
        }
        std::fflush(nullptr);
        _exit(status);
    }
    int status = 0;
    return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

}  // namespace lumenline::bench

/// Arguments name inputs: known ones, or surface files.
int main(int argc, char** argv) {
    namespace bench = lumenline::bench;
    std::vector<std::string> names(argv + 1, argv + argc);
    if (names.empty()) names = bench::default_inputs();
    bool all = true;
    for (const std::string& name : names) all = bench::measure_apart(name) && all;
    return all ? 0 : 1;
}
