// Damaged files: cut at every byte, and with random bytes changed. A reader either refuses with a StageError or
// gives a sound surface; it never crashes, and never gives a part of a surface where the format can tell.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "engine/core/errors.h"
#include "io/mesh/formats.h"
#include "tests/mesh/samples.h"

namespace lumenline {
namespace {

using samples::Sample;

class CorruptSample : public ::testing::TestWithParam<Sample> {};

void expect_sound(const TriangleSoup& soup) {
    EXPECT_FALSE(soup.triangles.empty());
    for (const Vec3& p : soup.points) {
        ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    }
    for (const auto& triangle : soup.triangles) {
        for (const std::uint32_t corner : triangle) ASSERT_LT(corner, soup.points.size());
    }
    EXPECT_TRUE(std::isfinite(soup.coordinate_rounding));
    for (const CellLabels& labels : soup.cell_labels) EXPECT_EQ(labels.values.size(), soup.triangles.size());
}

void expect_load_error(const StageError& error, const std::string& name) {
    EXPECT_EQ(error.stage(), Stage::kLoad);
    EXPECT_TRUE(std::string(error.what()).starts_with(name)) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
}

// An OBJ file has no counts, and several STL solids in one text file are not counted either: cut between two faces
// or solids, or within the last index of a face, they can be valid smaller files. Everywhere else a cut file must
// be refused or give all triangles.
TEST_P(CorruptSample, CutAnywhereIsRefusedOrComplete) {
    const Sample& sample = GetParam();
    std::size_t refused = 0;
    for (std::size_t size = 0; size < sample.bytes.size(); ++size) {
        // An exact allocation, so that the address sanitizer sees any byte read behind the end.
        const std::vector<char> cut(sample.bytes.begin(), sample.bytes.begin() + static_cast<std::ptrdiff_t>(size));
        try {
            const TriangleSoup soup = mesh::parse_surface({sample.name, {cut.data(), cut.size()}});
            expect_sound(soup);
            if (sample.can_shrink) {
                EXPECT_LE(soup.triangles.size(), sample.corners.size()) << "cut at byte " << size;
            } else {
                EXPECT_EQ(samples::corners_of(soup), sample.corners) << "cut at byte " << size;
            }
        } catch (const StageError& error) {
            expect_load_error(error, sample.name);
            ++refused;
        }
    }
    EXPECT_GT(refused, sample.bytes.size() / 3);
}

TEST_P(CorruptSample, RandomBytesAreRefusedOrSound) {
    const Sample& sample = GetParam();
    constexpr int kTrials = 1500;
    std::mt19937 random(20240607);
    std::size_t refused = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
        std::vector<char> bytes(sample.bytes.begin(), sample.bytes.end());
        for (std::uint32_t flips = 1 + random() % 4; flips > 0; --flips) {
            const std::size_t at = random() % bytes.size();
            // Half of the bytes become any byte, half another byte of the file, which is likelier to pass as syntax.
            bytes[at] = random() % 2 == 0 ? static_cast<char>(random() % 256) : sample.bytes[random() % bytes.size()];
        }
        try {
            expect_sound(mesh::parse_surface({sample.name, {bytes.data(), bytes.size()}}));
        } catch (const StageError& error) {
            expect_load_error(error, sample.name);
            ++refused;
        }
    }
    EXPECT_GT(refused, 0U);
}

TEST_P(CorruptSample, RepeatedAndLostStretchesAreRefusedOrSound) {
    const Sample& sample = GetParam();
    constexpr int kTrials = 500;
    std::mt19937 random(7);
    for (int trial = 0; trial < kTrials; ++trial) {
        const std::size_t from = random() % sample.bytes.size();
        const std::size_t to = random() % sample.bytes.size();
        const std::string bytes = sample.bytes.substr(0, from) + sample.bytes.substr(to);
        try {
            expect_sound(mesh::parse_surface({sample.name, bytes}));
        } catch (const StageError& error) {
            expect_load_error(error, sample.name);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(MeshCorruption, CorruptSample, ::testing::ValuesIn(samples::all()),
                         [](const auto& test) { return samples::test_name(test.param); });

}  // namespace
}  // namespace lumenline
