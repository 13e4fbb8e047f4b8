// What archive.fields leaves out, and that nothing else changes.

#include <gtest/gtest.h>

#include "io/archive/index.h"
#include "io/archive/model_file.h"
#include "io/archive/read.h"
#include "tests/archive/sample_record.h"

namespace lumenline {
namespace {

TEST(ArchiveFields, LeaveOutTheDiagramThenTheSurface) {
    const ModelRecord record = sample_record();
    const auto directory = fresh_directory("fields");
    const auto written = [&](ArchiveFields fields) {
        const auto file = directory / (std::string(fields_name(fields)) + ".hdf");
        write_model_file(file, record, {.fields = fields});
        return ArchiveFile(file);
    };
    const ArchiveFile all = written(ArchiveFields::kAll), surface = written(ArchiveFields::kSurface),
                      lines = written(ArchiveFields::kLines);
    EXPECT_EQ(all.attribute("/", "fields"), "all");
    EXPECT_EQ(surface.attribute("/", "fields"), "surface");
    EXPECT_EQ(lines.attribute("/", "fields"), "lines");
    for (const char* const path : {"/voronoi", "/surface/pole"}) {
        EXPECT_TRUE(all.has(path)) << path;
        EXPECT_FALSE(surface.has(path)) << path;
        EXPECT_FALSE(lines.has(path)) << path;
    }
    for (const char* const path : {"/surface/points", "/surface/geodesic_distance", "/surface/branch_id"}) {
        EXPECT_TRUE(surface.has(path)) << path;
        EXPECT_FALSE(lines.has(path)) << path;
    }
    for (const ArchiveFile* const file : {&surface, &lines})
        for (const char* const path : {"/centerlines/points", "/characterization/geodesic_distance", "/branches/length",
                                       "/endpoints/radius", "/graph/edges", "/diagnostics/code"})
            EXPECT_EQ(file->shape(path), all.shape(path)) << path;
    const double line_points = static_cast<double>(record.centerlines->points.size());
    EXPECT_EQ(surface.numbers("/VTKHDF/Points"), all.numbers("/VTKHDF/Points"));
    EXPECT_EQ(lines.numbers("/VTKHDF/NumberOfPoints"), (std::vector<double>{line_points}));
    EXPECT_EQ(lines.numbers("/VTKHDF/NumberOfCells"), (std::vector<double>{2}));
}

TEST(ArchiveFields, SummariesAreTheSame) {
    const ModelRecord record = sample_record();
    const auto directory = fresh_directory("summaries");
    for (const ArchiveFields fields : {ArchiveFields::kAll, ArchiveFields::kSurface, ArchiveFields::kLines}) {
        const auto file = directory / (std::string(fields_name(fields)) + ".hdf");
        write_model_file(file, record, {.fields = fields});
        EXPECT_EQ(difference(read_summary(file), summarize(record)), "") << file;
    }
}

}  // namespace
}  // namespace lumenline
