// What is refused, with which code, and what the sentence says.

#include "tests/mesh/refusal.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "engine/core/errors.h"
#include "io/mesh/cursor.h"
#include "io/mesh/formats.h"
#include "io/mesh/mesh_io.h"
#include "tests/mesh/samples.h"

namespace lumenline {
namespace {

using samples::changed;
using samples::expect_refused;

constexpr ErrorCode kFormat = ErrorCode::kFileFormat;
constexpr ErrorCode kCoordinate = ErrorCode::kBadCoordinate;
constexpr ErrorCode kNone = ErrorCode::kNoSurface;

TEST(MeshRefusal, UnknownContentNamesTheFormatsThatAreRead) {
    const std::string formats = "STL, PLY, OBJ, OFF, VTK XML polydata (.vtp) and legacy VTK (.vtk)";
    expect_refused({"a.gz", std::string("\x1f\x8b\x08\0", 4), kFormat, {formats, "'.gz'", "begins with '?"}});
    expect_refused({"noextension", "hello", kFormat, {formats, "''", "'hello'"}});
    expect_refused({"empty.stl", "", kFormat, {"empty"}});
}

TEST(MeshRefusal, Stl) {
    expect_refused({"a.stl", "hello", kFormat, {"84 + 50 n", "5 bytes"}});
    expect_refused({"a.stl", samples::named("binary.stl").bytes + "x", kFormat, {"285 bytes", "4 triangles", "284"}});
    expect_refused({"a.stl", samples::binary_stl({}, ""), kNone, {}});
    expect_refused({"a.stl", "solid\nendsolid\n", kNone, {}});
    expect_refused(
        {"a.stl", changed("ascii.stl", "vertex 1.5 0 0", "vertex 1.5 0"), kFormat, {"line 7:", "'endloop'"}});
    expect_refused({"a.stl", changed("ascii.stl", "1.5", "1,5"), kFormat, {"line 6:", "a coordinate", "'1,5'"}});
    expect_refused({"a.stl", changed("ascii.stl", "1.5", "nan"), kCoordinate, {"line 6:", "'nan'"}});
    expect_refused({"a.stl", changed("ascii.stl", "1.5", "1e999"), kCoordinate, {"line 6:", "'1e999'"}});
    expect_refused({"a.stl", samples::named("ascii.stl").bytes + "junk", kFormat, {"line 31:", "'solid'", "'junk'"}});
    std::string bytes = samples::named("binary.stl").bytes;
    bytes.replace(84 + 50 + 12, 4, samples::bytes_of(std::numeric_limits<float>::quiet_NaN(), std::endian::little));
    expect_refused({"a.stl", bytes, kCoordinate, {"byte 146:", "nan", "triangle 1"}});
}

TEST(MeshRefusal, Ply) {
    expect_refused({"a.ply", "plx\n", kFormat, {"line 1:", "'ply'", "'plx'"}});
    expect_refused({"a.ply",
                    changed("ascii.ply", "vertex 4", "vertex 4000000000"),
                    kFormat,
                    {"line 11:", "4000000000", "up to the end of the file"}});
    expect_refused({"a.ply", changed("ascii.ply", "vertex 4", "vertex -4"), kFormat, {"line 4:", "'-4'"}});
    expect_refused({"a.ply", changed("ascii.ply", "vertex 4", "vertex 5"), kFormat, {}});
    expect_refused({"a.ply", changed("ascii.ply", "3 0 2 1", "3 0 2 4"), kFormat, {"line 15:", "below", "4, found 4"}});
    expect_refused({"a.ply", changed("ascii.ply", "3 0 2 1", "2 0 2"), kFormat, {"line 15:", "at least 3", "found 2"}});
    expect_refused({"a.ply", changed("ascii.ply", "float y", "half y"), kFormat, {"line 6:", "'half'"}});
    expect_refused({"a.ply", changed("ascii.ply", "float y", "float q"), kFormat, {"line 4:", "'y'", "'vertex'"}});
    expect_refused({"a.ply", changed("ascii.ply", "float y", "float x"), kFormat, {"line 6:", "second 'x'"}});
    expect_refused({"a.ply", changed("ascii.ply", "format ascii 1.0", "comment"), kFormat, {"'format'"}});
    expect_refused({"a.ply", changed("ascii.ply", "face 4", "tristrips 4"), kFormat, {"'face'"}});
    expect_refused({"a.ply", changed("ascii.ply", "face 4", "face 0"), kNone, {"4 points"}});
    expect_refused({"a.ply", changed("ascii.ply", "uchar int", "float int"), kFormat, {"line 9:", "integer type"}});
    expect_refused({"a.ply", changed("ascii.ply", "+0.25", "-inf"), kCoordinate, {"line 14:", "'-inf'"}});
    const std::string nan = samples::bytes_of(std::numeric_limits<float>::infinity(), std::endian::big);
    const std::string value = samples::bytes_of(1.5F, std::endian::big);
    expect_refused({"a.ply",
                    changed("big.ply", value, nan),
                    kCoordinate,
                    {"byte " + std::to_string(samples::named("big.ply").bytes.find(value)) + ":", "inf"}});
    expect_refused({"a.ply",
                    changed("little.ply", std::string("\3\0\0\0\0", 5), std::string("\xFF\0\0\0\0", 5)),
                    kFormat,
                    {"byte", "255 corners"}});
}

TEST(MeshRefusal, Obj) {
    expect_refused({"a.obj", "v 0 0 0\nv 1 0 0\n", kNone, {"2 points"}});
    expect_refused({"a.obj", changed("plain.obj", "v 0 2 0", "v 0 2\nv"), kFormat, {"line 6:", "end of the line"}});
    expect_refused({"a.obj", changed("plain.obj", ".25", "NaN"), kCoordinate, {"line 7:", "'NaN'"}});
    expect_refused({"a.obj", changed("plain.obj", "f 2 3 4", "f 2 3 5"), kFormat, {"line 10:", "4, found 5"}});
    expect_refused({"a.obj", changed("plain.obj", "f 2 3 4", "f 2 3 0"), kFormat, {"line 10:", "found 0"}});
    expect_refused({"a.obj", changed("plain.obj", "f 2 3 4", "f 2 3 -5"), kFormat, {"line 10:", "found -5"}});
    expect_refused({"a.obj", changed("plain.obj", "f 2 3 4", "f 2 3"), kFormat, {"line 10:", "found 2"}});
    expect_refused({"a.obj", changed("plain.obj", "f 2 3 4", "f 2 3 4/x"), kFormat, {"line 10:", "'4/x'"}});
    expect_refused({"a.obj", changed("plain.obj", "f 2 3 4", "f 2 3 99999999999999999999"), kFormat, {"line 10:"}});
    expect_refused({"a.obj", changed("plain.obj", "f 2 3 4", std::string("\0\0", 2)), kFormat, {"line 10:", "NUL"}});
}

TEST(MeshRefusal, Off) {
    expect_refused({"a.off", "OFF BINARY\n", kFormat, {"line 1:", "BINARY"}});
    expect_refused({"a.off", "4OFF\n", kFormat, {"line 1:", "'4OFF'"}});
    expect_refused({"a.off", "hello\n", kFormat, {"line 1:", "'hello'"}});
    expect_refused({"a.off", changed("plain.off", "4 4 6", "4\n4 6"), kFormat, {"line 2:", "one line"}});
    expect_refused({"a.off", changed("plain.off", "4 4 6", "4 4000000 6"), kFormat, {"line 7:", "4000000 faces"}});
    expect_refused({"a.off", changed("plain.off", "4 4 6", "4 5 6"), kFormat, {}});
    expect_refused({"a.off", changed("plain.off", "4 4 6", "4 0 6"), kNone, {}});
    expect_refused({"a.off", changed("plain.off", "3 0 1 3", "3 0 1 4"), kFormat, {"line 8:", "4, found 4"}});
    expect_refused({"a.off", changed("plain.off", "3 0 1 3", "3 0 1 -3"), kFormat, {"line 8:", "'-3'"}});
    expect_refused({"a.off", changed("plain.off", "3 0 1 3", "2 0 1"), kFormat, {"line 8:", "found 2"}});
    expect_refused({"a.off", changed("plain.off", "1.5", "inf"), kCoordinate, {"line 4:", "'inf'"}});
}

TEST(MeshRefusal, VtkLegacy) {
    expect_refused({"a.vtk", "hello\n", kFormat, {"line 1:", "'hello'"}});
    expect_refused({"a.vtk", changed("old.vtk", "1.0", "6.0"), kFormat, {"line 1:", "5.1", "'6.0'"}});
    expect_refused({"a.vtk", changed("old.vtk", "ASCII", "UTF"), kFormat, {"line 3:", "'UTF'"}});
    expect_refused({"a.vtk",
                    changed("old.vtk", "POLYDATA", "STRUCTURED_GRID"),
                    kFormat,
                    {"line 4:", "'POLYDATA'", "'UNSTRUCTURED_GRID'", "'STRUCTURED_GRID'"}});
    expect_refused({"a.vtk", changed("old.vtk", "POLYGONS", "POLYTOPES"), kFormat, {"line 10:", "'POLYTOPES'"}});
    expect_refused({"a.vtk", changed("old.vtk", "4 16", "4 17"), kFormat, {"17", "16"}});
    expect_refused({"a.vtk", changed("old.vtk", "4 16", "4 15"), kFormat, {"line 14:", "3 corners"}});
    expect_refused({"a.vtk", changed("old.vtk", "4 16", "4 1600000"), kFormat, {"1600000"}});
    expect_refused({"a.vtk", changed("old.vtk", "POINTS 4 float", "POINTS 400 float"), kFormat, {"400 points"}});
    expect_refused({"a.vtk", changed("old.vtk", "3 0 1 3", "3 0 1 4"), kFormat, {"line 12:", "4, found 4"}});
    expect_refused({"a.vtk", changed("old.vtk", "1.5", "nan"), kCoordinate, {"line 7:", "'nan'"}});
    expect_refused({"a.vtk", changed("new.vtk", "0 3 6 9 12", "0 3 2 9 12"), kFormat, {"from 3 to 12", "found 2"}});
    expect_refused({"a.vtk", changed("new.vtk", "0 3 6 9 12", "0 3 6 9 11"), kFormat, {"12, found 11"}});
    expect_refused({"a.vtk", changed("new.vtk", "0 3 6 9 12", "1 3 6 9 12"), kFormat, {"from 0 to 0", "found 1"}});
    expect_refused(
        {"a.vtk", changed("strips.vtk", "TRIANGLE_STRIPS 2 10\n4 0 2 1 3\n4 2 0 3 1", "POINT_DATA 4"), kNone, {}});
    expect_refused({"a.vtk",
                    "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOLYGONS 1 4\n3 0 1 2\n",
                    kFormat,
                    {"line 5:", "POINTS before"}});
    const std::string points = "POINTS 4 double\n";
    const std::size_t at = samples::named("double.vtk").bytes.find(points) + points.size();
    std::string bytes = samples::named("double.vtk").bytes;
    bytes.replace(at + 8, 8, samples::bytes_of(std::numeric_limits<double>::quiet_NaN(), std::endian::big));
    expect_refused({"a.vtk", bytes, kCoordinate, {"byte " + std::to_string(at + 8) + ":", "nan"}});
}

// No test can hold a file of 2^31 triangles; the check itself sees nothing but the size.
TEST(MeshRefusal, CountBeyondThirtyOneBitsIsTooLarge) {
    const char byte = 0;
    const mesh::SourceFile large{"large.stl", {&byte, std::size_t{1} << 40U}, false};
    EXPECT_NO_THROW(mesh::check_count(large, 84, mesh::kMaxCount, 50, "triangles"));
    try {
        mesh::check_count(large, 84, mesh::kMaxCount + 1, 50, "triangles");
        ADD_FAILURE() << "accepted";
    } catch (const StageError& error) {
        EXPECT_EQ(error.code(), ErrorCode::kTooLarge);
        EXPECT_STREQ(error.what(), "large.stl, byte 84: 2147483648 triangles are more than the limit of 2147483647");
    }
}

TEST(MeshRefusal, UnreadablePath) {
    for (const std::string& path : {::testing::TempDir() + "no_such_file.stl", ::testing::TempDir()}) {
        try {
            read_surface(path);
            ADD_FAILURE() << "accepted " << path;
        } catch (const StageError& error) {
            EXPECT_EQ(error.stage(), Stage::kLoad);
            EXPECT_EQ(error.code(), ErrorCode::kFileUnreadable);
            EXPECT_TRUE(std::string(error.what()).starts_with(path)) << error.what();
        }
    }
}

}  // namespace
}  // namespace lumenline
