// VTK files that lie: what is refused, and what the sentence says. Sizes are stated several times in these formats,
// and every pair must agree before anything is allocated.

#include <gtest/gtest.h>

#include "io/mesh/formats.h"
#include "tests/mesh/refusal.h"
#include "tests/mesh/vtk_samples.h"

namespace lumenline {
namespace {

using samples::changed;
using samples::expect_refused;
using samples::replaced;
using samples::stored_array;
using samples::vtp_file;
using samples::VtpPiece;
using samples::VtpStyle;
using Format = VtpStyle::Format;

constexpr ErrorCode kFormat = ErrorCode::kFileFormat;
constexpr ErrorCode kTooLarge = ErrorCode::kTooLarge;

std::string numbers(const std::vector<std::uint64_t>& values, const VtpStyle& style) {
    std::string bytes;
    for (const std::uint64_t v : values) {
        bytes += style.header_size == 8 ? samples::bytes_of(v, style.order)
                                        : samples::bytes_of(static_cast<std::uint32_t>(v), style.order);
    }
    return bytes;
}

// A triangle, whose points are stored as `points`.
std::string with_points(const VtpStyle& style, const std::string& points) {
    VtpPiece piece;
    piece.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    piece.polys = {{0, 1, 2}};
    std::string bytes;
    for (const Vec3& p : piece.points) {
        for (const double x : {p.x, p.y, p.z}) bytes += samples::number_bytes(x, style.point_type, style.order);
    }
    return replaced(vtp_file({piece}, style), stored_array(bytes, style, true), points);
}

TEST(VtpRefusal, HeaderOfTheFile) {
    expect_refused({"a.vtp", "<VTKFile type=\"PolyData\"/>", kFormat, {"line 1:", "PolyData"}});
    expect_refused({"a.vtp", "<?xml version=\"1.0\"?>\n<VTKFile>", kFormat, {"line 2:", "well-formed"}});
    expect_refused({"a.vtp", "<?xml version=\"1.0\"?>\n<html/>", kFormat, {"line 2:", "VTKFile", "'html'"}});
    expect_refused({"a.vtp", "not XML", kFormat, {"a.vtp, line 1:"}});
    expect_refused({"a.vtp", "<VTKFile type=\"PolyData\">" + std::string(1, '\0'), kFormat, {"line 1:", "NUL"}});
    expect_refused({"a.vtu",
                    changed("ascii.vtp", "type=\"PolyData\"", "type=\"UnstructuredGrid\""),
                    kFormat,
                    {"line 2:", "'PolyData'", "'UnstructuredGrid'"}});
    expect_refused({"a.vtp", changed("ascii.vtp", "LittleEndian", "MiddleEndian"), kFormat, {"'MiddleEndian'"}});
    expect_refused({"a.vtp", changed("ascii.vtp", "UInt32", "UInt16"), kFormat, {"line 2:", "'UInt16'"}});
    for (const std::string name : {"vtkLZ4DataCompressor", "vtkLZMADataCompressor"}) {
        expect_refused({"a.vtp",
                        changed("raw_zlib.vtp", "vtkZLibDataCompressor", name),
                        kFormat,
                        {"line 2:", "'" + name + "', which is not read", "zlib"}});
    }
}

TEST(VtpRefusal, CountsOfAPiece) {
    expect_refused({"a.vtp", changed("ascii.vtp", "NumberOfPoints=\"4\"", ""), kFormat, {"line 4:", "NumberOfPoints"}});
    expect_refused(
        {"a.vtp", changed("ascii.vtp", "Points=\"4\"", "Points=\"-4\""), kFormat, {"line 4:", "a count", "'-4'"}});
    expect_refused({"a.vtp",
                    changed("ascii.vtp", "Points=\"4\"", "Points=\"99999999999999999999\""),
                    kFormat,
                    {"line 4:", "a count"}});
    for (const std::string name : {"ascii", "binary", "binary_zlib", "base64_zlib_64_big", "raw", "raw_64_big"}) {
        const std::string sample = name + ".vtp";
        expect_refused({"a.vtp", changed(sample, "Points=\"4\"", "Points=\"5\""), kFormat, {"a.vtp, "}});
        expect_refused({"a.vtp", changed(sample, "Points=\"4\"", "Points=\"3\""), kFormat, {"a.vtp, "}});
        expect_refused({"a.vtp", changed(sample, "Points=\"4\"", "Points=\"2000000000\""), kFormat, {"a.vtp, "}});
        expect_refused({"a.vtp", changed(sample, "Points=\"4\"", "Points=\"3000000000\""), kTooLarge, {"3000000000"}});
        expect_refused({"a.vtp", changed(sample, "Polys=\"2\"", "Polys=\"3\""), kFormat, {"a.vtp, "}});
        expect_refused({"a.vtp", changed(sample, "Polys=\"2\"", "Polys=\"2000000000\""), kFormat, {"a.vtp, "}});
        expect_refused({"a.vtp", changed(sample, "Strips=\"1\"", "Strips=\"2000000000\""), kFormat, {"a.vtp, "}});
    }
    // Vertices and lines are not read: their numbers cost the labels at most.
    for (const std::string name : {"ascii.vtp", "raw_zlib.vtp"}) {
        const TriangleSoup soup = mesh::parse_surface({"a", changed(name, "Verts=\"1\"", "Verts=\"2000000000\"")});
        EXPECT_EQ(samples::corners_of(soup), samples::tetrahedron_piece_corners());
        EXPECT_TRUE(soup.cell_labels.empty());
    }
}

TEST(VtpRefusal, Elements) {
    expect_refused({"a.vtp", changed("ascii.vtp", "<Polys>", "<Pollys>"), kFormat, {"line 69:", "well-formed"}});
    std::string bytes = replaced(changed("ascii.vtp", "<Polys>", "<Pollys>"), "</Polys>", "</Pollys>");
    expect_refused({"a.vtp", bytes, kFormat, {"line 4:", "'connectivity' and 'offsets' in Polys"}});
    bytes = changed("ascii.vtp", "type=\"Float32\" Name=\"Points\"", "type=\"Half\" Name=\"Points\"");
    expect_refused({"a.vtp", bytes, kFormat, {"line 25:", "'Half'"}});
    expect_refused({"a.vtp",
                    changed("ascii.vtp", "Name=\"Points\" NumberOfComponents=\"3\"", "NumberOfComponents=\"2\""),
                    kFormat,
                    {"line 25:", "NumberOfComponents 3", "'2'"}});
    bytes = changed("ascii.vtp", "NumberOfComponents=\"3\" format=\"ascii\">\n  0 0 0 1.5",
                    "NumberOfComponents=\"3\" format=\"octal\">\n  0 0 0 1.5");
    expect_refused({"a.vtp", bytes, kFormat, {"line 25:", "'octal'"}});
}

TEST(VtpRefusal, TextNumbers) {
    expect_refused({"a.vtp", changed("ascii.vtp", "0 0 0 1.5", "0 0 x 1.5"), kFormat, {"line 26:", "'x'"}});
    expect_refused({"a.vtp", changed("ascii.vtp", "1.5", "nan"), ErrorCode::kBadCoordinate, {"line 26:", "'nan'"}});
    expect_refused({"a.vtp", changed("ascii.vtp", "1.5", ""), kFormat, {"line 27:", "the end of the array"}});
    expect_refused({"a.vtp", changed("ascii.vtp", "1.5", "1.5 7"), kFormat, {"line 26:", "no more numbers"}});
    expect_refused({"a.vtp", changed("ascii.vtp", "0 2 1 0 1 3", "0 2 1 0 1 4"), kFormat, {"4, found 4"}});
    expect_refused({"a.vtp", changed("ascii.vtp", "0 2 1 0 1 3", "0 2 1 0 1 -3"), kFormat, {"4, found -3"}});
    expect_refused({"a.vtp", changed("ascii.vtp", "  3 6\n", "  6 3\n"), kFormat, {"at least 6, found 3"}});
    expect_refused({"a.vtp", changed("ascii.vtp", "  3 6\n", "  2 6\n"), kFormat, {"3 corners, found 2"}});
    expect_refused({"a.vtp", changed("ascii.vtp", "  3 6\n", "  3 5\n"), kFormat, {"3 corners, found 2"}});
    expect_refused({"a.vtp", changed("ascii.vtp", "  3 6\n", "  3 7\n"), kFormat, {"the end of the array"}});
    expect_refused({"a.vtp", changed("ascii.vtp", "  3 6\n", "  3 2000000000\n"), kFormat, {"2000000000"}});
    expect_refused(
        {"a.vtp", changed("ascii.vtp", "1.5 0 0", "1.5 <!-- --> 0 0"), kFormat, {"line 25:", "one piece of text"}});
}

TEST(VtpRefusal, Base64) {
    const VtpStyle style{Format::kBinary};
    const std::string good = numbers({36}, style) + std::string(36, '\0');
    expect_refused({"a.vtp", with_points(style, "!" + samples::base64(good)), kFormat, {"line 10:", "base64", "'!'"}});
    expect_refused({"a.vtp", with_points(style, "=AAA"), kFormat, {"line 10:"}});
    expect_refused({"a.vtp", with_points(style, ""), kFormat, {"a header of 4 bytes", "the end of the array"}});
    expect_refused({"a.vtp",
                    with_points(style, samples::base64(good.substr(0, 37))),
                    kFormat,
                    {"line 10:", "array of 36 bytes", "found at most 35"}});
    for (const std::uint64_t stated : {std::uint64_t{0}, std::uint64_t{35}, std::uint64_t{37}, ~std::uint64_t{0}}) {
        for (const std::size_t header : {4, 8}) {
            const VtpStyle lying{Format::kBinary, 0, header};
            const std::string bytes = numbers({stated}, lying) + std::string(36, '\0');
            const std::string told =
                header == 8 ? std::to_string(stated) : std::to_string(static_cast<std::uint32_t>(stated));
            expect_refused({"a.vtp",
                            with_points(lying, samples::base64(bytes)),
                            kFormat,
                            {"line 10:", "array of 36 bytes", "states " + told}});
        }
    }
}

// Padding ends a part of the bytes and not all of them: some writers encode the header by itself. Blanks may stand
// anywhere.
TEST(VtpRefusal, Base64InPartsAndLinesIsNone) {
    const VtpStyle style{Format::kBinary};
    std::string floats;
    for (const double x : {0, 0, 0, 1, 0, 0, 0, 1, 0}) floats += samples::number_bytes(x, "Float32", style.order);
    const std::string text = samples::base64(numbers({36}, style)) + samples::base64(floats);
    ASSERT_NE(text.find('='), std::string::npos);
    const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_EQ(mesh::parse_surface({"a.vtp", with_points(style, text)}).points, points);
    std::string spread;
    for (const char c : text) (spread += c) += "\r\n ";
    EXPECT_EQ(mesh::parse_surface({"a.vtp", with_points(style, spread)}).points, points);
}

TEST(VtpRefusal, CompressedBlocks) {
    for (const std::size_t header : {4, 8}) {
        const VtpStyle style{Format::kBinary, 20, header};  // two blocks of 20 and 16 bytes
        const auto stored = [&](const std::vector<std::uint64_t>& head, const std::string& blocks) {
            return with_points(style, samples::base64(numbers(head, style)) + samples::base64(blocks));
        };
        // A stored array of `size` zeros in one block is a header of four numbers and a zlib stream.
        const auto stream = [&](std::size_t size) {
            const VtpStyle one{Format::kBinary, size, header};
            return stored_array(std::string(size, '\0'), one, false).substr(4 * header);
        };
        const std::string a = stream(20);
        const std::string b = stream(16);
        EXPECT_NO_THROW(mesh::parse_surface({"a.vtp", stored({2, 20, 16, a.size(), b.size()}, a + b)}));
        const std::uint64_t huge = header == 8 ? ~std::uint64_t{0} : ~std::uint32_t{0};
        using Header = std::vector<std::uint64_t>;
        for (const Header& lie : {Header{2, 20, 17, a.size(), b.size()}, Header{2, 20, 0, a.size(), b.size()},
                                  Header{1, 20, 16, a.size(), b.size()}, Header{0, 20, 16, a.size(), b.size()},
                                  Header{2, huge, 16, a.size(), b.size()}, Header{huge, 20, 16, a.size(), b.size()},
                                  Header{2, 20, huge, a.size(), b.size()}, Header{2, 0, 36, a.size(), b.size()},
                                  Header{huge, huge, huge, huge, huge}}) {
            expect_refused(
                {"a.vtp", stored(lie, a + b), kFormat, {"line 10:", "array of 36 bytes", "header that states"}});
        }
        for (const Header& lie : {Header{2, 20, 16, huge, b.size()}, Header{2, 20, 16, a.size(), huge},
                                  Header{2, 20, 16, huge, huge}, Header{2, 20, 16, a.size(), b.size() + 9}}) {
            expect_refused({"a.vtp", stored(lie, a + b), kFormat, {"line 10:", "compressed block of"}});
        }
        expect_refused({"a.vtp", stored({2, 20, 16, a.size(), b.size() - 3}, a + b), kFormat, {"unpacks to 16 bytes"}});
        expect_refused({"a.vtp", stored({2, 20, 16, a.size(), 0}, a), kFormat, {"unpacks to 16 bytes"}});
        // A block that unpacks to less or to far more than stated: zlib is stopped at the stated size.
        expect_refused(
            {"a.vtp", stored({2, 20, 16, b.size(), b.size()}, b + b), kFormat, {"20 bytes, found 16 bytes"}});
        const std::string bomb = stream(1'000'000);
        expect_refused(
            {"a.vtp", stored({2, 20, 16, bomb.size(), b.size()}, bomb + b), kFormat, {"20 bytes, found more"}});
        std::string damaged = a;
        damaged[0] = 'y';
        expect_refused({"a.vtp", stored({2, 20, 16, a.size(), b.size()}, damaged + b), kFormat, {"damaged"}});
    }
}

// The header of the array agrees with the count, but no zlib stream of that length can hold so much.
TEST(VtpRefusal, CompressedArrayBeyondWhatZlibCanPack) {
    VtpPiece piece;
    piece.points = {{0, 0, 0}};
    piece.polys = {{0, 0, 0}};
    const VtpStyle style{Format::kBinary, 65536, 8};
    const std::uint64_t size = 12 * std::uint64_t{2'000'000'000};
    std::string bytes = replaced(vtp_file({piece}, style), "NumberOfPoints=\"1\"", "NumberOfPoints=\"2000000000\"");
    const std::string lie = samples::base64(numbers({1, size, 0, 20}, style)) + samples::base64(std::string(20, 'x'));
    bytes = replaced(bytes, stored_array(std::string(12, '\0'), style, true), lie);
    expect_refused({"a.vtp", bytes, kFormat, {"array of 24000000000 bytes", "only 20 compressed bytes"}});
}

TEST(VtpRefusal, AppendedData) {
    for (const std::string name : {"raw.vtp", "base64.vtp", "raw_zlib_64_big.vtp"}) {
        expect_refused({"a.vtp", changed(name, "</AppendedData>", ""), kFormat, {"'</AppendedData>'"}});
        expect_refused({"a.vtp", changed(name, "\n_", "\n"), kFormat, {"'_'"}});
        expect_refused({"a.vtp", changed(name, "encoding=\"", "encoding=\"x"), kFormat, {"'raw' or 'base64'"}});
        const std::size_t at = samples::named(name).bytes.find("<AppendedData");
        expect_refused({"a.vtp",
                        samples::named(name).bytes.substr(0, at) + "</VTKFile>",
                        kFormat,
                        {"AppendedData", "found none"}});
        // The points are the fifth array.
        const std::string points = "Name=\"Points\" NumberOfComponents=\"3\" format=\"appended\" offset=\"";
        for (const std::string offset : {"9999999", "99999999999999999999", "-1", "x", ""}) {
            std::string bytes = samples::named(name).bytes;
            const std::size_t begin = bytes.find(points) + points.size();
            bytes.replace(begin, bytes.find('"', begin) - begin, offset);
            expect_refused({"a.vtp", bytes, kFormat, {"an offset below", "'" + offset + "'"}});
        }
        expect_refused({"a.vtp", changed(name, points, points + "1"), kFormat, {"a.vtp, "}});
    }
    // Raw data may hold anything, also what ends them.
    VtpPiece piece = samples::tetrahedron_piece();
    piece.cell_arrays = {{"text", "UInt8", {}}};
    for (const char c : std::string("</AppendedData>")) piece.cell_arrays[0].values.push_back(c);
    const std::string bytes = vtp_file({piece}, {Format::kAppendedRaw});
    ASSERT_NE(bytes.find("</AppendedData>"), bytes.rfind("</AppendedData>"));
    EXPECT_EQ(samples::corners_of(mesh::parse_surface({"a.vtp", bytes})), samples::tetrahedron_piece_corners());
}

TEST(VtpRefusal, NumbersInBinary) {
    VtpPiece piece = samples::tetrahedron_piece();
    piece.polys[0][1] = 4;
    expect_refused({"a.vtp", vtp_file({piece}, {Format::kAppendedRaw}), kFormat, {"byte ", "4, found 4"}});
    expect_refused(
        {"a.vtp", vtp_file({piece}, {Format::kBinary}), kFormat, {"line ", "decoded byte 8:", "4, found 4"}});
    piece = samples::tetrahedron_piece();
    piece.points[1].y = std::numeric_limits<double>::infinity();
    for (const auto& [name, style] : samples::vtp_styles()) {
        expect_refused({"a.vtp", vtp_file({piece}, style), ErrorCode::kBadCoordinate, {"inf"}});
    }
    // A corner or offset between two numbers, and one that no integer holds.
    for (const double corner : {0.5, 1e300}) {
        VtpStyle style{Format::kBinary};
        style.index_type = "Float64";
        const std::string good = stored_array(
            samples::number_bytes(3, "Float64", style.order) + samples::number_bytes(6, "Float64", style.order), style,
            true);
        const std::string bad = stored_array(
            samples::number_bytes(3, "Float64", style.order) + samples::number_bytes(corner, "Float64", style.order),
            style, true);
        const std::string bytes = vtp_file({samples::tetrahedron_piece()}, style);
        EXPECT_EQ(samples::corners_of(mesh::parse_surface({"a.vtp", bytes})), samples::tetrahedron_piece_corners());
        expect_refused({"a.vtp", replaced(bytes, good, bad), kFormat, {"decoded byte 8:", "a cell offset"}});
    }
}

TEST(VtpRefusal, NoSurface) {
    VtpPiece piece = samples::tetrahedron_piece();
    piece.cell_arrays.clear();
    piece.polys.clear();
    piece.strips.clear();
    expect_refused({"a.vtp", vtp_file({piece}, {}), ErrorCode::kNoSurface, {"2 cells", "vertices or lines"}});
    piece.verts.clear();
    piece.lines.clear();
    expect_refused({"a.vtp", vtp_file({piece}, {}), ErrorCode::kNoSurface, {"4 points"}});
    expect_refused({"a.vtp", vtp_file({}, {}), ErrorCode::kNoSurface, {"0 points"}});
}

TEST(VtkGridRefusal, CellsAndTypes) {
    expect_refused({"a.vtk", changed("grid.vtk", "5\n1\n3\n5\n6", "5\n1\n3\n10\n6"), kFormat, {"type 10", "extract"}});
    expect_refused({"a.vtk", changed("grid.vtk", "5\n1\n3\n5\n6", "5\n1\n3\n-5\n6"), kFormat, {"type -5"}});
    expect_refused({"a.vtk", changed("grid.vtk", "5\n1\n3\n5\n6", "5\n5\n3\n5\n6"), kFormat, {"3 corners", "found 1"}});
    expect_refused({"a.vtk", changed("quads.vtk", "9\n8", "9\n5"), kFormat, {"3 corners", "type 5", "found 4"}});
    expect_refused({"a.vtk", changed("grid.vtk", "CELL_TYPES 5", "CELL_TYPES 4"), kFormat, {"5, found 4"}});
    const std::string bytes = samples::named("grid.vtk").bytes;
    expect_refused({"a.vtk", bytes.substr(0, bytes.find("CELL_TYPES")), kFormat, {"CELL_TYPES"}});
    expect_refused({"a.vtk", changed("grid.vtk", "CELLS 5 18", "POLYGONS 5 18"), kFormat, {"line 10:", "'POLYGONS'"}});
    expect_refused({"a.vtk", changed("old.vtk", "POLYGONS", "CELLS"), kFormat, {"line 10:", "'CELLS'"}});
}

}  // namespace
}  // namespace lumenline
