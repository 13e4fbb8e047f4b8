// Small surface files written by hand: the tetrahedron wherever triangles suffice, the cube where quads matter.
// Every text ends in a one-digit number, so that no cut can shorten the last number to another valid one.

#include "tests/mesh/samples.h"

#include <gtest/gtest.h>

#include <cctype>
#include <fstream>
#include <ostream>
#include <stdexcept>

#include "tests/mesh/vtk_samples.h"

namespace lumenline::samples {
namespace {

constexpr std::endian kLittle = std::endian::little;
constexpr std::endian kBig = std::endian::big;

template <class T>
std::string point_bytes(const TriangleSoup& soup, std::endian order) {
    std::string bytes;
    for (const Vec3& p : soup.points) {
        for (const double x : {p.x, p.y, p.z}) bytes += bytes_of(static_cast<T>(x), order);
    }
    return bytes;
}

template <class T>
std::string numbers(std::initializer_list<int> values, std::endian order) {
    std::string bytes;
    for (const int v : values) bytes += bytes_of(static_cast<T>(v), order);
    return bytes;
}

template <class Count, class Item>
std::string face_bytes(const TriangleSoup& soup, std::endian order) {
    std::string bytes;
    for (const auto& t : soup.triangles) {
        bytes += bytes_of(Count{3}, order);
        for (const std::uint32_t corner : t) bytes += bytes_of(static_cast<Item>(corner), order);
    }
    return bytes;
}

// The text formats below spell these shapes out; a facet of the tetrahedron as ascii STL text:
std::string facet(const std::string& normal, const std::string& a, const std::string& b, const std::string& c) {
    return " facet normal " + normal + "\n  outer loop\n   vertex " + a + "\n   vertex " + b + "\n   vertex " + c +
           "\n  endloop\n endfacet\n";
}

const std::string kP0 = "0 0 0", kP1 = "1.5 0 0", kP2 = "-0.0 2 0e0", kP3 = "+0.25 5e-1 3";
const std::string kTetraLines = kP0 + "\n" + kP1 + "\n" + "0 2 0\n" + kP3 + "\n";
const std::string kCubeLines = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n";
const std::string kTetraFaces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
const std::string kCubeFaces = "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";

void add_stl(std::vector<Sample>& list) {
    const std::string first = facet("0 0 -1", kP0, kP2, kP1) + facet("nan nan nan", kP0, kP1, kP3);
    const std::string second = facet("-nan inf x", kP1, kP2, kP3) + facet("0 0 0", kP0, kP3, kP2);
    const Corners tetra = corners_of(tetrahedron());
    list.push_back({"ascii.stl", "solid facet vertex\n" + first + second + "endsolid facet\n", tetra});
    list.push_back({"upper.stl",
                    "SOLID\r\n FACET NORMAL 0 0 1 OUTER LOOP VERTEX 0 0 0 VERTEX 1 0 0 VERTEX 0 1 0 "
                    "ENDLOOP ENDFACET\r\nENDSOLID",
                    {{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}}});
    list.push_back(
        {"two_solids.stl", "solid a\n" + first + "endsolid a\nsolid b\n" + second + "endsolid\n", tetra, true});
    list.push_back({"binary.stl", binary_stl(tetrahedron(), "made by hand"), tetra});
    list.push_back({"binary_solid.stl", binary_stl(cube(), "solid but not ascii"), corners_of(cube())});
    list.push_back({"binary_ply.dat", binary_stl(cube(), "ply\nformat"), corners_of(cube())});
}

void add_ply(std::vector<Sample>& list) {
    const Corners tetra = corners_of(tetrahedron());
    const Corners box = corners_of(cube());
    const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
    const std::string faces = "element face 4\nproperty list uchar int vertex_indices\n";
    list.push_back({"ascii.ply",
                    "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\n" + xyz + faces + "end_header\n" +
                        kTetraLines + kTetraFaces,
                    tetra});
    list.push_back({"quads.ply",
                    "ply\r\nformat ascii 1.0\r\nobj_info x\r\nelement vertex 8\r\nproperty uchar x\r\n"
                    "property int8 y\r\nproperty ushort z\r\nelement face 6\r\n"
                    "property list uint8 uint32 vertex_index\r\nend_header\r\n" +
                        kCubeLines + kCubeFaces,
                    box});
    for (const std::endian order : {kLittle, kBig}) {
        const std::string prefix = order == kLittle ? "little" : "big";
        const std::string head = "ply\nformat binary_" + prefix + "_endian 1.0\n";
        list.push_back({prefix + ".ply",
                        head + "element vertex 4\n" + xyz + faces + "end_header\n" +
                            point_bytes<float>(tetrahedron(), order) +
                            face_bytes<std::uint8_t, std::int32_t>(tetrahedron(), order),
                        tetra});
        // Faces first, extra elements and lists in between, coordinates of three types in reverse order.
        std::string body = numbers<std::uint16_t>({2, 7, 8}, order) + numbers<std::uint16_t>({0}, order);
        for (const auto& t : cube().triangles) {
            body += bytes_of(1.5, order) + numbers<std::int32_t>({3}, order);
            for (const std::uint32_t corner : t) body += bytes_of(static_cast<std::int16_t>(corner), order);
            body += numbers<std::uint8_t>({2, 200, 100}, order);
        }
        for (const Vec3& p : cube().points) {
            body += bytes_of(p.z, order) + numbers<std::uint8_t>({9}, order);
            body += bytes_of(static_cast<std::uint32_t>(p.y), order) + bytes_of(static_cast<float>(p.x), order);
        }
        list.push_back({prefix + "_mixed.ply",
                        head +
                            "element empty 99\nelement range_grid 2\nproperty list ushort ushort items\n"
                            "element face 12\nproperty double quality\nproperty list int short vertex_index\n"
                            "property list uchar uchar colors\nelement vertex 8\nproperty float64 z\n"
                            "property uchar red\nproperty uint y\nproperty float32 x\nend_header\n" +
                            body,
                        box});
    }
}

void add_obj(std::vector<Sample>& list) {
    const Corners tetra = corners_of(tetrahedron());
    const Corners box = corners_of(cube());
    list.push_back({"plain.obj",
                    "# comment\nmtllib a.mtl\no t\nv 0 0 0\nv 1.5 0 0 1.0\nv 0 2 0 0.1 0.2 0.3\nv .25 .5 3.\n"
                    "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nl 1 2\n",
                    tetra, true});
    list.push_back({"forms.obj",
                    "v 0 0 0\r\nv 1.5 0 0\r\nv 0 2 0\r\nv 0.25 0.5 3\r\nvn 0 0 1\r\nvt 0 0\r\ng one\r\n"
                    "f 1/1 3/1 2/1\r\nf 1//1 2//1 4//1 # c\r\ng two\r\nusemtl m\r\ns off\r\n"
                    "f 2/1/1 3/1/1 4/1/1\r\nf 1 4/1 3//1\r\n",
                    tetra, true});
    list.push_back({"negative.obj",
                    "o a\nv 0 0 0\nv 1.5 0 0\nv 0 2 0\nf -3 -1 -2\no b\nv 0.25 0.5 3\nf -4 2 \\\n -1\n"
                    "f -3//-1 -2//-1 -1//-1\nf 1 4 3",
                    tetra, true});
    list.push_back({"quads.obj",
                    "f 1 4 3 2\nf 5 6 7 8\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 \\\r\n1 1\n"
                    "v 0 1 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n",
                    box, true});
}

void add_off(std::vector<Sample>& list) {
    const Corners tetra = corners_of(tetrahedron());
    list.push_back({"plain.off", "OFF\n4 4 6\n" + kTetraLines + kTetraFaces, tetra});
    list.push_back({"quads.off", "OFF 8 6 12\n" + kCubeLines + kCubeFaces, corners_of(cube())});
    list.push_back({"tight.off", "OFF8 6\n" + kCubeLines + kCubeFaces, corners_of(cube())});
    list.push_back({"bare.off", "4 4 0\n" + kTetraLines + kTetraFaces, tetra});
    list.push_back({"colours.dat",
                    "# by hand\nCOFF # colours\n\n4 4 6 # counts\n\n0 0 0 255 0 0 255\n# between\n"
                    "1.5 0 0 255 0 0 255\n0 2 0 1 1 1 1 # c\n0.25 0.5 3 0 0 0 0\n3 0 2 1 0.5 0.5 0.5\n"
                    "3 0 1 3\n\n3 1 2 3 7 # x\n3 0 3 2 1 0 0\n",
                    tetra});
    list.push_back({"normals.off",
                    "NOFF\r\n4 4 0\r\n0 0 0 0 0 1\r\n1.5 0 0 0 0 1\r\n0 2 0 0 0 1\r\n0.25 0.5 3 0 0 1\r\n"
                    "3 0 2 1\r\n3 0 1 3\r\n3 1 2 3\r\n3 0 3 2\r\n",
                    tetra});
}

std::string vtk_head(const std::string& version, const std::string& encoding) {
    return "# vtk DataFile Version " + version + "\nPOINTS 7 float\n" + encoding + "\nDATASET POLYDATA\n";
}

void add_vtk_text(std::vector<Sample>& list) {
    const Corners tetra = corners_of(tetrahedron());
    const std::string metadata = "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 3.1\n\n";
    const std::string points = "POINTS 4 float\n" + kTetraLines;
    list.push_back({"old.vtk", vtk_head("1.0", "ASCII") + points + "POLYGONS 4 16\n" + kTetraFaces, tetra});
    list.push_back({"full.vtk",
                    vtk_head("3.0", "ascii") +
                        "FIELD FieldData 3\nTime 1 1 double\n0.5\nNames 1 2 string\nPOINTS%204\nb c\nnone 1 0 int\n\n" +
                        "POINTS 8 double\n" + kCubeLines + "\n" + metadata + "VERTICES 1 2\n1 0\nLINES 1 3\n2 0 1\n" +
                        "POLYGONS 6 30\n" + kCubeFaces + metadata +
                        "POINT_DATA 8\nSCALARS s float\nLOOKUP_TABLE default\n1 2 3 4 5 6 7 8\n",
                    corners_of(cube())});
    list.push_back({"new.vtk",
                    vtk_head("5.1", "ASCII") + points + metadata +
                        "VERTICES 2 1\nOFFSETS vtktypeint64\n0 1\nCONNECTIVITY vtktypeint64\n3\n" +
                        "POLYGONS 5 12\nOFFSETS vtktypeint64\n0 3 6 9 12\nCONNECTIVITY vtktypeint64\n"
                        "0 2 1 0 1 3 1 2 3 0 3 2\n",
                    tetra});
    // The strip 0 2 1 3 is (0 2 1), (1 2 3); the strip 2 0 3 1 is (2 0 3), (3 0 1): the same four faces.
    const auto& t = tetrahedron().points;
    list.push_back({"strips.vtk",
                    vtk_head("4.2", "ASCII") + points + "TRIANGLE_STRIPS 2 10\n4 0 2 1 3\n4 2 0 3 1\n",
                    {{t[0], t[2], t[1]}, {t[1], t[2], t[3]}, {t[2], t[0], t[3]}, {t[3], t[0], t[1]}}});
}

void add_vtk_binary(std::vector<Sample>& list) {
    const TriangleSoup solid = tetrahedron();
    const Corners tetra = corners_of(solid);
    const std::string cells = face_bytes<std::int32_t, std::int32_t>(solid, kBig);
    list.push_back({"float.vtk",
                    vtk_head("3.0", "BINARY") + "POINTS 4 float\n" + point_bytes<float>(solid, kBig) +
                        "\nPOLYGONS 4 16\n" + cells + "\n\nPOINT_DATA 4\nNORMALS n float\n",
                    tetra});
    list.push_back({"double.vtk",
                    vtk_head("4.1", "BINARY") + "FIELD FieldData 3\nTime 1 1 double\n" + bytes_of(0.5, kBig) +
                        "\nnames 1 2 string\n\xC3"
                        "abc\x80\x02"
                        "de\nflags 1 9 bit\n\xFF\x80\n" +
                        "POINTS 4 double\n" + point_bytes<double>(solid, kBig) + "\nMETADATA\nINFORMATION 0\n\n" +
                        "LINES 1 3\n" + numbers<std::int32_t>({2, 0, 1}, kBig) + "\nPOLYGONS 4 16\n" + cells + "\n",
                    tetra});
    std::string corners;
    for (const auto& t : solid.triangles) {
        for (const std::uint32_t c : t) corners += bytes_of(std::int64_t{c}, kBig);
    }
    list.push_back({"new_binary.vtk",
                    vtk_head("5.1", "BINARY") + "POINTS 4 float\n" + point_bytes<float>(solid, kBig) +
                        "\nLINES 2 2\nOFFSETS vtktypeint64\n" + numbers<std::int64_t>({0, 2}, kBig) +
                        "\nCONNECTIVITY vtktypeint64\n" + numbers<std::int64_t>({0, 1}, kBig) +
                        "\nMETADATA\nINFORMATION 0\n\nPOLYGONS 5 12\nOFFSETS vtktypeint64\n" +
                        numbers<std::int64_t>({0, 3, 6, 9, 12}, kBig) + "\nCONNECTIVITY vtktypeint64\n" + corners +
                        "\n",
                    tetra});
}

}  // namespace

Corners corners_of(const TriangleSoup& soup) {
    Corners corners;
    for (const auto& [a, b, c] : soup.triangles) {
        corners.push_back({soup.points.at(a), soup.points.at(b), soup.points.at(c)});
    }
    return corners;
}

TriangleSoup tetrahedron() {
    TriangleSoup soup;
    soup.points = {{0, 0, 0}, {1.5, 0, 0}, {0, 2, 0}, {0.25, 0.5, 3}};
    soup.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    return soup;
}

TriangleSoup cube() {
    TriangleSoup soup;
    soup.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    soup.triangles = {{0, 3, 2}, {0, 2, 1}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                      {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
    return soup;
}

std::string binary_stl(const TriangleSoup& soup, std::string header) {
    header.resize(80, '\0');
    header += bytes_of(static_cast<std::uint32_t>(soup.triangles.size()), kLittle);
    for (const auto& corners : corners_of(soup)) {
        header += numbers<float>({0, 0, 0}, kLittle);
        for (const Vec3& p : corners) {
            for (const double x : {p.x, p.y, p.z}) header += bytes_of(static_cast<float>(x), kLittle);
        }
        header += std::string(2, '\0');
    }
    return header;
}

std::string test_name(const Sample& sample) {
    std::string name = sample.name;
    for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    return name;
}

void PrintTo(const Sample& sample, std::ostream* out) { *out << sample.name; }

const std::vector<Sample>& all() {
    static const std::vector<Sample> samples = [] {
        std::vector<Sample> list;
        add_stl(list);
        add_ply(list);
        add_obj(list);
        add_off(list);
        add_vtk_text(list);
        add_vtk_binary(list);
        add_vtk_grids(list);
        add_vtp(list);
        return list;
    }();
    return samples;
}

const Sample& named(const std::string& name) {
    for (const Sample& sample : all()) {
        if (sample.name == name) return sample;
    }
    throw std::out_of_range("no sample " + name);
}

std::string write_temporary(const std::string& name, const std::string& bytes) {
    std::string path = ::testing::TempDir() + "lumenline_mesh_" + name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
}

}  // namespace lumenline::samples
