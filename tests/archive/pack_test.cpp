#include "io/archive/pack.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "io/archive/handle.h"
#include "io/archive/index.h"
#include "io/archive/model_file.h"
#include "io/archive/read.h"
#include "tests/archive/sample_record.h"

namespace lumenline {
namespace {

std::string printed(const ArchiveFile& file, const std::string& path) {
    std::ostringstream out;
    file.print(path, out);
    return out.str();
}

TEST(Pack, EveryDatasetAndAttributeOfAModelIsThere) {
    const auto directory = sample_archive({sample_record("a"), failed_record("b")}, "pack");
    const auto packed = directory / "one.h5";
    const Packed result = pack_archive(directory, packed, nullptr);
    EXPECT_EQ(result.models, 2U);
    EXPECT_EQ(result.missing, 0U);
    EXPECT_FALSE(std::filesystem::exists(directory / "one.h5.tmp"));
    std::filesystem::remove_all(directory / "models");
    std::filesystem::remove(directory / "cohort.h5");

    const auto again = sample_archive({sample_record("a"), failed_record("b")}, "pack_again");
    for (const char* id : {"a", "b"}) {
        const ArchiveFile inside = open_model(packed, id), own = open_model(again, id);
        EXPECT_EQ(inside.format(), own.format());
        EXPECT_EQ(inside.attributes("/"), own.attributes("/"));
        const auto nodes = own.nodes(), copies = inside.nodes();
        ASSERT_EQ(nodes.size(), copies.size());
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            EXPECT_EQ(nodes[i].path, copies[i].path);
            EXPECT_EQ(nodes[i].units, copies[i].units);
            if (nodes[i].is_group) continue;
            EXPECT_EQ(printed(inside, nodes[i].path), printed(own, nodes[i].path));
        }
    }
    EXPECT_EQ(list_models(packed).size(), 2U);
    EXPECT_EQ(read_data_table(packed, "failures").rows, 1U);
}

TEST(Pack, ModelsWithoutAFileAreCountedAndLeftOut) {
    const auto directory = sample_archive({sample_record("a"), sample_record("b")}, "pack_missing");
    std::filesystem::remove(model_path(directory, "b"));
    EXPECT_EQ(pack_archive(directory, directory / "one.h5", nullptr).missing, 1U);
    EXPECT_NO_THROW(open_model(directory / "one.h5", "a"));
    EXPECT_THROW(open_model(directory / "one.h5", "b"), ArchiveError);
    EXPECT_THROW(open_model(directory / "one.h5", "c"), UnknownName);
}

TEST(Pack, DamagedModelsAndPackedArchivesAreRefusedAndLeaveNoFile) {
    const auto directory = sample_archive({sample_record("a")}, "pack_damaged");
    pack_archive(directory, directory / "one.h5", nullptr);
    EXPECT_THROW(pack_archive(directory / "one.h5", directory / "two.h5", nullptr), UnknownName);
    std::filesystem::resize_file(model_path(directory, "a"), 1000);
    EXPECT_THROW(pack_archive(directory, directory / "two.h5", nullptr), ArchiveError);
    EXPECT_FALSE(std::filesystem::exists(directory / "two.h5"));
    EXPECT_FALSE(std::filesystem::exists(directory / "two.h5.tmp"));
    EXPECT_THROW(pack_archive(directory / "nowhere", directory / "two.h5", nullptr), UnknownName);
}

/// Makes the layout of a contiguous dataset say another address.
void move_values(const std::filesystem::path& file, const char* path, haddr_t to) {
    haddr_t from = HADDR_UNDEF;
    hsize_t size = 0;
    {
        const hdf::Handle opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, hdf::file_access().get()), H5Fclose, "open");
        const hdf::Handle dataset(H5Dopen2(opened.get(), path, H5P_DEFAULT), H5Dclose, path);
        from = H5Dget_offset(dataset.get());
        size = H5Dget_storage_size(dataset.get());
    }
    std::string layout(16, '\0');
    std::memcpy(layout.data(), &from, 8);
    std::memcpy(layout.data() + 8, &size, 8);
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    const std::size_t place = bytes.find(layout);
    ASSERT_NE(place, std::string::npos);
    stream.seekp(static_cast<std::streamoff>(place));
    stream.write(reinterpret_cast<const char*>(&to), 8);
}

TEST(Pack, ModelWhoseValuesLieBeyondTheEndOfItsFileIsRefused) {
    const auto directory = sample_archive({sample_record("a")}, "pack_beyond");
    const std::filesystem::path model = model_path(directory, "a");
    for (const haddr_t to : {haddr_t{std::filesystem::file_size(model)} - 4, haddr_t{1} << 40}) {
        move_values(model, "/centerlines/radius", to);
        try {
            pack_archive(directory, directory / "one.h5", nullptr);
            FAIL() << "packed";
        } catch (const ArchiveError& error) {
            EXPECT_NE(std::string(error.what()).find("/centerlines/radius"), std::string::npos) << error.what();
        }
        EXPECT_FALSE(std::filesystem::exists(directory / "one.h5"));
        sample_archive({sample_record("a")}, "pack_beyond");
    }
}

}  // namespace
}  // namespace lumenline
