// What of the disk can be reached through an archive that is served: its own files by their own paths, nothing else.
#include "engine/cli/archive_files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "io/archive/errors.h"

namespace lumenline {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
}

/// A folder with an archive in it, and a secret beside the archive.
fs::path fresh_archive(const std::string& name) {
    const fs::path folder = fs::path(::testing::TempDir()) / ("archive_files_" + name);
    fs::remove_all(folder);
    write(folder / "results/cohort.h5", "index");
    write(folder / "results/models/a.hdf", "model a");
    write(folder / "results/notes.txt", "secret");
    write(folder / "secret.hdf", "secret");
    return folder / "results";
}

std::string text_of(const ArchiveFiles& files, std::string_view path) {
    const auto file = files.open(path);
    if (!file) return "(none)";
    std::string text(file->size(), '\0');
    text.resize(file->read(0, text));
    return text;
}

TEST(ArchiveFiles, IndexAndModelsOfADirectoryAreGiven) {
    const ArchiveFiles files(fresh_archive("directory"));
    EXPECT_EQ(files.root(), "cohort.h5");
    EXPECT_EQ(files.name(), "results");
    EXPECT_EQ(text_of(files, "cohort.h5"), "index");
    EXPECT_EQ(text_of(files, "models/a.hdf"), "model a");
    EXPECT_EQ(text_of(files, "models/b.hdf"), "(none)");
}

TEST(ArchiveFiles, PathsThatLeaveTheArchiveLeadNowhere) {
    using namespace std::string_view_literals;
    const ArchiveFiles files(fresh_archive("traversal"));
    for (const std::string_view path : {"../secret.hdf"sv,
                                        "models/../../secret.hdf"sv,
                                        "models/..hdf"sv,
                                        "/etc/passwd"sv,
                                        "models//etc/x.hdf"sv,
                                        "models/./a.hdf"sv,
                                        "./cohort.h5"sv,
                                        "models/../cohort.h5"sv,
                                        "notes.txt"sv,
                                        "models/a.hdf/"sv,
                                        "models"sv,
                                        "models/"sv,
                                        "models/.hdf"sv,
                                        ""sv,
                                        "."sv,
                                        ".."sv,
                                        "cohort.h5\0.hdf"sv,
                                        "models/a.hdf\0.hdf"sv,
                                        "models/../secret.hdf\0.hdf"sv,
                                        "models\\..\\secret.hdf"sv,
                                        "MODELS/a.hdf"sv})
        EXPECT_EQ(files.open(path), nullptr) << path;
}

TEST(ArchiveFiles, SymbolicLinksAreNotFollowed) {
    const fs::path archive = fresh_archive("links");
    fs::create_symlink(archive.parent_path() / "secret.hdf", archive / "models/link.hdf");
    fs::create_symlink("a.hdf", archive / "models/near.hdf");
    const ArchiveFiles files(archive);
    EXPECT_EQ(files.open("models/link.hdf"), nullptr);
    EXPECT_EQ(files.open("models/near.hdf"), nullptr) << "nor one that stays inside: what is a link can be turned";

    fs::rename(archive / "models", archive.parent_path() / "elsewhere");
    fs::create_directory_symlink(archive.parent_path() / "elsewhere", archive / "models");
    EXPECT_EQ(files.open("models/a.hdf"), nullptr) << "a folder that is a link";

    fs::remove(archive / "cohort.h5");
    fs::create_symlink(archive.parent_path() / "secret.hdf", archive / "cohort.h5");
    EXPECT_EQ(files.open("cohort.h5"), nullptr);
    EXPECT_THROW(ArchiveFiles{archive}, UnknownName);
}

TEST(ArchiveFiles, WhatIsNoRegularFileIsRefusedAndHoldsNobodyUp) {
    const fs::path archive = fresh_archive("kinds");
    ASSERT_EQ(::mkfifo((archive / "models/pipe.hdf").c_str(), 0600), 0);
    fs::create_directory(archive / "models/folder.hdf");
    const ArchiveFiles files(archive);
    EXPECT_EQ(files.open("models/pipe.hdf"), nullptr);
    EXPECT_EQ(files.open("models/folder.hdf"), nullptr);
}

TEST(ArchiveFiles, OneFileGivesItselfAlone) {
    const fs::path archive = fresh_archive("single");
    const ArchiveFiles files(archive / "models/a.hdf");
    EXPECT_EQ(files.root(), "a.hdf");
    EXPECT_EQ(text_of(files, "a.hdf"), "model a");
    EXPECT_EQ(files.open("cohort.h5"), nullptr);
    EXPECT_EQ(files.open("models/a.hdf"), nullptr);
    EXPECT_EQ(files.open("../cohort.h5"), nullptr);
}

TEST(ArchiveFiles, ArchiveReachedThroughALinkIsGiven) {
    const fs::path archive = fresh_archive("entry");
    fs::create_directory_symlink(archive, archive.parent_path() / "latest");
    EXPECT_EQ(text_of(ArchiveFiles(archive.parent_path() / "latest"), "models/a.hdf"), "model a");
}

TEST(ArchiveFiles, MissingArchiveAndMissingIndexAreSaid) {
    const fs::path archive = fresh_archive("missing");
    EXPECT_THROW(ArchiveFiles{archive / "nowhere"}, UnknownName);
    fs::remove(archive / "cohort.h5");
    EXPECT_THROW(ArchiveFiles{archive}, UnknownName);
}

TEST(ArchiveFiles, TagChangesWhenAFileIsWrittenAnew) {
    const fs::path archive = fresh_archive("tag");
    const ArchiveFiles files(archive);
    const std::string before = files.open("models/a.hdf")->tag();
    EXPECT_EQ(files.open("models/a.hdf")->tag(), before);
    write(archive / "models/a.hdf.tmp", "model b");
    fs::rename(archive / "models/a.hdf.tmp", archive / "models/a.hdf");
    EXPECT_NE(files.open("models/a.hdf")->tag(), before) << "of the same length, in the same moment";
}

TEST(ArchiveFiles, ReadingPastTheEndGivesWhatThereIs) {
    const ArchiveFiles files(fresh_archive("end"));
    const auto file = files.open("models/a.hdf");
    std::string text(100, '\0');
    EXPECT_EQ(file->read(2, text), 5U);
    EXPECT_EQ(text.substr(0, 5), "del a");
    EXPECT_EQ(file->read(7, text), 0U);
    EXPECT_EQ(file->read(1000, text), 0U);
}

}  // namespace
}  // namespace lumenline
