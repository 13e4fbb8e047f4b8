// Ten thousand small models in one run: what a run holds must not grow with the models it has done. Speed is printed
// and judged by people, since it is the machine's as much as ours.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

#include "tests/cli/cohort_support.h"

namespace lumenline::cli_test {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kModels = 10000;

/// Rows of one table that use four surfaces again and again, with as little work in each as there can be.
fs::path many_models() {
    const fs::path folder = fresh_folder();
    const std::vector<std::vector<std::string>> shapes{{"cylinder", "--b", "4", "--length", "40"},
                                                       {"torus", "--turns", "0.3"},
                                                       {"helix", "--turns", "0.3"},
                                                       {"stenosis", "--length", "45"}};
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        std::vector<std::string> arguments{"phantom"};
        arguments.insert(arguments.end(), shapes[i].begin(), shapes[i].end());
        arguments.insert(arguments.end(),
                         {"--points-around", "8", "--jitter", "0.2", "-o", "s" + std::to_string(i) + ".ply"});
        EXPECT_EQ(run_lumenline(arguments, folder).status, 0);
    }
    std::string table = "id\tsurface\tage\n";
    for (std::size_t i = 0; i < kModels; ++i)
        table += "m" + std::to_string(i) + "\ts" + std::to_string(i % shapes.size()) + ".ply\t" +
                 std::to_string(20 + i % 70) + "\n";
    write_text(folder / "models.tsv", table);
    write_text(folder / "cohort.yaml",
               "cohort: soak\nmodels: {table: models.tsv}\ncharacterize: false\ncenterlines: {refine: none}\n"
               "condition: {extension_radii: 0, check_self_intersections: false, refine_undersampled: false}\n");
    return folder;
}

struct Sample {
    std::size_t models = 0;
    double resident = 0;  ///< [bytes]
    std::size_t handles = 0;
};

Sample sample_of(const Process& run, const fs::path& archive) {
    Sample sample;
    std::error_code gone;
    for (const auto& entry : fs::directory_iterator(archive / "models", gone))
        sample.models += entry.path().extension() == ".hdf" ? 1 : 0;
    const fs::path process = "/proc/" + std::to_string(run.id());
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(process / "fd", gone)) ++sample.handles;
    std::ifstream in(process / "status");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("VmRSS:")) sample.resident = 1024 * std::stod(line.substr(6));
    return sample;
}

/// Seconds that a command takes, which must succeed.
double seconds_of(const fs::path& folder, const std::vector<std::string>& arguments) {
    const auto start = std::chrono::steady_clock::now();
    const Finished run = run_lumenline(arguments, folder);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_EQ(run.status, 0) << run.err;
    std::printf("%s %s: %.2f s\n", arguments[0].c_str(), arguments.back().c_str(), seconds);
    return seconds;
}

TEST(SoakLong, TenThousandModelsInOneRunTakeNoMoreThanFiveHundred) {
    const fs::path folder = many_models();
    constexpr std::size_t kFirst = 500, kEarly = 2000;
    Process run({LUMENLINE_BINARY, "run", "cohort.yaml", "--threads", "2"}, folder);
    Sample early, late;
    while (run.running()) {
        const Sample now = sample_of(run, folder / "results");
        Sample& most = now.models < kEarly ? early : late;
        // When all files stand, the index is made, which needs the memory of ten thousand rows for a moment.
        if (now.models >= kFirst && now.models < kModels && now.resident > 0) {
            most.models = now.models;
            most.resident = std::max(most.resident, now.resident);
            most.handles = std::max(most.handles, now.handles);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    const Finished ended = run.wait();
    ASSERT_EQ(ended.status, 0) << ended.err;
    ASSERT_GT(early.models, 0U) << "no sample was taken in time";
    ASSERT_GT(late.models, kEarly);
    std::printf("resident: %.1f MB up to %zu models, %.1f MB up to %zu; handles: %zu, then %zu\n", early.resident / 1e6,
                early.models, late.resident / 1e6, late.models, early.handles, late.handles);
    // Of each model its row of the index is kept, less than a kilobyte of text and numbers; 8 MB are what the allocator
    // may keep back in one place while it works in another.
    EXPECT_LT(late.resident - early.resident, 8e6 + 1e3 * static_cast<double>(kModels - kFirst));
    // Of the files that are open for a moment at most one a thread is read and one is written.
    EXPECT_LE(late.handles, early.handles + 3);

    seconds_of(folder, {"status", "cohort.yaml"});
    seconds_of(folder, {"browse", "results", "list"});
    seconds_of(folder, {"merge", "cohort.yaml"});
    EXPECT_EQ(lines_of(run_lumenline({"browse", "results", "list"}, folder).out).size(), kModels + 1);
    fs::remove_all(folder);
}

}  // namespace
}  // namespace lumenline::cli_test
