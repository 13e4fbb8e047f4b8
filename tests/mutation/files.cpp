#include "tests/mutation/files.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <stdexcept>

#include "tests/mesh/vtp_writer.h"

namespace lumenline::mutation {
namespace {

class Bytes {
public:
    explicit Bytes(std::endian order) : order_(order) {}

    void text(const std::string& t) { bytes_ += t; }
    template <class T>
    void number(T value) {
        auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
        if (order_ != std::endian::native) std::reverse(raw.begin(), raw.end());
        bytes_.append(raw.data(), raw.size());
    }
    template <class T>
    void point(Vec3 p) {
        for (const double x : {p.x, p.y, p.z}) number(static_cast<T>(x));
    }
    std::string take() { return std::move(bytes_); }

private:
    std::endian order_;
    std::string bytes_;
};

std::string decimal(double x) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.17g", x);
    return text.data();
}

std::string spaced(Vec3 p) { return decimal(p.x) + " " + decimal(p.y) + " " + decimal(p.z); }

std::string stl(const TriangleSoup& s, std::endian order) {
    Bytes b(order);
    b.text(std::string(80, ' '));
    b.number(static_cast<std::uint32_t>(s.triangles.size()));
    for (const auto& t : s.triangles) {
        b.point<float>({});
        for (const std::uint32_t v : t) b.point<float>(s.points[v]);
        b.number(std::uint16_t{0});
    }
    return b.take();
}

std::string ply(const TriangleSoup& s, std::endian order) {
    Bytes b(order);
    b.text("ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(s.points.size()) +
           "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
           std::to_string(s.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n");
    for (const Vec3& p : s.points) b.point<double>(p);
    for (const auto& t : s.triangles) {
        b.number(std::uint8_t{3});
        for (const std::uint32_t v : t) b.number(v);
    }
    return b.take();
}

std::string vtk(const TriangleSoup& s, std::endian order) {
    Bytes b(order);
    b.text("# vtk DataFile Version 3.0\nsurface\nBINARY\nDATASET POLYDATA\nPOINTS " + std::to_string(s.points.size()) +
           " double\n");
    for (const Vec3& p : s.points) b.point<double>(p);
    b.text("\nPOLYGONS " + std::to_string(s.triangles.size()) + " " + std::to_string(4 * s.triangles.size()) + "\n");
    for (const auto& t : s.triangles) {
        b.number(std::int32_t{3});
        for (const std::uint32_t v : t) b.number(v);
    }
    b.text("\n");
    return b.take();
}

std::string vtp(const TriangleSoup& s, std::endian order) {
    samples::VtpPiece piece;
    piece.points = s.points;
    for (const auto& t : s.triangles)
        piece.polys.push_back({static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2])});
    samples::VtpStyle style;
    style.format = samples::VtpStyle::Format::kAppendedRaw;
    style.header_size = 8;
    style.order = order;
    style.point_type = "Float64";
    return samples::vtp_file({piece}, style);
}

std::string obj(const TriangleSoup& s) {
    std::string text;
    for (const Vec3& p : s.points) text += "v " + spaced(p) + "\n";
    for (const auto& t : s.triangles)
        text +=
            "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) + "\n";
    return text;
}

std::string off(const TriangleSoup& s) {
    std::string text = "OFF\n" + std::to_string(s.points.size()) + " " + std::to_string(s.triangles.size()) + " 0\n";
    for (const Vec3& p : s.points) text += spaced(p) + "\n";
    for (const auto& t : s.triangles)
        text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
    return text;
}

}  // namespace

std::string file_of(const TriangleSoup& soup, std::string_view format) {
    if (format == "stl") return stl(soup, std::endian::little);
    if (format == "ply") return ply(soup, std::endian::little);
    if (format == "vtk") return vtk(soup, std::endian::big);
    if (format == "vtp") return vtp(soup, std::endian::little);
    if (format == "obj") return obj(soup);
    if (format == "off") return off(soup);
    throw std::invalid_argument("no such format");
}

std::string swapped_file_of(const TriangleSoup& soup, std::string_view format) {
    if (format == "stl") return stl(soup, std::endian::big);
    if (format == "ply") return ply(soup, std::endian::big);
    if (format == "vtk") return vtk(soup, std::endian::little);
    if (format == "vtp") {
        std::string bytes = vtp(soup, std::endian::big);
        const std::string claim = "\"BigEndian\"";
        return bytes.replace(bytes.find(claim), claim.size(), "\"LittleEndian\"");
    }
    throw std::invalid_argument("no such format");
}

}  // namespace lumenline::mutation
