// Files that are not what they claim must give one sentence, never a crash or a wrong number.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <sstream>

#include "io/archive/handle.h"
#include "io/archive/index.h"
#include "io/archive/model_file.h"
#include "io/archive/read.h"
#include "tests/archive/sample_record.h"

namespace lumenline {
namespace {

std::filesystem::path sample_file(const std::string& name) {
    std::filesystem::path file = fresh_directory(name) / "m.hdf";
    write_model_file(file, sample_record());
    return file;
}

/// The sentence with which `read_summary` refuses a file; empty if it reads it.
std::string refusal(const std::filesystem::path& file) {
    try {
        read_summary(file);
        return "";
    } catch (const ArchiveError& error) {
        return error.what();
    }
}

void expect_refused(const std::filesystem::path& file, const std::string& because) {
    const std::string sentence = refusal(file);
    EXPECT_NE(sentence.find(because), std::string::npos) << "'" << sentence << "' should say '" << because << "'";
    EXPECT_NE(sentence.find(file.string()), std::string::npos) << sentence;
    EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
}

/// Opens a file for writing behind our back.
void tamper(const std::filesystem::path& file, const std::function<void(hid_t)>& change) {
    const hdf::Handle raw(H5Fopen(file.c_str(), H5F_ACC_RDWR, hdf::file_access().get()), H5Fclose, "open");
    change(raw.get());
}

void replace_numbers(hid_t file, const char* path, const std::vector<double>& values) {
    hdf::checked(H5Ldelete(file, path, H5P_DEFAULT), path);
    const hsize_t count = values.size();
    const hdf::Handle dataset(
        H5Dcreate2(file, path, H5T_IEEE_F64LE, hdf::extent(1, &count).get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose, path);
    hdf::checked(H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path);
}

void replace_attribute(hid_t file, const char* name, const std::string& text) {
    hdf::checked(H5Adelete(file, name), name);
    const hdf::Handle type = hdf::string_type(text.size());
    const hdf::Handle attribute(
        H5Acreate2(file, name, type.get(), hdf::extent(0, nullptr).get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, name);
    hdf::checked(H5Awrite(attribute.get(), type.get(), text.c_str()), name);
}

TEST(Damage, AttributesOfWhichOneCannotBeReadAreRefused) {
    const std::filesystem::path file = sample_file("damage_attribute");
    std::string bytes = bytes_of(file);
    const std::size_t name = bytes.find("coordinate_system");
    ASSERT_NE(name, std::string::npos);
    const std::size_t type = bytes.find('\x13', name);  // text, version 1 of the message, stands behind the name
    ASSERT_LT(type, name + 32);
    bytes[type] = '\xF3';
    write_bytes(file, bytes);
    const ArchiveFile damaged(file);
    EXPECT_THROW(damaged.attributes("/"), ArchiveError);
    EXPECT_THROW(damaged.require_copyable(), ArchiveError);
}

TEST(Damage, MissingEmptyAndForeignFilesAreRefused) {
    const auto directory = fresh_directory("foreign");
    EXPECT_THROW(read_summary(directory / "absent.hdf"), UnknownName);
    EXPECT_THROW(read_summary(directory), ArchiveError) << "a directory";
    write_bytes(directory / "empty.hdf", "");
    expect_refused(directory / "empty.hdf", "no complete HDF5 file");
    write_bytes(directory / "text.hdf", std::string(5000, 'x'));
    expect_refused(directory / "text.hdf", "no complete HDF5 file");
    {
        const hdf::Handle other(H5Fcreate((directory / "other.hdf").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                                H5Fclose, "create");
    }
    expect_refused(directory / "other.hdf", "it was not written by lumenline");
}

TEST(Damage, EveryTruncationIsRefused) {
    const auto file = sample_file("truncated");
    const std::string bytes = bytes_of(file);
    ASSERT_EQ(refusal(file), "");
    for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 5) {
        write_bytes(file, bytes.substr(0, length));
        expect_refused(file, "no complete HDF5 file");
    }
    write_bytes(file, bytes.substr(0, bytes.size() - 1));
    expect_refused(file, "truncated");
}

/// Opens `file` with a block of bytes overwritten, at one place after the other, and prints all of it.
/// @returns how many of the files were refused
std::size_t refused_with_overwritten_blocks(const std::filesystem::path& file) {
    constexpr std::size_t kStep = 512, kBlock = 48;
    const std::string bytes = bytes_of(file);
    std::size_t refused = 0;
    for (std::size_t start = 0; start + kBlock < bytes.size(); start += kStep) {
        std::string damaged = bytes;
        damaged.replace(start, kBlock, kBlock, '\xA5');
        write_bytes(file, damaged);
        refused += refusal(file).empty() ? 0 : 1;
        try {
            const ArchiveFile opened(file);
            for (const ArchiveNode& node : opened.nodes()) {
                std::ostringstream out;
                if (!node.is_group) opened.print(node.path, out);
            }
        } catch (const ArchiveError&) {
            // Refusing is as good as reading: the test is that nothing else happens.
        }
    }
    return refused;
}

TEST(Damage, OverwrittenBlocksNeverCrash) {
    const auto file = sample_file("blocks");
    // In a process of its own: HDF5 itself leaks memory when it meets damaged metadata.
    const pid_t child = ::fork();
    if (child == 0) ::_exit(refused_with_overwritten_blocks(file) > 10 ? 0 : 1);
    int status = -1;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status)) << "killed by signal " << WTERMSIG(status);
    EXPECT_EQ(WEXITSTATUS(status), 0) << "some blocks are metadata, so some files must be refused";
}

TEST(Damage, IndexAndModelFileAreToldApart) {
    const auto file = sample_file("kinds");
    write_index(file.parent_path(), {}, "", "");
    EXPECT_THROW(read_summary(file.parent_path() / "cohort.h5"), ArchiveError);
    EXPECT_THROW(read_index(file), ArchiveError);
}

TEST(Damage, NewerFormatIsRefused) {
    const auto file = sample_file("newer");
    tamper(file, [](hid_t raw) { replace_attribute(raw, "format_version", "2"); });
    expect_refused(file, "its format version is 2, and this program reads version 1");
}

TEST(Damage, UnknownStatusIsRefused) {
    const auto file = sample_file("status");
    tamper(file, [](hid_t raw) { replace_attribute(raw, "status", "fine"); });
    expect_refused(file, "'fine' is no status");
}

TEST(Damage, ArraysThatContradictEachOtherAreRefused) {
    for (const auto& [path, values, reason] : std::vector<std::tuple<const char*, std::vector<double>, const char*>>{
             {"/centerlines/offsets", {0, 7, 5}, "do not ascend"},
             {"/centerlines/offsets", {0, 5, 1e300}, "do not ascend"},
             {"/centerlines/offsets", {-1, 5, 9}, "do not ascend"},
             {"/centerlines/offsets", {0, 9}, "matching length"},
             {"/centerlines/abscissa", {0, 1}, "matching length"},
             {"/endpoints/role", {1, 2}, "holds no text"},
             {"/timing/total_seconds", {1, 2}, "not one number"}}) {
        const auto file = sample_file("contradicting");
        tamper(file, [&](hid_t raw) { replace_numbers(raw, path, values); });
        expect_refused(file, reason);
    }
}

TEST(Damage, MissingDatasetIsNamed) {
    const auto file = sample_file("missing");
    tamper(file, [](hid_t raw) { hdf::checked(H5Ldelete(raw, "/diagnostics/severity", H5P_DEFAULT), "delete"); });
    expect_refused(file, "/diagnostics/severity");
}

TEST(Damage, DatasetLargerThanTheFileIsRefused) {
    const auto file = sample_file("huge");
    tamper(file, [](hid_t raw) {
        hdf::checked(H5Ldelete(raw, "/centerlines/radius", H5P_DEFAULT), "delete");
        const hsize_t count = hsize_t{1} << 50U;
        const hdf::Handle made(H5Dcreate2(raw, "/centerlines/radius", H5T_IEEE_F64LE, hdf::extent(1, &count).get(),
                                          H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                               H5Dclose, "create");
    });
    expect_refused(file, "do not fit into the file");
}

TEST(Damage, VariableLengthTextOfOthersIsRead) {
    const auto file = sample_file("variable");
    tamper(file, [](hid_t raw) {
        hdf::Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "type");
        hdf::checked(H5Tset_size(type.get(), H5T_VARIABLE), "type");
        const hsize_t count = 2;
        const hdf::Handle made(
            H5Dcreate2(raw, "/note", type.get(), hdf::extent(1, &count).get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
            H5Dclose, "create");
        const char* texts[] = {"one", "a longer one"};
        hdf::checked(H5Dwrite(made.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, texts), "write");
    });
    EXPECT_EQ(ArchiveFile(file).strings("/note"), (std::vector<std::string>{"one", "a longer one"}));
}

TEST(Damage, IndexWithAColumnTooShortIsRefused) {
    const auto directory = fresh_directory("short_column");
    const std::vector<ModelSummary> models{summarize(sample_record("a")), summarize(failed_record("b"))};
    write_index(directory, models, "", "");
    tamper(directory / "cohort.h5", [](hid_t raw) { replace_numbers(raw, "/tables/models/sites", {1}); });
    try {
        list_models(directory);
        FAIL();
    } catch (const ArchiveError& error) {
        EXPECT_NE(std::string(error.what()).find("/tables/models/sites has 1 rows for 2 models"), std::string::npos);
    }
}

TEST(Damage, IdThatLeadsOutOfTheArchiveIsNotFollowed) {
    const auto directory = fresh_directory("escape");
    const std::vector<ModelSummary> models{summarize(sample_record("aaaaaa"))};
    write_index(directory, models, "", "");
    std::string bytes = bytes_of(directory / "cohort.h5");
    for (std::size_t at = 0; (at = bytes.find("aaaaaa", at)) != std::string::npos;) bytes.replace(at, 6, "../../");
    write_bytes(directory / "cohort.h5", bytes);
    try {
        open_model(directory, "../../");
        FAIL();
    } catch (const ArchiveError& error) {
        EXPECT_NE(std::string(error.what()).find("no file name"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace lumenline
