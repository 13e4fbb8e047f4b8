// Help, version and everything that is refused before anything is computed.
#include <gtest/gtest.h>

#include "tests/cli/process.h"

namespace lumenline::cli_test {
namespace {

constexpr const char* kVerbs[] = {"run", "status", "merge", "submit", "validate", "model", "browse", "phantom", "validate-archive", "report"};

TEST(Usage, HelpOfEveryVerbGoesToStandardOutput) {
    const Finished whole = run_lumenline({"--help"}, fresh_folder());
    EXPECT_EQ(whole.status, 0);
    EXPECT_EQ(whole.err, "");
    for (const char* verb : kVerbs) {
        EXPECT_NE(whole.out.find(verb), std::string::npos) << verb;
        const Finished help = run_lumenline({verb, "--help"}, fresh_folder());
        EXPECT_EQ(help.status, 0) << verb;
        EXPECT_EQ(help.err, "") << verb;
        EXPECT_NE(help.out.find(std::string("lumenline ") + verb), std::string::npos) << help.out;
    }
    for (const char* part : {"tree", "table"}) {
        const Finished help = run_lumenline({"phantom", part, "--help"}, fresh_folder());
        EXPECT_EQ(help.status, 0) << part;
        EXPECT_NE(help.out.find("Exit status"), std::string::npos) << part;
    }
    for (const char* part : {"list", "show", "tree", "get", "serve", "page"}) {
        const Finished help = run_lumenline({"browse", "archive", part, "--help"}, fresh_folder());
        EXPECT_EQ(help.status, 0) << part;
        EXPECT_NE(help.out.find("Usage"), std::string::npos) << part;
    }
}

TEST(Usage, HelpStatesTheExitStatus) {
    for (const char* verb : {"run", "status", "merge", "submit", "validate", "model", "phantom", "browse", "report",
                             "stats", "export", "pack", "validate-archive"})
        EXPECT_NE(run_lumenline({verb, "--help"}, fresh_folder()).out.find("Exit status"), std::string::npos) << verb;
    EXPECT_NE(run_lumenline({"--help"}, fresh_folder()).out.find("Exit status"), std::string::npos);
}

TEST(Usage, VersionIsOneLine) {
    const Finished version = run_lumenline({"--version"}, fresh_folder());
    EXPECT_EQ(version.status, 0);
    EXPECT_EQ(version.err, "");
    ASSERT_EQ(lines_of(version.out).size(), 1U);
    EXPECT_EQ(version.out.rfind("lumenline ", 0), 0U) << version.out;
}

struct Refusal {
    std::vector<std::string> arguments;
    std::string word;  ///< that the message must hold
};

TEST(Usage, WrongCommandLinesExitWithTwoAndSayWhatIsWrong) {
    const std::vector<Refusal> refusals{
        {{}, "subcommand"},
        {{"frobnicate"}, "frobnicate"},
        {{"--frobnicate"}, "--frobnicate"},
        {{"run"}, "COHORT"},
        {{"run", "c.yaml", "--frobnicate"}, "--frobnicate"},
        {{"run", "c.yaml", "--threads", "0"}, "--threads"},
        {{"run", "c.yaml", "--threads", "many"}, "--threads"},
        {{"run", "c.yaml", "surplus"}, "surplus"},
        {{"validate"}, "COHORT"},
        {{"validate", "c.yaml", "surplus"}, "surplus"},
        {{"model"}, "SURFACE"},
        {{"model", "a.ply"}, "--output"},
        {{"model", "a.ply", "-o", "a.hdf", "--inlets=0,0,0"}, "--inlets"},
        {{"model", "a.ply", "-o", "a.hdf", "--scale", "0"}, "--scale"},
        {{"model", "a.ply", "-o", "a.hdf", "--scale=-1"}, "--scale"},
        {{"model", "a.ply", "-o", "a.hdf", "--scale", "nan"}, "--scale"},
        {{"model", "a.ply", "-o", "a.hdf", "--scale", "inf"}, "--scale"},
        {{"model", "a.ply", "-o", "a.hdf", "--precision", "float16"}, "--precision"},
        {{"model", "a.ply", "-o", "a.hdf", "--mode", "guess"}, "--mode"},
        {{"model", "a.ply", "-o", "a.hdf", "--weld-tolerance", "1"}, "--weld-tolerance"},
        {{"browse"}, "ARCHIVE"},
        {{"browse", "archive", "show"}, "ID"},
        {{"browse", "archive", "get", "id"}, "PATH"},
        {{"browse", "archive", "serve", "--port", "http"}, "--port"},
        {{"browse", "archive", "serve", "--port", "65536"}, "--port"},
        {{"browse", "archive", "page"}, "--output"},
        {{"browse", "archive", "list", "--json", "--csv"}, "--json"},
        {{"stats", "archive", "--bootstrap", "-5"}, "--bootstrap"},
        {{"stats", "archive", "--bootstrap", "3000000000"}, "--bootstrap"},
        {{"stats", "archive", "--bins", "-1"}, "--bins"},
        {{"stats", "archive", "--bins", "0"}, "--bins"},
        {{"stats", "archive", "--seed", "-1"}, "--seed"},
        {{"validate-archive"}, "ARCHIVE"},
        {{"report", "archive"}, "--output"},
        {{"report", "archive", "-o", "r.html", "--picture-size", "3"}, "--picture-size"},
        {{"phantom"}, "KIND"},
        {{"phantom", "cylinder"}, "--output"},
        {{"phantom", "torus", "-o", "a.ply", "--voxel", "0"}, "--voxel"},
        {{"phantom", "torus", "-o", "a.ply", "--voxel", "2"}, "voxel size"},
        {{"phantom", "torus", "-o", "a.ply", "--smoothing", "3"}, "--smoothing"},
        {{"phantom", "torus", "-o", "a.ply", "--voxel", "0.3", "--jitter", "0.2"}, "--jitter"},
        {{"phantom", "torus", "-o", "a.ply", "--seed", "-1"}, "--seed"},
        {{"phantom", "tree", "-o", "a.ply", "--seed", "-1"}, "--seed"},
        {{"phantom", "tree", "--leaves", "2"}, "--output"},
        {{"phantom", "tree", "-o", "a.ply", "--leaves", "6"}, "power of two"},
        {{"phantom", "tree", "-o", "a.ply", "--offset=1,2"}, "--offset"},
        {{"phantom", "tree", "-o", "a.ply", "--severity", "0.5"}, "--severity"},
        {{"phantom", "table", "--seeds", "0"}, "--seeds"},
        {{"phantom", "table", "--rows", "3/5-11"}, "3/5-11"},
        {{"phantom", "sphere", "-o", "a.ply"}, "sphere"},
        {{"phantom", "torus", "-o", "a.ply", "--pitch", "3"}, "--pitch"},
        {{"phantom", "cylinder", "-o", "a.ply", "--offset=1,2"}, "--offset"},
    };
    for (const Refusal& refusal : refusals) {
        const auto folder = fresh_folder();
        write_text(folder / "c.yaml", "cohort: c\nmodels: [{id: a, surface: a.ply}]\n");
        std::string line = "lumenline";
        for (const std::string& argument : refusal.arguments) line += " " + argument;
        const Finished run = run_lumenline(refusal.arguments, folder);
        EXPECT_EQ(run.status, 2) << line << "\n" << run.out << run.err;
        EXPECT_EQ(run.out, "") << line;
        EXPECT_NE(run.err.find(refusal.word), std::string::npos) << line << "\n" << run.err;
        EXPECT_EQ(lines_of(run.err).size(), 1U) << line << "\n" << run.err;
        EXPECT_EQ(run.err.rfind("lumenline", 0), 0U) << line << "\n" << run.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "results")) << line;
        EXPECT_FALSE(std::filesystem::exists(folder / "a.hdf")) << line;
        EXPECT_FALSE(std::filesystem::exists(folder / "a.ply")) << line;
    }
}

