// The commands that the documents show are run as they stand, in a copy of the examples: in the order of the
// documents, since some read what others wrote.
#include "tests/cli/documents.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/cli/process.h"

namespace lumenline::cli_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDocuments[] = {"README.md",        "examples/README.md", "examples/slurm/README.md",
                                      "config/SCHEMA.md", "io/ARCHIVE.md",      "bench/README.md"};

/// What a reader has who cloned the repository: the examples, without anything that was computed.
fs::path repository_copy() {
    const fs::path root(LUMENLINE_SOURCE_DIR), copy = fresh_folder();
    for (const auto& entry : fs::directory_iterator(root / "examples")) {
        if (entry.path().filename() == "results") continue;
        fs::create_directories(copy / "examples");
        fs::copy(entry.path(), copy / "examples" / entry.path().filename(), fs::copy_options::recursive);
    }
    fs::create_directories(copy / "bench");
    return copy;
}

TEST(Documents, EveryCommandShownRuns) {
    const fs::path root(LUMENLINE_SOURCE_DIR), copy = repository_copy();
    const Finished first = run_lumenline({"run", "examples/cohort.yaml"}, copy);
    ASSERT_EQ(first.status, 0) << first.err;
    std::set<std::string> seen;
    for (const char* document : kDocuments) {
        if (!fs::exists(root / document)) continue;
        for (const DocumentedCommand& command : documented_commands(read_text(root / document))) {
            if (!seen.insert(command.arguments).second) continue;
            const Finished run = run_shell("'" + std::string(LUMENLINE_BINARY) + "' " + command.arguments, copy);
            EXPECT_EQ(run.status, 0) << document << ":" << command.line << ": lumenline " << command.arguments << "\n"
                                     << run.err;
        }
    }
    EXPECT_GE(seen.size(), 5U) << "the phantoms of examples/README.md alone are five commands";
}

TEST(Documents, ReadmesShowCommands) {
    for (const char* document : {"README.md", "examples/README.md"}) {
        const fs::path file = fs::path(LUMENLINE_SOURCE_DIR) / document;
        ASSERT_TRUE(fs::exists(file)) << document;
        EXPECT_FALSE(documented_commands(read_text(file)).empty()) << document;
    }
}

TEST(Documents, ExtractorFindsOurCommandsOnly) {
    const auto commands = documented_commands(
        "lumenline not in a block\n"
        "```sh\n"
        "# lumenline in a comment\n"
        "lumenline run a.yaml --threads 2\n"
        "build/release/lumenline browse results | head\n"
        "bash examples/quickstart.sh\n"
        "cmake --preset release\n"
        "lumenlines\n"
        "lumenline model a.ply \\\n"
        "    -o a.hdf\n"
        "```\n"
        "~~~console\n"
        "$ lumenline --version\n"
        "lumenline 0.1.0\n"
        "~~~\n"
        "```\n"
        "lumenline run COHORT.yaml\n"
        "```\n"
        "````text\n"
        "```sh\n"
        "lumenline within another block\n"
        "```\n"
        "````\n");
    ASSERT_EQ(commands.size(), 4U);
    EXPECT_EQ(commands[0].arguments, "run a.yaml --threads 2");
    EXPECT_EQ(commands[0].line, 4U);
    EXPECT_EQ(commands[1].arguments, "browse results | head");
    EXPECT_EQ(commands[2].arguments, "model a.ply -o a.hdf");
    EXPECT_EQ(commands[2].line, 9U);
    EXPECT_EQ(commands[3].arguments, "--version");
}

TEST(Documents, CommandThatFailsIsSeen) {
    const fs::path copy = fresh_folder();
    const std::string binary = "'" + std::string(LUMENLINE_BINARY) + "' ";
    EXPECT_EQ(run_shell(binary + "frobnicate", copy).status, 2);
    EXPECT_EQ(run_shell(binary + "browse absent | head", copy).status, 2) << "through a pipe too";
}

}  // namespace
}  // namespace lumenline::cli_test
