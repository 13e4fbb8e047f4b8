// Small VTK files: XML polydata in every storage, legacy files with all kinds of attributes, grids of flat cells.

#include "tests/mesh/vtk_samples.h"

namespace lumenline::samples {
namespace {

constexpr std::endian kBig = std::endian::big;

const std::string kTetraLines = "0 0 0\n1.5 0 0\n0 2 0\n0.25 0.5 3\n";
const std::string kCubeLines = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n";

std::vector<int> ints(const std::array<std::uint32_t, 3>& t) {
    return {static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2])};
}

VtpPiece cube_piece() {
    VtpPiece piece;
    piece.points = cube().points;
    piece.polys = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    return piece;
}

// Arrays of a legacy file in either form.
class LegacyText {
public:
    explicit LegacyText(bool binary) : binary_(binary) {}

    void line(const std::string& text) { text_ += text + "\n"; }
    void array(const std::string& head, const std::string& type, const std::vector<double>& values) {
        line(head);
        for (const double v : values) text_ += binary_ ? number_bytes(v, type, kBig) : exact(v) + " ";
        text_ += "\n";
    }
    void strings(const std::vector<std::string>& words) {
        for (const std::string& word : words) {
            text_ += binary_ ? static_cast<char>(0xC0U | word.size()) + word : word + "\n";
        }
        text_ += "\n";
    }
    /// Colours are bytes in binary and fractions in text.
    void colours(const std::string& head, std::size_t count) {
        array(head, "UInt8", std::vector<double>(count, binary_ ? 10 : 0.5));  // 10 is also a line end
    }
    void bits(const std::string& head, std::size_t count) {
        array(head, "UInt8", std::vector<double>(binary_ ? (count + 7) / 8 : count, 1));
    }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    static std::string exact(double v) {
        const auto whole = static_cast<long>(v);
        return static_cast<double>(whole) == v ? std::to_string(whole) : std::to_string(v);
    }

    bool binary_;
    std::string text_;
};

}  // namespace

VtpPiece tetrahedron_piece() {
    VtpPiece piece;
    const TriangleSoup solid = tetrahedron();
    piece.points = solid.points;
    piece.verts = {{3}};
    piece.lines = {{0, 1}};
    piece.polys = {ints(solid.triangles[0]), ints(solid.triangles[1])};
    piece.strips = {{1, 2, 3, 0}};  // (1 2 3), (3 2 0): the second is turned round
    piece.cell_arrays = {{"ModelFaceID", "Int32", {-1, -2, 10, 20, 30}},
                         {"Ids", "Float64", {0, 0, 7, -8, 9}},
                         {"Pressure", "Float32", {0, 0, 0.5, 1, 2}},
                         {"Normals", "Float32", std::vector<double>(15, 1.0)}};
    return piece;
}

Corners tetrahedron_piece_corners() {
    const TriangleSoup solid = tetrahedron();
    const auto& p = solid.points;
    return {{p[0], p[2], p[1]}, {p[0], p[1], p[3]}, {p[1], p[2], p[3]}, {p[3], p[2], p[0]}};
}

std::vector<std::int32_t> tetrahedron_piece_faces() { return {10, 20, 30, 30}; }
std::vector<std::int32_t> tetrahedron_piece_ids() { return {7, -8, 9, 9}; }

std::vector<std::pair<std::string, VtpStyle>> vtp_styles() {
    using Format = VtpStyle::Format;
    std::vector<std::pair<std::string, VtpStyle>> styles{{"ascii", {}}};
    const std::vector<std::pair<std::string, Format>> formats{
        {"binary", Format::kBinary}, {"base64", Format::kAppendedBase64}, {"raw", Format::kAppendedRaw}};
    for (const auto& [name, format] : formats) {
        for (const std::size_t block : {0, 16}) {
            for (const std::size_t header : {4, 8}) {
                for (const std::endian order : {std::endian::little, kBig}) {
                    styles.emplace_back(
                        name + (block > 0 ? "_zlib" : "") + (header == 8 ? "_64" : "") + (order == kBig ? "_big" : ""),
                        VtpStyle{format, block, header, order, "Float32", "Int64"});
                }
            }
        }
    }
    return styles;
}

