// The surface's characterization in the model file: every array back as it was, contradictions refused.
#include <gtest/gtest.h>

#include <cmath>

#include "io/archive/model_file.h"
#include "io/archive/read.h"
#include "tests/archive/sample_record.h"

namespace lumenline {
namespace {

using Numbers = std::vector<double>;

ArchiveFile written(const ModelRecord& record, const std::string& name, const ArchiveOptions& options = {}) {
    const std::filesystem::path file = fresh_directory("character_" + name) / "m.hdf";
    write_model_file(file, record, options);
    return ArchiveFile(file);
}

Numbers flat(const std::vector<Vec3>& points) {
    Numbers values;
    for (const Vec3& p : points) values.insert(values.end(), {p.x, p.y, p.z});
    return values;
}

TEST(ModelFile, CharacterOfTheSurfaceComesBack) {
    const ModelRecord record = sample_record();
    const SurfaceCharacter& character = *record.character;
    const ArchiveFile file = written(record, "all", {.float32_fields = false});
    const auto expect = [&](const char* path, const Numbers& values) {
        const Numbers read = file.numbers(path);
        ASSERT_EQ(read.size(), values.size()) << path;
        for (std::size_t i = 0; i < read.size(); ++i)
            EXPECT_TRUE(read[i] == values[i] || (std::isnan(read[i]) && std::isnan(values[i]))) << path << " " << i;
    };
    expect("/surface/geodesic_distance", character.geodesic_distance);
    expect("/surface/descent_length", character.descent_length);
    expect("/surface/euclidean_distance", character.euclidean_distance);
    expect("/surface/normalized_tangency_deviation", character.normalized_tangency_deviation);
    expect("/surface/geodesic_distance_refined", character.geodesic_distance_refined);
    expect("/surface/normalized_tangency_deviation_refined", character.normalized_tangency_deviation_refined);
    expect("/surface/abscissa", character.abscissa);
    expect("/surface/centerline_point", flat(character.centerline_point));
    expect("/surface/centerline_id", {0, 0, 1, 1, -1});
    expect("/surface/zone", {0, 0, 1, 2, 0});
    expect("/voronoi/centerline_distance", character.centerline_distance);
    expect("/characterization/jumps", {3, 4, 5});
    expect("/characterization/not_refined", {2});
    const ArchiveFile single = written(record, "single");
    EXPECT_EQ(single.numbers("/surface/geodesic_distance")[0], static_cast<double>(1.0F / 3.0F));
    EXPECT_EQ(single.numbers("/surface/centerline_point")[3], 1.0 / 3) << "coordinates are always double";
}

TEST(ModelFile, CharacterThatDoesNotFitTheSurfaceIsRefused) {
    ModelRecord record = sample_record();
    auto shorter = std::make_shared<SurfaceCharacter>(*record.character);
    shorter->abscissa.pop_back();
    record.character = shorter;
    EXPECT_THROW(written(record, "short"), StageError);
}

}  // namespace
}  // namespace lumenline
