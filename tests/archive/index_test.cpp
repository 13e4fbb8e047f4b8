#include "io/archive/index.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>

#include "io/archive/handle.h"
#include "io/archive/model_file.h"
#include "io/archive/read.h"
#include "tests/archive/sample_record.h"

namespace lumenline {
namespace {

using Strings = std::vector<std::string>;

ModelSummary with_covariates(const std::string& id, std::vector<std::pair<std::string, std::string>> covariates) {
    ModelRecord record = sample_record(id);
    record.identity.covariates = std::move(covariates);
    return summarize(record);
}

TEST(Index, RowsComeBackInOrder) {
    const std::vector<ModelRecord> records{sample_record("z"), failed_record("b"), sample_record("a")};
    const auto directory = sample_archive(records, "rows");
    const std::vector<ModelSummary> read = list_models(directory);
    ASSERT_EQ(read.size(), 3U);
    for (std::size_t i = 0; i < read.size(); ++i) {
        ModelSummary expected = summarize(records[i]);
        expected.identity.covariates.clear();
        EXPECT_EQ(difference(read[i], expected), "") << i;
    }
    EXPECT_EQ(list_models(directory / "cohort.h5").size(), 3U) << "the index itself names its archive";
}

TEST(Index, ItCanBeMadeAgainFromTheModelFiles) {
    const auto directory = sample_archive({sample_record("a"), failed_record("b")}, "again");
    const std::string before = bytes_of(directory / "cohort.h5");
    std::filesystem::remove(directory / "cohort.h5");
    const std::vector<ModelSummary> models{read_summary(model_path(directory, "a")),
                                           read_summary(model_path(directory, "b"))};
    write_index(directory, models, "cohort: a\n", "cohort: a\nlength_unit: mm\n");
    EXPECT_EQ(bytes_of(directory / "cohort.h5"), before);
}

TEST(Index, ModelsWithoutLinesHaveNoLengths) {
    const auto directory = sample_archive({sample_record("a"), failed_record("b")}, "nan");
    const ArchiveFile index(directory / "cohort.h5");
    for (const char* column : {"length", "radius_min", "radius_mean", "radius_max"}) {
        const auto values = index.numbers(std::string("/tables/models/") + column);
        EXPECT_GT(values.at(0), 0) << column;
        EXPECT_TRUE(std::isnan(values.at(1))) << column;
    }
    EXPECT_EQ(index.strings("/tables/failures/id"), Strings{"b"});
    EXPECT_EQ(index.strings("/tables/failures/code"), Strings{"no_seed"});
    EXPECT_EQ(index.strings("/tables/models/failure_stage"), (Strings{"", "eikonal"}));
    EXPECT_EQ(index.strings("/config/resolved"), Strings{"cohort: a\nlength_unit: mm\n"});
    EXPECT_EQ(index.numbers("/timing/seconds"), (std::vector<double>{2.8, 2.8}));
}

TEST(Index, HandlesAndLoopsOfEachModel) {
    const auto directory = sample_archive({sample_record("a"), failed_record("b")}, "loops");
    const ArchiveFile index(directory / "cohort.h5");
    EXPECT_EQ(index.numbers("/tables/models/genus").at(0), 1);
    EXPECT_EQ(index.numbers("/tables/models/loops"), (std::vector<double>{1, 0}));
}

TEST(Index, LinksLeadToTheModels) {
    const auto directory = sample_archive({sample_record("a")}, "links");
    const hdf::Handle file(H5Fopen((directory / "cohort.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "open");
    const hdf::Handle points(H5Dopen2(file.get(), "/models/a/surface/points", H5P_DEFAULT), H5Dclose, "points");
    EXPECT_GE(points.get(), 0);
}

TEST(Index, LinksLeadToTheModelsAlsoAfterAMove) {
    const auto directory = sample_archive({sample_record("a")}, "move");
    const auto moved = fresh_directory("moved") / "here";
    std::filesystem::rename(directory, moved);
    const hdf::Handle file(H5Fopen((moved / "cohort.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "open");
    EXPECT_GE(hdf::Handle(H5Gopen2(file.get(), "/models/a", H5P_DEFAULT), H5Gclose, "model").get(), 0);
}

TEST(Index, CovariatesAreNumbersOnlyIfAllAre) {
    const auto directory = fresh_directory("covariates");
    const std::vector<ModelSummary> models{
        with_covariates("a", {{"age", "63.5"}, {"bmi", "n/a"}, {"visit", "1"}, {"unit", "1 mm"}}),
        with_covariates("b", {{"age", ""}, {"bmi", "21"}, {"visit", "two"}}), with_covariates("c", {{"late", "-1e3"}})};
    write_index(directory, models, "", "");
    const ArchiveFile index(directory / "cohort.h5");
    const auto age = index.numbers("/tables/models/age");
    EXPECT_EQ(age[0], 63.5);
    EXPECT_TRUE(std::isnan(age[1]) && std::isnan(age[2]));
    EXPECT_EQ(index.numbers("/tables/models/bmi")[1], 21);
    EXPECT_EQ(index.strings("/tables/models/visit"), (Strings{"1", "two", ""}));
    EXPECT_EQ(index.strings("/tables/models/unit"), (Strings{"1 mm", "", ""}));
    EXPECT_EQ(index.numbers("/tables/models/late")[2], -1000);
}

TEST(Index, CovariatesNeverTakeTheNameOfAColumn) {
    const auto directory = fresh_directory("names");
    const std::vector<ModelSummary> models{with_covariates("a", {{"status", "1"},
                                                                 {"weight/kg", "2"},
                                                                 {"covariate_status", "3"},
                                                                 {".", "4"},
                                                                 {"", "5"},
                                                                 {"failure_code", "6"}})};
    write_index(directory, models, "", "");
    const ArchiveFile index(directory / "cohort.h5");
    EXPECT_EQ(index.strings("/tables/models/status"), Strings{"warning"});
    EXPECT_EQ(index.numbers("/tables/models/covariate_status"), std::vector<double>{1});
    EXPECT_EQ(index.numbers("/tables/models/covariate_weight_kg"), std::vector<double>{2});
    EXPECT_EQ(index.numbers("/tables/models/covariate_covariate_status"), std::vector<double>{3});
    EXPECT_EQ(index.attribute("/tables/models/covariate_weight_kg", "column"), "weight/kg");
    EXPECT_EQ(index.numbers("/tables/models/covariate_."), std::vector<double>{4});
    EXPECT_EQ(index.numbers("/tables/models/covariate_failure_code"), std::vector<double>{6});
}

TEST(Index, EmptyCohortIsAnIndex) {
    const auto directory = fresh_directory("empty_cohort");
    write_index(directory, {}, "", "");
    EXPECT_TRUE(list_models(directory).empty());
}

TEST(Index, UnitOfDifferentModelsIsMixed) {
    std::vector<ModelSummary> models{summarize(sample_record("a")), summarize(sample_record("b"))};
    const auto directory = fresh_directory("units");
    write_index(directory, models, "", "");
    EXPECT_EQ(ArchiveFile(directory / "cohort.h5").attribute("/tables/models/length", "units"), "mm");
    models[1].identity.length_unit = "m";
    write_index(directory, models, "", "");
    EXPECT_EQ(ArchiveFile(directory / "cohort.h5").attribute("/tables/models/length", "units"), "mixed");
}

TEST(Index, IdsThatAreNoFileNamesOrAppearTwiceAreRefused) {
    const auto directory = fresh_directory("ids");
    for (const std::vector<std::string>& ids :
         {Strings{"../x"}, Strings{""}, Strings{".."}, Strings{"a", "b", "a"}, Strings{"a\xFF"}}) {
        std::vector<ModelSummary> models;
        for (const std::string& id : ids) models.push_back(summarize(sample_record(id)));
        EXPECT_THROW(write_index(directory, models, "", ""), StageError) << ids.front();
        EXPECT_TRUE(std::filesystem::is_empty(directory));
    }
}

TEST(Index, DirectoryThatDoesNotExistIsNamed) {
    try {
        write_index("/no/such/place", {}, "", "");
        FAIL();
    } catch (const StageError& error) {
        EXPECT_EQ(error.code(), ErrorCode::kArchiveWrite);
        EXPECT_NE(std::string(error.what()).find("/no/such/place/cohort.h5"), std::string::npos);
    }
}

TEST(Index, SecondsAloneDoNotChangeTheTables) {
    const auto directory = fresh_directory("seconds");
    std::vector<ModelSummary> models{summarize(sample_record("a"))};
    write_index(directory, models, "", "");
    const std::string first = bytes_of(directory / "cohort.h5");
    write_index(directory, models, "", "");
    EXPECT_EQ(bytes_of(directory / "cohort.h5"), first);
    models[0].seconds = 77;
    write_index(directory, models, "", "");
    const std::string second = bytes_of(directory / "cohort.h5");
    ASSERT_EQ(second.size(), first.size());
    std::size_t differing = 0;
    for (std::size_t i = 0; i < first.size(); ++i) differing += first[i] != second[i] ? 1 : 0;
    EXPECT_GT(differing, 0U);
    EXPECT_LE(differing, sizeof(double)) << "only the bytes of /timing/seconds";
}

TEST(UnchangedRows, AreThoseOfTheFilesUntilAFileChanges) {
    const auto archive = sample_archive({sample_record("a"), sample_record("b"), failed_record("c")}, "unchanged");
    const auto rows = read_unchanged_rows(archive);
    ASSERT_EQ(rows.size(), 3U);
    for (const auto& [id, row] : rows) {
        ModelSummary own = read_summary(model_path(archive, id));
        own.identity.covariates.clear();
        EXPECT_EQ(difference(row, own), "") << id;
    }
    const auto file = model_path(archive, "a");
    std::filesystem::last_write_time(file, std::filesystem::last_write_time(file) - std::chrono::seconds(1));
    std::filesystem::remove(model_path(archive, "b"));
    std::filesystem::resize_file(model_path(archive, "c"), 100);
    EXPECT_TRUE(read_unchanged_rows(archive).empty());
    write_bytes(archive / "cohort.h5", "no index");
    EXPECT_TRUE(read_unchanged_rows(archive).empty());
    EXPECT_TRUE(read_unchanged_rows(archive / "absent").empty());
}

TEST(ModelState, SignalOfACrashIsKept) {
    ModelRecord crashed = failed_record("x");
    crashed.failure->code = ErrorCode::kCrashed;
    crashed.failure->signal = 9;
    const auto archive = sample_archive({crashed}, "signal");
    const std::optional<ModelState> state = read_state(model_path(archive, "x"));
    ASSERT_TRUE(state && state->failure);
    EXPECT_EQ(state->failure->signal, 9);
    EXPECT_TRUE(is_transient(*state->failure)) << "killed from outside";
    crashed.failure->signal = 11;
    EXPECT_FALSE(is_transient(*crashed.failure));
}

}  // namespace
}  // namespace lumenline
