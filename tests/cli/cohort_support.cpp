// The phantoms are jittered: structured tubes are symmetric, and hide what depends on order.
#include "tests/cli/cohort_support.h"

#include <gtest/gtest.h>

#include <sstream>

namespace lumenline::cli_test {

namespace fs = std::filesystem;

void make_phantom_file(const fs::path& file, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "phantom");
    arguments.insert(arguments.end(), {"--points-around", "16", "--jitter", "0.2", "-o", file.string()});
    const Finished made = run_lumenline(arguments, file.parent_path());
    if (made.status != 0) throw std::runtime_error("cannot make the phantom: " + made.err);
}

fs::path small_cohort() {
    const fs::path folder = fresh_folder();
    make_phantom_file(folder / "tube.ply", {"cylinder", "--b", "4", "--length", "30"});
    make_phantom_file(folder / "bend.ply", {"torus", "--turns", "0.25"});
    make_phantom_file(folder / "coil.ply", {"helix", "--turns", "0.4"});
    make_phantom_file(folder / "narrow.ply", {"stenosis", "--length", "40"});
    write_text(folder / "cohort.yaml",
               "cohort: small\nlength_unit: mm\nmodels:\n"
               "  - {id: tube, surface: tube.ply, group: straight, inlets: [[0, 0, 0]]}\n"
               "  - {id: bend, surface: bend.ply, group: bent, covariates: {age: 63}}\n"
               "  - {id: coil, surface: coil.ply, group: bent}\n"
               "  - {id: narrow, surface: narrow.ply, group: straight}\n");
    return folder;
}

Finished run_cohort(const fs::path& folder, const std::vector<std::string>& arguments) {
    std::vector<std::string> all{"run", "cohort.yaml"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run_lumenline(all, folder);
}

std::vector<double> get_numbers(const fs::path& folder, const std::string& archive, const std::string& id,
                                const std::string& path) {
    const Finished got = run_lumenline({"browse", archive, "get", id, path}, folder);
    EXPECT_EQ(got.status, 0) << got.err;
    std::vector<double> numbers;
    std::istringstream words(got.out);
    for (std::string word; words >> word;) numbers.push_back(std::stod(word));
    return numbers;
}

std::string get_attribute(const fs::path& folder, const std::string& archive, const std::string& id,
                          const std::string& name) {
    const Finished got = run_lumenline({"browse", archive, "get", id, "/@" + name}, folder);
    EXPECT_EQ(got.status, 0) << got.err;
    const auto lines = lines_of(got.out);
    return lines.empty() ? "" : lines.front();
}

std::vector<std::string> temporary_files(const fs::path& folder) {
    std::vector<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".tmp") found.push_back(entry.path().string());
    return found;
}

}  // namespace lumenline::cli_test