TEST(Usage, WordsAreListedInHelpAndInRefusalsAndNumbersAreNone) {
    const std::string help = run_lumenline({"model", "--help"}, fresh_folder()).out;
    EXPECT_EQ(help.find('\0'), std::string::npos);
    for (const char* word : {"boundaries", "medial", "nearest", "centre", "network", "largest"})
        EXPECT_NE(help.find(word), std::string::npos) << word;
    for (const auto& [option, word] : std::vector<std::pair<std::string, std::string>>{{"--mode", "boundaries"},
                                                                                       {"--refine", "medial"},
                                                                                       {"--pairs", "nearest"},
                                                                                       {"--join", "centre"},
                                                                                       {"--topology", "network"},
                                                                                       {"--components", "largest"}})
        for (const char* wrong : {"foo", "1"}) {
            const Finished run = run_lumenline({"model", "a.ply", "-o", "a.hdf", option, wrong}, fresh_folder());
            EXPECT_EQ(run.status, 2) << option << wrong;
            EXPECT_EQ(run.err.find('\0'), std::string::npos) << option << wrong;
            EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
        }
}

TEST(Usage, ThreadsHaveTheLimitsOfTheSchema) {
    for (const char* threads : {"0", "-1", "4097"})
        for (const std::vector<std::string>& words :
             std::vector<std::vector<std::string>>{{"run", "c.yaml", "--threads", threads},
                                                   {"model", "a.ply", "-o", "a.hdf", "--threads", threads},
                                                   {"submit", "c.yaml", "--cpus-per-task", threads}}) {
            const Finished run = run_lumenline(words, fresh_folder());
            EXPECT_EQ(run.status, 2) << words[0];
            EXPECT_NE(run.err.find("1 to 4096"), std::string::npos) << run.err;
        }
}

TEST(Usage, WrongPointTextIsRefusedBeforeAnythingIsRead) {
    for (const char* text : {"1,2", "1,2,3,4", "a,b,c", "1 2 3", "nan,0,0", "1,2,inf", "", "1,2,3x"})
        for (const char* option : {"--inlet=", "--outlet="}) {
            const auto folder = fresh_folder();
            const Finished run =
                run_lumenline({"model", "missing.ply", "-o", "a.hdf", option + std::string(text)}, folder);
            EXPECT_EQ(run.status, 2) << option << text << "\n" << run.err;
            EXPECT_NE(run.err.find(std::string(option).substr(0, 7)), std::string::npos) << run.err;
            EXPECT_FALSE(std::filesystem::exists(folder / "a.hdf"));
        }
}

}  // namespace
}  // namespace lumenline::cli_test
