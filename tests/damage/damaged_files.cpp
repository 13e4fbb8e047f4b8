// `damaged_files FILE FOLDER`: copies of a model file or index, in each of which one dataset is removed, cut short, of
// another type or not readable. Prints name, dataset and damage of each, for readers that are not programs of ours.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include "io/archive/read.h"
#include "tests/damage/sample_cohort.h"

int main(int argc, char** argv) {
    using namespace lumenline;
    namespace fs = std::filesystem;
    if (argc != 3) return 2;
    try {
        const fs::path file = argv[1], folder = argv[2];
        fs::create_directories(folder);
        int number = 0;
        for (const ArchiveNode& node : ArchiveFile(file).nodes()) {
            if (node.is_group) continue;
            for (const damage::Harm harm : damage::kHarms) {
                const std::string name = std::to_string(number++) + file.extension().string();
                fs::copy_file(file, folder / name, fs::copy_options::overwrite_existing);
                if (damage::harm_dataset(folder / name, node.path, harm))
                    std::printf("%s\t%s\t%s\n", name.c_str(), node.path.c_str(), damage::name_of(harm));
                else
                    fs::remove(folder / name);
            }
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "damaged_files: %s\n", error.what());
        return 1;
    }
}
