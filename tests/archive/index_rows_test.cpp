// The branches' tables of the index, carried over from the model files; labels; the dictionary.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "engine/core/index_tables.h"
#include "io/archive/handle.h"
#include "io/archive/index.h"
#include "io/archive/model_file.h"
#include "io/archive/model_tables.h"
#include "io/archive/packed_rows.h"
#include "io/archive/read.h"
#include "io/archive/table_stream.h"
#include "tests/archive/sample_record.h"

namespace lumenline {
namespace {

using Strings = std::vector<std::string>;

constexpr int kModels = 20;

std::filesystem::path many(const std::string& name, std::vector<ModelSummary>& models) {
    const auto directory = fresh_directory(name);
    std::filesystem::create_directories(directory / "models");
    write_model_file(model_path(directory, "m0"), sample_record("m0"));
    for (int k = 0; k < kModels; ++k) {
        models.push_back(summarize(sample_record("m" + std::to_string(k))));
        if (k > 0)
            std::filesystem::create_hard_link(model_path(directory, "m0"),
                                              model_path(directory, models[k].identity.id));
    }
    return directory;
}

TEST(TableStream, BlocksMakeTheSameTableAsOneWrite) {
    constexpr std::size_t kRows = 10000;  // more than are written at a time
    Table whole{"t",
                {{"n", "1", "number", "someone", ColumnKind::kNumber, {}, {}},
                 {"i", "1", "index", "", ColumnKind::kIndex, {}, {}},
                 {"s", "1", "text", "", ColumnKind::kText, {}, {}}}};
    for (std::size_t k = 0; k < kRows; ++k) {
        whole.columns[0].numbers.push_back(k % 7 == 0 ? std::nan("") : static_cast<double>(k) / 3);
        whole.columns[1].numbers.push_back(static_cast<double>(k) - 1);
        whole.columns[2].texts.push_back("row \xC3\xA9 " + std::to_string(k));
    }
    const auto directory = fresh_directory("table_stream");
    const auto write = [&](const std::string& name, std::size_t announced, std::size_t step) {
        const hdf::Quiet quiet;
        hdf::Writer writer(directory / name, "mm");
        writer.attribute("/", "format", names::kCohortFormat);
        writer.attribute("/", "format_version", names::kFormatVersion);
        hdf::TableStream stream(writer, "/t", whole, announced, {0, 0, std::string("row \xC3\xA9 9999").size()});
        for (std::size_t from = 0; from < kRows; from += step) {
            Table part = whole;
            for (Column& c : part.columns) {
                const auto cut = [&](auto& values) {
                    if (!values.empty())
                        values = {values.begin() + from, values.begin() + std::min(from + step, kRows)};
                };
                cut(c.numbers);
                cut(c.texts);
            }
            stream.append(part);
        }
        stream.finish();
        writer.commit();
    };
    write("parts", kRows, 1703);
    const ArchiveFile file(directory / "parts");
    EXPECT_EQ(file.strings("/t/s"), whole.columns[2].texts);
    EXPECT_EQ(file.numbers("/t/i"), whole.columns[1].numbers);
    const std::vector<double> numbers = file.numbers("/t/n");
    for (std::size_t k = 0; k < kRows; ++k)
        ASSERT_TRUE(numbers[k] == whole.columns[0].numbers[k] || (k % 7 == 0 && std::isnan(numbers[k]))) << k;
    EXPECT_EQ(file.attribute("/t/n", "source"), "someone");
    write("whole", kRows, kRows);
    EXPECT_EQ(bytes_of(directory / "parts"), bytes_of(directory / "whole"));
    EXPECT_THROW(write("more", kRows - 1, kRows), hdf::Inconsistent);
    EXPECT_THROW(write("less", kRows + 1, kRows), hdf::Inconsistent);
}

TEST(PackedRows, ComeBackAsTheyWereAndAsTheColumnsTellThem) {
    const auto directory = fresh_directory("packed_rows");
    for (const ModelRecord& record : {sample_record("a"), failed_record("b")}) {
        write_model_file(directory / "m.hdf", record);
        const ArchiveFile file(directory / "m.hdf");
        const std::vector<Table> packed = hdf::read_index_tables(file),
                                 columns = hdf::read_columns_of_index_tables(file);
        for (std::size_t t = 0; t < packed.size(); ++t)
            for (std::size_t c = 0; c < packed[t].columns.size(); ++c) {
                const Column &a = packed[t].columns[c], &b = columns[t].columns[c];
                EXPECT_EQ(a.texts, b.texts) << a.name;
                expect_same(a.numbers, b.numbers, a.name);
            }
        EXPECT_EQ(packed.back().rows(), record.endpoints ? record.endpoints->size() : 0U);
    }
}

TEST(PackedRows, DamagedOnesAndThoseOfOtherColumnsAreNotTaken) {
    const ModelRecord record = sample_record();
    std::vector<Table> tables = index_tables(*record.branches, *record.endpoints), read = tables;
    const std::vector<std::uint8_t> packed = hdf::pack_rows(tables);
    const std::string whole(packed.begin(), packed.end());
    ASSERT_TRUE(hdf::unpack_rows(whole, read));
    for (std::size_t k = 0; k < whole.size(); ++k) {
        std::string damaged = whole;
        damaged[k] = static_cast<char>(damaged[k] ^ 0x10);
        ASSERT_FALSE(hdf::unpack_rows(damaged, read)) << k;
        ASSERT_FALSE(hdf::unpack_rows(whole.substr(0, k), read)) << k;
    }
    EXPECT_FALSE(hdf::unpack_rows(whole + '\0', read));
    tables[1].columns[2].name += "_renamed";
    EXPECT_FALSE(hdf::unpack_rows(whole, tables));
    // Sound sums do not make sound contents.
    tables = index_tables(*record.branches, *record.endpoints);
    for (const double value : {-2.0, 0.5, 3e9, std::nan("")}) {
        std::vector<Table> wrong = tables;
        for (Column& column : wrong.front().columns)
            if (column.kind == ColumnKind::kIndex) column.numbers.front() = value;
        const std::vector<std::uint8_t> bytes = hdf::pack_rows(wrong);
        EXPECT_FALSE(hdf::unpack_rows(std::string(bytes.begin(), bytes.end()), read)) << value;
    }
}

TEST(IndexRows, ManyModelsHaveTheRowsOfEachInOrder) {
    std::vector<ModelSummary> models;
    const auto directory = many("index_rows_many", models);
    EXPECT_TRUE(write_index(directory, models, "", "").empty());
    const ArchiveFile index(directory / "cohort.h5"), one(model_path(directory, "m0"));
    const std::vector<double> areas = index.numbers("/tables/sections/area"), expected = one.numbers("/sections/area");
    const Strings ids = index.strings("/tables/sections/id");
    ASSERT_EQ(areas.size(), kModels * expected.size());
    for (std::size_t k = 0; k < areas.size(); ++k) {
        const double value = expected[k % expected.size()];
        ASSERT_TRUE(areas[k] == value || (std::isnan(areas[k]) && std::isnan(value))) << k;
        ASSERT_EQ(ids[k], "m" + std::to_string(k / expected.size()));
    }
    EXPECT_EQ(index.numbers("/tables/branches/parent").size(), 3U * kModels);
    EXPECT_EQ(index.strings("/tables/endpoints/kind").size(), 4U * kModels);
}

TEST(IndexRows, LabelsOfTheModelsStandBesideTheirBranches) {
    const auto directory = sample_archive({sample_record("a"), failed_record("b"), sample_record("c")}, "index_labels");
    const std::vector<ModelSummary> models = list_models(directory);
    std::vector<std::size_t> sizes;
    const BranchLabeller label = [&](std::span<const BranchTree> trees) {
        std::vector<BranchLabels> labels;
        for (const BranchTree& tree : trees) {
            sizes.push_back(tree.size());
            BranchLabels of;
            for (std::size_t b = 0; b < tree.size(); ++b) {
                of.label.push_back(b == 1 ? "" : "vessel " + std::to_string(labels.size()) + std::to_string(b));
                of.confidence.push_back(0.25 * static_cast<double>(b));
            }
            labels.push_back(std::move(of));
        }
        return labels;
    };
    write_index(directory, models, "", "", label);
    EXPECT_EQ(sizes, (std::vector<std::size_t>{3, 0, 3}));
    const ArchiveFile index(directory / "cohort.h5");
    EXPECT_EQ(index.strings("/tables/branches/branch_label"),
              (Strings{"vessel 00", "", "vessel 02", "vessel 20", "", "vessel 22"}));
    EXPECT_EQ(index.numbers("/tables/stenoses/branch_label_confidence"),
              (std::vector<double>{0, 0.25, 0.5, 0, 0.25, 0.5}));
    // By the branch that a row names: sections by branch_id, bifurcations by the parent, their children by the child.
    const auto check = [&](const std::string& table, const std::string& key) {
        const std::vector<double> branch = index.numbers("/tables/" + table + "/" + key);
        const Strings labels = index.strings("/tables/" + table + "/branch_label");
        ASSERT_EQ(labels.size(), branch.size());
        for (std::size_t k = 0; k < branch.size(); ++k) {
            const std::string model = 2 * k < branch.size() ? "0" : "2";
            const bool none = !(branch[k] >= 0 && branch[k] < 3) || branch[k] == 1;
            EXPECT_EQ(labels[k], none ? "" : "vessel " + model + std::to_string(static_cast<int>(branch[k]))) << table;
        }
    };
    check("sections", "branch_id");
    check("bifurcations", "parent");
    check("bifurcation_children", "child");
    check("endpoints", "branch_id");
}

TEST(IndexRows, WithoutLabellerThereAreNoLabels) {
    const auto directory = sample_archive({sample_record("a")}, "index_unlabelled");
    const ArchiveFile index(directory / "cohort.h5");
    EXPECT_EQ(index.strings("/tables/branches/branch_label"), Strings(3));
    for (const double c : index.numbers("/tables/branches/branch_label_confidence")) EXPECT_TRUE(std::isnan(c));
}

TEST(IndexRows, DamagedAndMissingFilesCostTheirOwnRowsAlone) {
    const auto directory = sample_archive(
        {sample_record("a"), sample_record("b"), sample_record("c"), sample_record("d")}, "index_damage");
    const std::vector<ModelSummary> models = list_models(directory);
    std::filesystem::remove(model_path(directory, "a"));
    std::ofstream(model_path(directory, "b"), std::ios::binary) << "no HDF5";
    {
        // A file whose rows can only be read from columns, one of which is not as long as the others.
        const hdf::Handle file(H5Fopen(model_path(directory, "c").c_str(), H5F_ACC_RDWR, hdf::file_access().get()),
                               H5Fclose, "open");
        for (const char* path : {"/index_rows", "/sections/perimeter"})
            hdf::checked(H5Ldelete(file.get(), path, H5P_DEFAULT), path);
        const hsize_t two = 2;
        const hdf::Handle made(H5Dcreate2(file.get(), "/sections/perimeter", H5T_IEEE_F64LE, hdf::extent(1, &two).get(),
                                          H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                               H5Dclose, "perimeter");
    }
    const Strings unread = write_index(directory, models, "", "");
    ASSERT_EQ(unread.size(), 2U);
    EXPECT_NE(unread[0].find("b.hdf"), std::string::npos) << unread[0];
    EXPECT_NE(unread[1].find("c.hdf"), std::string::npos) << unread[1];
    const ArchiveFile index(directory / "cohort.h5");
    EXPECT_EQ(index.strings("/tables/branches/id"), (Strings{"d", "d", "d"}));
}

TEST(IndexRows, AFileReplacedMeanwhileHasMissingRows) {
    const auto directory = sample_archive({sample_record("a"), sample_record("b")}, "index_replaced");
    const std::vector<ModelSummary> models = list_models(directory);
    // The labels are asked for between the two looks at each file.
    const BranchLabeller label = [&](std::span<const BranchTree> trees) {
        write_model_file(model_path(directory, "a"), failed_record("a"));
        return std::vector<BranchLabels>(trees.size());
    };
    const Strings unread = write_index(directory, models, "", "", label);
    ASSERT_EQ(unread.size(), 1U);
    EXPECT_NE(unread[0].find("was replaced while the index was made"), std::string::npos) << unread[0];
    const ArchiveFile index(directory / "cohort.h5");
    EXPECT_EQ(index.strings("/tables/branches/id"), (Strings{"a", "a", "a", "b", "b", "b"}));
    const std::vector<double> length = index.numbers("/tables/branches/length");
    EXPECT_TRUE(std::isnan(length[0]));
    EXPECT_EQ(index.numbers("/tables/branches/parent")[1], -1);
    EXPECT_FALSE(std::isnan(length[3]));
}

TEST(IndexRows, AFileThatCouldNotBeReplacedIsOfAnEarlierRun) {
    const auto directory = sample_archive({sample_record("a")}, "index_stale");
    std::vector<ModelSummary> models = list_models(directory);
    models[0].failure = Failure{Stage::kArchive, ErrorCode::kArchiveWrite, "the disk is full"};
    write_index(directory, models, "", "");
    EXPECT_TRUE(ArchiveFile(directory / "cohort.h5").strings("/tables/branches/id").empty());
}

TEST(IndexRows, TheDictionaryHasEveryColumnOfEveryTable) {
    const auto directory = sample_archive({sample_record("a"), failed_record("b")}, "index_dictionary");
    const ArchiveFile index(directory / "cohort.h5");
    const Strings tables = index.strings("/dictionary/table"), columns = index.strings("/dictionary/column"),
                  types = index.strings("/dictionary/type"), units = index.strings("/dictionary/unit"),
                  definitions = index.strings("/dictionary/definition"), sources = index.strings("/dictionary/source");
    std::size_t count = 0;
    for (const ArchiveNode& node : index.nodes()) {
        if (node.is_group || !node.path.starts_with("/tables/")) continue;
        ++count;
        std::size_t k = 0;
        while (k < tables.size() && "/tables/" + tables[k] + "/" + columns[k] != node.path) ++k;
        ASSERT_LT(k, tables.size()) << node.path;
        EXPECT_EQ(types[k], node.type) << node.path;
        EXPECT_EQ(units[k], node.units) << node.path;
        EXPECT_EQ(definitions[k], node.description) << node.path;
        EXPECT_EQ(sources[k], index.attribute(node.path, "source").value_or("")) << node.path;
    }
    EXPECT_EQ(count, tables.size());
    EXPECT_NE(std::find(columns.begin(), columns.end(), "age"), columns.end()) << "covariates are columns";
    EXPECT_NE(std::find(sources.begin(), sources.end(), "Murray 1926, PNAS 12:207"), sources.end());
}

}  // namespace
}  // namespace lumenline
