// Branches in the model file and in the index: every column back as it was, contradictions refused.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/branch_tables.h"
#include "io/archive/index.h"
#include "io/archive/model_file.h"
#include "io/archive/read.h"
#include "io/archive/tables.h"
#include "tests/archive/sample_record.h"

namespace lumenline {
namespace {

std::filesystem::path written(const ModelRecord& record, const std::string& name) {
    const std::filesystem::path file = fresh_directory("branches_" + name) / "m.hdf";
    write_model_file(file, record);
    return file;
}

TEST(BranchesInFile, TablesComeBackWithTheirDefinitions) {
    const ModelRecord record = sample_record();
    const ArchiveFile file(written(record, "tables"));
    std::vector<Table> read = branch_tables(Branches());
    const std::vector<Table> expected = branch_tables(*record.branches);
    for (std::size_t t = 0; t < read.size(); ++t) {
        ASSERT_TRUE(hdf::read_table(file, std::string("/") + read[t].name, read[t]));
        EXPECT_GT(read[t].rows(), 0U) << read[t].name;
        for (std::size_t c = 0; c < read[t].columns.size(); ++c)
            expect_same(read[t].columns[c].numbers, expected[t].columns[c].numbers, expected[t].columns[c].name);
    }
    EXPECT_EQ(file.attribute("/stenoses/nascet_diameter", "description"), "1 - diameter / distal_reference");
    EXPECT_EQ(file.attribute("/stenoses/nascet_diameter", "source"), "NASCET 1991, N Engl J Med 325:445");
    EXPECT_EQ(file.attribute("/sections/area", "units"), "mm^2");
    EXPECT_EQ(file.attribute("/graph/axis/curvature", "units"), "1/mm");
    EXPECT_EQ(file.strings("/graph/kind"), (std::vector<std::string>{"end", "junction", "end", "end"}));
}

TEST(BranchesInFile, AMissingColumnIsReadAsMissingValues) {
    const ArchiveFile file(written(sample_record(), "missing"));
    Table table = branch_tables(Branches())[0];
    table.columns.push_back({"later", "1", "", "", ColumnKind::kNumber, {}, {}});
    ASSERT_TRUE(hdf::read_table(file, "/branches", table));
    ASSERT_EQ(table.columns.back().numbers.size(), 3U);
    EXPECT_TRUE(std::isnan(table.columns.back().numbers[0]));
    EXPECT_FALSE(hdf::read_table(file, "/no_such_table", table));
}

TEST(BranchesInFile, ContradictionsAreRefused) {
    for (int fault = 0; fault < 4; ++fault) {
        ModelRecord record = sample_record();
        auto branches = std::make_shared<Branches>(*record.branches);
        if (fault == 0) branches->table.taper.pop_back();
        if (fault == 1) branches->lines.radius.pop_back();
        if (fault == 2) branches->points.torsion.pop_back();
        if (fault == 3) branches->surface.angle.pop_back();
        record.branches = branches;
        EXPECT_THROW(written(record, "fault"), StageError) << fault;
    }
}

TEST(BranchesInIndex, RowsOfAllModelsCarryTheirIds) {
    const auto directory = sample_archive({sample_record("z"), failed_record("b"), sample_record("a")}, "index_tables");
    const ArchiveFile index(directory / "cohort.h5");
    using Strings = std::vector<std::string>;
    EXPECT_EQ(index.strings("/tables/branches/id"), (Strings{"z", "z", "z", "a", "a", "a"}));
    EXPECT_EQ(index.strings("/tables/bifurcations/id"), (Strings{"z", "a"}));
    EXPECT_EQ(index.numbers("/tables/branches/branch_id"), (std::vector<double>{0, 1, 2, 0, 1, 2}));
    EXPECT_EQ(index.strings("/tables/endpoints/role").size(), 8U);
    EXPECT_EQ(index.numbers("/tables/endpoints/branch_id"), (std::vector<double>{0, 1, -1, 2, 0, 1, -1, 2}));
    EXPECT_EQ(index.attribute("/tables/sections/area", "units"), "mm^2");
    EXPECT_FALSE(index.has("/tables/patches"));
}

}  // namespace
}  // namespace lumenline
