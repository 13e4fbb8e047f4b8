// Every variant of every format gives exactly the triangles that were written down by hand.

#include <gtest/gtest.h>

#include "io/mesh/formats.h"
#include "io/mesh/mesh_io.h"
#include "io/mesh/sha256.h"
#include "tests/mesh/samples.h"
#include "tests/mesh/vtk_samples.h"

namespace lumenline {
namespace {

using samples::Sample;

TriangleSoup parse(const std::string& name, const std::string& bytes) { return mesh::parse_surface({name, bytes}); }

class ReadSample : public ::testing::TestWithParam<Sample> {};

TEST_P(ReadSample, GivesItsTriangles) {
    const TriangleSoup soup = parse(GetParam().name, GetParam().bytes);
    EXPECT_EQ(samples::corners_of(soup), GetParam().corners);
}

INSTANTIATE_TEST_SUITE_P(MeshRead, ReadSample, ::testing::ValuesIn(samples::all()),
                         [](const auto& test) { return samples::test_name(test.param); });

TEST(MeshRead, FileGivesPathAndDigestOfItsBytes) {
    const Sample& sample = samples::named("binary.stl");
    const std::string path = samples::write_temporary("read.stl", sample.bytes);
    const TriangleSoup soup = read_surface(path);
    EXPECT_EQ(samples::corners_of(soup), sample.corners);
    EXPECT_EQ(soup.source_file, path);
    EXPECT_EQ(soup.source_sha256, sha256_hex(sample.bytes));
}

TEST(MeshRead, ContentCountsMoreThanTheExtension) {
    for (const Sample& sample : samples::all()) {
        if (sample.name.ends_with(".obj") || sample.name == "bare.off") continue;  // these bear no mark
        for (const std::string name : {"x.obj", "x.stl", "x", "x.unknown"}) {
            EXPECT_EQ(samples::corners_of(parse(name, sample.bytes)), sample.corners) << sample.name << " as " << name;
        }
    }
}

TEST(MeshRead, ExtensionCountsInAnyCase) {
    const Sample& sample = samples::named("plain.obj");
    EXPECT_EQ(samples::corners_of(parse("X.OBJ", sample.bytes)), sample.corners);
}

TEST(MeshRead, StlCornersBecomeOnePointOnlyWhereIdentical) {
    // Eight distinct corners, shared by 36; -0.0 is +0.0.
    EXPECT_EQ(parse("a", samples::named("binary_solid.stl").bytes).points.size(), 8U);
    EXPECT_EQ(parse("a", samples::named("ascii.stl").bytes).points.size(), 4U);
    TriangleSoup apart = samples::tetrahedron();
    apart.points.push_back({0, std::nextafter(2.0F, 3.0F), 0});  // one bit beside point 2
    apart.triangles[3][2] = 4;
    const TriangleSoup soup = parse("a", samples::binary_stl(apart, ""));
    EXPECT_EQ(soup.points.size(), 5U);
    EXPECT_EQ(samples::corners_of(soup), samples::corners_of(apart));
}

TEST(MeshRead, StlOfManyPointsKeepsThemApart) {
    // Enough points to let the corner table grow several times beyond its first guess.
    TriangleSoup fan;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        fan.points.push_back({static_cast<double>(i), static_cast<double>(i % 7), 1});
        fan.points.push_back({static_cast<double>(i), static_cast<double>(i % 7), 2});
        fan.points.push_back({static_cast<double>(i), static_cast<double>(i % 7) + 0.5, 1});
        fan.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const TriangleSoup soup = parse("a", samples::binary_stl(fan, ""));
    EXPECT_EQ(soup.points, fan.points);
    EXPECT_EQ(soup.triangles, fan.triangles);
}

TEST(MeshRead, QuadIsCutAlongItsShorterDiagonal) {
    const std::string points = "OFF 4 1\n0 0 0\n1 -3 0\n2 0 0\n1 3 0\n";  // 0-2 is 2 long, 1-3 is 6
    using Triangles = std::vector<std::array<std::uint32_t, 3>>;
    EXPECT_EQ(parse("a", points + "4 0 1 2 3\n").triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(parse("a", points + "4 1 2 3 0\n").triangles, (Triangles{{1, 2, 0}, {2, 3, 0}}));
}

TEST(MeshRead, LargerPolygonBecomesAFan) {
    const TriangleSoup soup = parse("a", "OFF 5 1\n0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n5 0 1 2 3 4\n");
    using Triangles = std::vector<std::array<std::uint32_t, 3>>;
    EXPECT_EQ(soup.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(MeshRead, DegenerateTrianglesAndUnusedPointsAreKept) {
    const TriangleSoup soup = parse("a", "OFF 4 2\n0 0 0\n1 0 0\n0 1 0\n9 9 9\n3 0 1 1\n3 0 1 2\n");
    EXPECT_EQ(soup.triangles.size(), 2U);
    EXPECT_EQ(soup.points.size(), 4U);
}

TEST(MeshRead, PlyBodyMayBeginWithALineEndByte) {
    // The first coordinate's first byte is 0x0A: it belongs to the data, not to the header's line end.
    TriangleSoup solid = samples::tetrahedron();
    solid.points[0].x = std::bit_cast<float>(0x3F80000AU);
    std::string bytes =
        "ply\rformat binary_little_endian 1.0\relement vertex 4\rproperty float x\rproperty float y\r"
        "property float z\relement face 1\rproperty list uchar uchar vertex_index\rend_header\r";
    for (const Vec3& p : solid.points) {
        for (const double x : {p.x, p.y, p.z}) bytes += samples::bytes_of(static_cast<float>(x), std::endian::little);
    }
    bytes += std::string("\3\0\1\2", 4);
    EXPECT_EQ(parse("a.ply", bytes).points, solid.points);
}

TEST(MeshRead, ByteOrderMarkBeforeTextIsPassedOver) {
    for (const std::string name : {"plain.obj", "plain.off", "ascii.stl"}) {
        const Sample& sample = samples::named(name);
        EXPECT_EQ(samples::corners_of(parse(name, "\xEF\xBB\xBF" + sample.bytes)), sample.corners) << name;
    }
}

TEST(MeshRead, VtpNumbersOfEveryType) {
    samples::VtpPiece piece = samples::tetrahedron_piece();
    piece.points = {{0, 0, 0}, {100, 0, 0}, {0, 120, 0}, {5, 10, 127}};  // in Int8 too
    for (const std::string type :
         {"Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64", "Float32", "Float64"}) {
        for (auto [name, style] : samples::vtp_styles()) {
            SCOPED_TRACE(name + " " + type);
            style.point_type = style.index_type = type;
            const TriangleSoup soup = parse("a", samples::vtp_file({piece}, style));
            EXPECT_EQ(soup.points, piece.points);
            EXPECT_EQ(soup.triangles,
                      (std::vector<std::array<std::uint32_t, 3>>{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {3, 2, 0}}));
        }
    }
}

TEST(MeshRead, LegacyVtkOfEveryVersion) {
    const Sample& sample = samples::named("old.vtk");
    for (const std::string version : {"1.0", "2.0", "3.0", "4.0", "4.1", "4.2", "5.0", "5.1"}) {
        std::string bytes = sample.bytes;
        bytes.replace(bytes.find("1.0"), 3, version);
        EXPECT_EQ(samples::corners_of(parse("a", bytes)), sample.corners) << version;
    }
}

// Digests of the standard's own examples (FIPS 180-4, and the empty string).
TEST(Sha256, KnownDigests) {
    EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256_hex(std::string_view{}), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    const std::array<std::byte, 3> abc{std::byte{'a'}, std::byte{'b'}, std::byte{'c'}};
    EXPECT_EQ(sha256_hex(abc), sha256_hex("abc"));
}

}  // namespace
}  // namespace lumenline
