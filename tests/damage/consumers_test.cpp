// Every dataset in turn is removed, cut short, given another type or made unreadable, and files are cut off and
// overwritten: every command that reads archives works all the same, or says one sentence. A crash ends the test
// program, and so shows.
#include "tests/damage/consumers.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <random>

#include "io/archive/specification.h"
#include "tests/cli/process.h"
#include "tests/damage/sample_cohort.h"

namespace lumenline::damage {
namespace {

namespace fs = std::filesystem;
using cli_test::read_text;
using cli_test::write_text;

/// Another one at each turn, and also at each fourth.
Harm harm_in_turn(std::size_t turn) { return kHarms[(turn + turn / 4) % std::size(kHarms)]; }

/// What commands that read one model say of it.
std::string read_model(const fs::path& archive, const std::string& path, bool write_too) {
    const std::string root = archive.string(), id = kWhole;
    std::string complaints = complaint({"browse", root, "show", id}) + complaint({"browse", root, "tree", id}) +
                             complaint({"browse", root, "get", id, path});
    if (!write_too) return complaints;
    const fs::path folder = archive.parent_path();
    return complaints + complaint({"export", root, "--to", "vtp", "--model", id, "-o", (folder / "vtp").string()}) +
           complaint({"pack", root, "-o", (folder / "one.h5").string()}) +
           complaint({"report", root, "-o", (folder / "report.html").string(), "--picture-size", "32"});
}

/// What commands that read the index say of it.
std::string read_index(const fs::path& archive, bool write_too) {
    const std::string root = archive.string();
    const fs::path folder = archive.parent_path();
    const std::string complaints = complaint({"browse", root, "list"}) +
                                   complaint({"browse", root, "list", "--sort", "radius_min", "--json"}) +
                                   complaint({"browse", root, "show", kWhole}) + complaint({"stats", root}) +
                                   complaint({"stats", root, "--table", "branches"});
    if (!write_too) return complaints;
    return complaints + complaint({"export", root, "--to", "csv", "-o", (folder / "csv").string()}) +
           complaint({"report", root, "-o", (folder / "report.html").string(), "--picture-size", "32"});
}

TEST(Damage, EveryDatasetOfAModelWhateverReadsIt) {
    const fs::path archive = sample_cohort(), file = whole_model(archive);
    const std::string bytes = read_text(file);
    std::size_t turn = 0;
    for (const Specified& entry : model_specification()) {
        const bool is_table = entry.path.find('/', 1) != entry.path.npos && entry.part == Part::kBranches;
        const bool write_too = turn % (is_table ? 16 : 4) == 0;
        write_text(file, bytes);
        const Harm harm = harm_in_turn(turn);
        if ((!is_table || turn % 4 == 0) && harm_dataset(file, entry.path, harm)) {
            EXPECT_EQ(read_model(archive, entry.path, write_too), "") << entry.path << " " << name_of(harm);
        }
        ++turn;
    }
}

TEST(Damage, EveryDatasetOfAnIndexWhateverReadsIt) {
    const fs::path archive = sample_cohort(), file = archive / "cohort.h5";
    const std::string bytes = read_text(file);
    std::size_t turn = 0;
    for (const Specified& entry : index_specification()) {
        const Harm harm = harm_in_turn(turn++);
        if (entry.path == names::kAnyCovariate) continue;
        const bool of_models = entry.path.starts_with("/tables/models/");
        if (!of_models && turn % 4 != 0) continue;  // the columns of the other tables are read alike
        write_text(file, bytes);
        if (harm_dataset(file, entry.path, harm)) {
            EXPECT_EQ(read_index(archive, turn % 3 == 0), "") << entry.path << " " << name_of(harm);
        }
    }
}

/// Runs `body` in a process of its own, since HDF5 itself loses memory when it meets damaged metadata.
void expect_survives(const std::function<std::string()>& body) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        const std::string complaints = body().substr(0, 4000);
        const ssize_t sent = ::write(ends[1], complaints.data(), complaints.size());
        ::_exit(sent == static_cast<ssize_t>(complaints.size()) ? 0 : 1);
    }
    ::close(ends[1]);
    std::string complaints;
    char block[4096];
    for (ssize_t got = 0; (got = ::read(ends[0], block, sizeof block)) > 0;)
        complaints.append(block, static_cast<std::size_t>(got));
    ::close(ends[0]);
    int status = -1;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status)) << "killed by signal " << WTERMSIG(status);
    EXPECT_EQ(complaints, "");
}

TEST(Damage, FilesThatEndEarlyAreRefused) {
    const fs::path archive = sample_cohort();
    for (const fs::path& file : {whole_model(archive), archive / "cohort.h5"}) {
        const std::string bytes = read_text(file);
        expect_survives([&] {
            std::string complaints;
            for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 4 + bytes.size() / 20) {
                write_text(file, bytes.substr(0, length));
                complaints += complaint({"browse", archive.string(), "show", kWhole}) + read_index(archive, false) +
                              complaint({"validate-archive", archive.string()});
            }
            return complaints;
        });
        write_text(file, bytes);
    }
}

TEST(Damage, OverwrittenBytesNeverCrash) {
    const fs::path archive = sample_cohort();
    for (const fs::path& file : {whole_model(archive), archive / "cohort.h5"}) {
        const std::string bytes = read_text(file);
        expect_survives([&] {
            std::string complaints;
            std::mt19937 random(7);
            for (int round = 0; round < 48; ++round) {
                std::string damaged = bytes;
                // Metadata lie between the data, most of them near the ends: half of the damage goes there.
                const std::size_t reach = round % 2 == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 40000);
                const std::size_t start = random() % (reach - 16);
                for (std::size_t k = start; k < start + (round % 3 == 0 ? 16U : 1U); ++k)
                    damaged[k] = static_cast<char>(damaged[k] ^ static_cast<char>(1 + random() % 255));
                write_text(file, damaged);
                complaints += complaint({"validate-archive", archive.string()}) +
                              complaint({"browse", archive.string(), "show", kWhole}) +
                              complaint({"browse", archive.string(), "list", "--csv"}) +
                              complaint({"browse", archive.string(), "get", kWhole, "/surface/points"});
                if (round % 4 == 0) complaints += read_model(archive, "/centerlines/radius", true);
            }
            return complaints;
        });
        write_text(file, bytes);
    }
}

TEST(Damage, TheProgramItselfSaysOneSentence) {
    const fs::path archive = sample_cohort(), file = whole_model(archive);
    const std::string root = archive.string();
    harm_dataset(file, "/centerlines/offsets", Harm::kRetyped);
    harm_dataset(archive / "cohort.h5", "/tables/models/status", Harm::kShortened);
    for (const std::vector<std::string>& words :
         std::vector<std::vector<std::string>>{{"browse", root},
                                               {"browse", root, "show", kWhole},
                                               {"stats", root},
                                               {"export", root, "--to", "csv", "-o", "csv"},
                                               {"export", root, "--to", "vtp", "-o", "vtp"},
                                               {"report", root, "-o", "report.html"}}) {
        const auto run = cli_test::run_lumenline(words, archive.parent_path());
        EXPECT_EQ(run.status, 1) << words[0] << run.out;
        EXPECT_EQ(cli_test::lines_of(run.err).size(), 1U) << run.err;
    }
}

}  // namespace
}  // namespace lumenline::damage
