// The validator finds nothing in what the program writes, and each of its checks is seen to fail on data that break it.
#include "io/archive/validate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/archive/pack.h"
#include "io/archive/read.h"
#include "io/archive/specification.h"
#include "tests/cli/process.h"
#include "tests/damage/sample_cohort.h"

namespace lumenline::damage {
namespace {

namespace fs = std::filesystem;
using cli_test::read_text;
using cli_test::write_text;
using Numbers = std::vector<double>;

std::string sentences(const fs::path& archive) {
    std::string text;
    for (const Finding& finding : validate_archive(archive).findings) text += finding.sentence() + "\n";
    return text;
}

TEST(ValidateArchive, WhatTheProgramWritesIsAsSpecified) {
    const fs::path archive = sample_cohort();
    EXPECT_EQ(sentences(archive), "");
    const Validation whole = validate_archive(archive);
    EXPECT_EQ(whole.files, 3U) << "the index and two models";
    EXPECT_EQ(whole.others, 0U);
    const std::size_t of_model = validate_archive(whole_model(archive)).datasets;
    EXPECT_EQ(of_model, model_specification().size()) << "the sample has everything that a model can have";
    pack_archive(archive, archive / "one.h5", nullptr);
    EXPECT_EQ(sentences(archive / "one.h5"), "");
    EXPECT_EQ(validate_archive(archive / "one.h5").files, 3U);
    EXPECT_THROW(validate_archive(archive / "nowhere"), UnknownName);
}

/// Damages each dataset in one of four ways, several of them at a time that have little to do with each other, and
/// expects a finding of each.
void expect_each_named(const fs::path& file, const std::vector<Specified>& specification) {
    constexpr std::size_t kAtATime = 8;
    const std::string bytes = read_text(file);
    const std::size_t batches = (specification.size() + kAtATime - 1) / kAtATime;
    for (std::size_t batch = 0; batch < batches; ++batch)
        for (const Harm harm : kHarms) {
            write_text(file, bytes);
            std::vector<std::string> harmed;
            for (std::size_t k = batch; k < specification.size(); k += batches)
                if (const std::string& path = specification[k].path;
                    path != names::kAnyCovariate && harm_dataset(file, path, harm))
                    harmed.push_back(path);
            const std::string found = sentences(file);
            for (std::string path : harmed) {
                // Nothing else has the length of these: what points into them shows that they are cut short.
                if (harm == Harm::kShortened && path == "/voronoi/polygon_vertices") path = "/voronoi/polygon_offsets";
                EXPECT_NE(found.find(file.string() + ": " + path + ": "), found.npos)
                    << path << " " << name_of(harm) << "\n"
                    << found;
            }
        }
}

TEST(ValidateArchive, EveryDatasetOfAModelThatIsDamagedIsNamed) {
    expect_each_named(whole_model(sample_cohort()), model_specification());
}

TEST(ValidateArchive, EveryDatasetOfAnIndexThatIsDamagedIsNamed) {
    const fs::path archive = sample_cohort();
    fs::remove_all(archive / "models");
    expect_each_named(archive / "cohort.h5", index_specification());
}

TEST(ValidateArchive, DamageIsSaidWhereItIsAndNotAgain) {
    const fs::path file = whole_model(sample_cohort());
    const std::string bytes = read_text(file);
    for (std::size_t k = 0; k < model_specification().size(); k += 17)
        for (const Harm harm : {Harm::kRemoved, Harm::kRetyped, Harm::kGarbled}) {
            if (model_specification()[k].path == "/voronoi/polygon_vertices") continue;  // nothing else has its length
            write_text(file, bytes);
            if (!harm_dataset(file, model_specification()[k].path, harm)) continue;
            EXPECT_EQ(validate_archive(file).findings.size(), 1U)
                << name_of(harm) << " " << model_specification()[k].path << "\n"
                << sentences(file);
        }
}

struct Change {
    const char* path;
    void (*change)(Numbers&);
    const char* said;
    const char* place = nullptr;  ///< where it shows, if not in the dataset itself
};

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(ValidateArchive, EveryCheckIsSeenToFail) {
    const Change changes[] = {
        {"/surface/points", [](Numbers& v) { v[7] = kNaN; }, "is not a finite number at 7"},
        {"/surface/points", [](Numbers& v) { v[0] += 0.5; }, "does not touch", "/voronoi/polygon_sites"},
        {"/surface/triangles", [](Numbers& v) { v[4] = 1e6; }, "is not a whole number from 0 to"},
        {"/surface/triangles", [](Numbers& v) { v[0] = v[1]; }, "has one end"},
        {"/surface/triangles", [](Numbers& v) { std::swap(v[0], v[1]); }, "of one direction"},
        {"/surface/triangles", [](Numbers& v) { v[0] = v[30]; }, "has no triangle on its other side"},
        {"/surface/normals", [](Numbers& v) { v[0] *= 2, v[1] *= 2, v[2] *= 2; }, "no unit vector at 0"},
        {"/surface/origin", [](Numbers& v) { v[3] = 3; }, "from 0 to 2 at 3"},
        {"/surface/pole", [](Numbers& v) { v[0] = v[v.size() / 2]; }, "does not touch it"},
        {"/surface/geodesic_distance", [](Numbers& v) { v[0] *= 1.01; }, "by eq. 7"},
        {"/surface/normalized_tangency_deviation", [](Numbers& v) { v[0] = 1.01; }, "from 0 to 1"},
        {"/surface/normalized_tangency_deviation", [](Numbers& v) { v[0] = 0.999; }, "by eq. 8"},
        {"/surface/euclidean_distance", [](Numbers& v) { v[0] *= 0.9; }, "its centerline_point is at"},
        {"/surface/descent_length",
         [](Numbers& v) {
             for (double& x : v) x = 0;
         },
         "has a way of"},
        {"/surface/centerline_id", [](Numbers& v) { v[0] = -1; }, "without a centerline", "/surface/branch_id"},
        {"/surface/zone", [](Numbers& v) { v[0] = v[0] == 0 ? 1 : 0; }, "sites have zone 0",
         "/characterization/wall_sites"},
        {"/surface/angle", [](Numbers& v) { v[0] = 4; }, "from -3.142"},
        {"/endpoints/radius", [](Numbers& v) { v[0] = 0; }, "above 0"},
        {"/endpoints/normal", [](Numbers& v) { v[0] = v[1] = v[2] = 2; }, "no unit vector"},
        {"/voronoi/ball_radius",
         [](Numbers& v) {
             for (double& x : v) x *= 1.1;
         },
         "does not touch", "/voronoi/polygon_sites"},
        {"/voronoi/polygon_offsets", [](Numbers& v) { std::swap(v[3], v[4]); }, "the offsets fall"},
        {"/voronoi/polygon_offsets", [](Numbers& v) { v[0] = 1; }, "do not run from 0"},
        {"/voronoi/polygon_vertices", [](Numbers& v) { v[0] = -1; }, "from 0 to"},
        {"/voronoi/polygon_sites", [](Numbers& v) { v[0] = v[0] < 0 ? 0 : -1; }, "has one site"},
        {"/voronoi/arrival_time", [](Numbers& v) { v[0] = -1; }, "or +inf at 0"},
        {"/voronoi/arrival_time", [](Numbers& v) { v[5] = std::numeric_limits<double>::infinity(); },
         "by /voronoi/arrival_time", "/voronoi/reached"},
        {"/voronoi/centerline_distance",
         [](Numbers& v) {
             for (double& x : v) x *= x;
         },
         "changes by more than their distance"},
        {"/voronoi/sources", [](Numbers& v) { v[0] = 1; }, "no inlet"},
        {"/centerlines/offsets", [](Numbers& v) { v.back() -= 1; }, "do not run from 0"},
        {"/centerlines/radius", [](Numbers& v) { v[2] = -v[2]; }, "above 0 at 2"},
        {"/centerlines/ball_radius", [](Numbers& v) { v[2] *= 0.5; }, "contradicts the distance to the wall"},
        {"/centerlines/clearance", [](Numbers& v) { v[2] = 0; }, "contradicts the distance to the wall",
         "/centerlines/ball_radius"},
        {"/centerlines/abscissa", [](Numbers& v) { v[3] = 0; }, "less than the one before it"},
        {"/centerlines/abscissa",
         [](Numbers& v) {
             for (double& x : v) x *= 1.001;
         },
         "long up to point"},
        {"/centerlines/target", [](Numbers& v) { v[0] = -1; }, "ends neither"},
        {"/centerlines/branch_id", [](Numbers& v) { v[0] = 3; }, "from 0 to 2"},
        {"/centerlines/tangent", [](Numbers& v) { v[0] += 0.1; }, "no unit vector"},
        {"/centerlines/path/abscissa", [](Numbers& v) { v[1] *= 0.5; }, "long up to point"},
        {"/centerlines/path/line_abscissa", [](Numbers& v) { v.back() *= 2; }, "beyond the end of its line"},
        {"/graph/edges", [](Numbers& v) { std::swap(v[0], v[1]); }, "is not that of /graph/edges",
         "/branches/first_node"},
        {"/graph/junction_id",
         [](Numbers& v) {
             for (double& x : v) x = -1;
         },
         "of kind junction"},
        {"/branches/branch_id", [](Numbers& v) { v[0] = 1; }, "is not that of its row"},
        {"/branches/length", [](Numbers& v) { v[0] = -1; }, "from 0"},
        {"/sections/closed", [](Numbers& v) { v[0] = 2; }, "from 0 to 1"},
        {"/sections/area", [](Numbers& v) { v[0] *= 1.5; }, "it differs from the column area of /sections",
         "/index_rows"},
        {"/endpoints/radius", [](Numbers& v) { v[0] *= 1.5; }, "it differs from the column radius of /endpoints",
         "/index_rows"},
        {"/index_rows", [](Numbers& v) { v[100] = v[100] > 0 ? 0 : 1; }, "its sum is not that of its bytes"},
        {"/timing/total_seconds", [](Numbers& v) { v[0] = -1; }, "from 0"},
        {"/provenance/threads", [](Numbers& v) { v[0] = 0; }, "from 1"},
        {"/VTKHDF/Points", [](Numbers& v) { v[0] += 1; }, "is not that of /surface/points"},
        {"/VTKHDF/Connectivity", [](Numbers& v) { v[0] = 0, v[1] = 0; }, "is not that of /surface/triangles"},
        {"/VTKHDF/Types", [](Numbers& v) { v[0] = 4; }, "is not that of triangles"},
    };
    const fs::path file = whole_model(sample_cohort());
    const std::string bytes = read_text(file);
    for (const Change& change : changes) {
        write_text(file, bytes);
        change_numbers(file, change.path, change.change);
        const std::string found = sentences(file), place = change.place != nullptr ? change.place : change.path;
        const std::size_t at = found.find(": " + place + ": ");
        ASSERT_NE(at, found.npos) << change.path << " should be found at " << place << "\n" << found;
        EXPECT_NE(found.substr(at, found.find('\n', at) - at).find(change.said), found.npos)
            << change.path << " should say '" << change.said << "'\n"
            << found;
    }
}

TEST(ValidateArchive, WrongAttributesAreNamed) {
    const fs::path file = whole_model(sample_cohort());
    const std::string bytes = read_text(file);
    for (const auto& [object, name, text, said] :
         {std::tuple("/", "status", "fine", "is none of ok, warning, failed"), std::tuple("/", "id", "", "\n"),
          std::tuple("/", "coordinate_system", "XYZ", "is none of LPS"),
          std::tuple("/surface", "genus", "2", "have 0 handles"),
          std::tuple("/surface", "genus", "two", "not a number"),
          std::tuple("/surface", "component_count", "7", "form 1 component"),
          std::tuple("/surface", "diagonal", "0", "is no positive number"),
          std::tuple("/surface/points", "units", "m", "the unit is 'm', not 'mm'"),
          std::tuple("/surface/points", "description", "", "is missing or empty")}) {
        write_text(file, bytes);
        set_attribute(file, object, name, text);
        const std::string found = sentences(file);
        if (std::string(name) == "id") continue;  // a file alone has no other name to hold it against
        EXPECT_NE(found.find(said), found.npos) << object << "@" << name << "\n" << found;
    }
}

TEST(ValidateArchive, IndexIsHeldAgainstItsModels) {
    const fs::path archive = sample_cohort();
    const fs::path index = archive / "cohort.h5", model = whole_model(archive);
    const std::string bytes = read_text(index), model_bytes = read_text(model);
    const auto expect = [&](const std::string& said) {
        const std::string found = sentences(archive);
        EXPECT_NE(found.find(said), found.npos) << said << "\n" << found;
        write_text(index, bytes);
        write_text(model, model_bytes);
    };
    change_numbers(index, "/tables/models/sites", [](Numbers& v) { v[0] += 1; });
    expect("of the model 'forked' is not that of its file");
    change_numbers(index, "/tables/models/radius_min", [](Numbers& v) { v[0] *= 2; });
    expect("/tables/models/radius_min: of the model 'forked'");
    set_attribute(model, "/", "inputs_sha256", std::string(64, 'f'));
    expect("/tables/models/inputs_sha256: of the model 'forked'");
    set_attribute(model, "/", "id", "other");
    expect("is 'other', but the model is called 'forked'");
    write_text(index, bytes);
    std::string renamed = bytes;
    for (std::size_t at = 0; (at = renamed.find("broken", at)) != renamed.npos; ++at) renamed.replace(at, 6, "forked");
    write_text(index, renamed);
    expect("'forked' is there twice");
    fs::remove(model);
    expect("does not exist");
    write_text(model, model_bytes.substr(0, model_bytes.size() / 2));
    expect("no complete HDF5 file");
}

TEST(ValidateArchive, DatasetsOfOthersAreAllowedAndCounted) {
    const fs::path file = whole_model(sample_cohort());
    copy_dataset(file, "/surface/points", "/notes");
    EXPECT_EQ(validate_archive(file).others, 1U);
    EXPECT_EQ(sentences(file), "");
}

TEST(ValidateArchive, CommandExitsWithOneAndOneSentenceAFinding) {
    const fs::path archive = sample_cohort();
    const auto clean = cli_test::run_lumenline({"validate-archive", archive.string()}, archive);
    EXPECT_EQ(clean.status, 0) << clean.out;
    EXPECT_NE(clean.out.find("all as specified"), clean.out.npos);
    harm_dataset(whole_model(archive), "/centerlines/radius", Harm::kRemoved);
    const auto harmed = cli_test::run_lumenline({"validate-archive", archive.string()}, archive);
    EXPECT_EQ(harmed.status, 1);
    EXPECT_NE(harmed.out.find("/centerlines/radius: is missing\n"), harmed.out.npos) << harmed.out;
    EXPECT_EQ(cli_test::run_lumenline({"validate-archive", "nowhere"}, archive).status, 2);
}

}  // namespace
}  // namespace lumenline::damage