std::string legacy_with_attributes(bool binary) {
    const std::vector<double> labels{-5, 10, 20, 30, 40};  // of the line and the triangles
    LegacyText file(binary);
    file.line("# vtk DataFile Version 4.2\nattributes\n" + std::string(binary ? "BINARY" : "ASCII"));
    file.line("DATASET POLYDATA");
    file.array("POINTS 4 float", "Float32", {0, 0, 0, 1.5, 0, 0, 0, 2, 0, 0.25, 0.5, 3});
    file.array("LINES 1 3", "Int32", {2, 0, 1});
    file.array("POLYGONS 4 16", "Int32", {3, 0, 2, 1, 3, 0, 1, 3, 3, 1, 2, 3, 3, 0, 3, 2});
    file.line("POINT_DATA 4");
    file.array("SCALARS s float\nLOOKUP_TABLE own", "Float32", {1, 2, 3, 4});
    file.colours("LOOKUP_TABLE own 2", 8);
    file.array("SCALARS two short 2\nLOOKUP_TABLE default", "Int16", {1, 2, 3, 4, 5, 6, 7, 8});
    file.bits("SCALARS flags bit 3\nLOOKUP_TABLE default", 12);
    file.array("VECTORS v double", "Float64", std::vector<double>(12, 2.5));
    file.array("NORMALS n float", "Float32", std::vector<double>(12, 10));
    file.line("METADATA\nCOMPONENT_NAMES\nX\nY\nZ\n");
    file.array("TEXTURE_COORDINATES t 2 float", "Float32", std::vector<double>(8, 0.25));
    file.array("TENSORS w float", "Float32", std::vector<double>(36, 1));
    file.array("TENSORS6 u float", "Float32", std::vector<double>(24, 1));
    file.array("GLOBAL_IDS g vtkIdType", "Int32", {0, 1, 2, 3});
    file.line("PEDIGREE_IDS names string");
    file.strings({"a", "b", "CELL_DATA", "d"});
    file.array("EDGE_FLAGS e unsigned_char", "UInt8", {1, 1, 0, 1});
    file.colours("COLOR_SCALARS c 3", 12);
    file.line("CELL_DATA 5");
    file.array("SCALARS Ids vtktypeint64 1\nLOOKUP_TABLE default", "Int64", labels);
    file.array("FIELD FieldData 3\nPressure 1 5 double", "Float64", {0.5, 1, 2, 3, 4});
    file.line("METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1\n");
    file.array("pairs 2 5 int", "Int32", std::vector<double>(10, 3));
    file.array("Model%20Face 1 5 float", "Float32", labels);
    file.array("NORMALS cn float", "Float32", std::vector<double>(15, 0.5));
    file.array("SCALARS ModelFaceID int\nLOOKUP_TABLE default", "Int32", labels);
    file.line("POINT_DATA 4");
    file.array("SCALARS last char\nLOOKUP_TABLE default", "Int8", {1, 2, 3, 4});
    return file.text();
}

void add_vtk_grids(std::vector<Sample>& list) {
    const std::string head = "# vtk DataFile Version 3.0\ngrid\nASCII\nDATASET UNSTRUCTURED_GRID\n";
    const auto& t = tetrahedron().points;
    list.push_back({"grid.vtk",
                    head + "POINTS 4 float\n" + kTetraLines +
                        "CELLS 5 18\n3 0 2 1\n1 3\n2 0 1\n3 0 1 3\n4 1 2 3 0\n\nCELL_TYPES 5\n5\n1\n3\n5\n6\n"
                        "CELL_DATA 5\nSCALARS ModelFaceID int 1\nLOOKUP_TABLE default\n10 -1 -1 20 3\n",
                    tetrahedron_piece_corners()});
    Corners box = corners_of(cube());
    const auto& p = cube().points;
    // The pixel's corners run row by row; a pentagon is a fan.
    box.push_back({p[0], p[1], p[2]});
    box.push_back({p[0], p[2], p[4]});
    box.push_back({p[0], p[4], p[6]});
    list.push_back({"quads.vtk",
                    head + "POINTS 8 double\n" + kCubeLines +
                        "CELLS 7 36\n4 0 3 2 1\n4 4 5 7 6\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n5 0 1 2 4 6\n"
                        "CELL_TYPES 7\n9\n8\n9\n7\n9\n9\n7\n",
                    box});
    std::string bytes = "# vtk DataFile Version 5.1\ngrid\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n";
    for (const Vec3& q : t) {
        for (const double x : {q.x, q.y, q.z}) bytes += bytes_of(x, kBig);
    }
    bytes += "\nCELLS 4 10\nOFFSETS vtktypeint64\n";
    for (const std::int64_t end : {0, 3, 6, 10}) bytes += bytes_of(end, kBig);
    bytes += "\nCONNECTIVITY vtktypeint64\n";
    for (const std::int64_t corner : {0, 2, 1, 0, 1, 3, 1, 2, 3, 0}) bytes += bytes_of(corner, kBig);
    bytes += "\nCELL_TYPES 3\n";
    for (const std::int32_t type : {5, 5, 6}) bytes += bytes_of(type, kBig);
    list.push_back({"grid_binary.vtk", bytes + "\n", tetrahedron_piece_corners()});
}

void add_vtp(std::vector<Sample>& list) {
    for (const auto& [name, style] : vtp_styles()) {
        list.push_back({name + ".vtp", vtp_file({tetrahedron_piece()}, style), tetrahedron_piece_corners()});
    }
    VtpPiece wall = cube_piece();
    Corners both = corners_of(cube());
    const Corners second = tetrahedron_piece_corners();
    both.insert(both.end(), second.begin(), second.end());
    list.push_back(
        {"pieces.vtp", vtp_file({wall, VtpPiece{}, tetrahedron_piece()}, {VtpStyle::Format::kAscii, 0, 4}), both});
    list.push_back({"pieces_raw.vtp",
                    vtp_file({wall, tetrahedron_piece()},
                             {VtpStyle::Format::kAppendedRaw, 64, 8, std::endian::little, "Float64", "Int32"}),
                    both});
}

}  // namespace lumenline::samples
