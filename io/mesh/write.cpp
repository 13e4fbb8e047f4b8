// Writers. A file is composed in memory, written under a temporary name and renamed, so that nobody ever sees half
// of it. Text formats print the shortest decimals that read back as the same double.

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <stdexcept>

#include "engine/core/text.h"
#include "io/mesh/mesh_io.h"

namespace lumenline {
namespace {

using Points = std::span<const Vec3>;
using Triangles = std::span<const std::array<std::uint32_t, 3>>;

[[noreturn]] void fail(const std::string& path, const std::string& what) {
    throw std::runtime_error("cannot write " + path + ": " + what);
}

template <class T>
void append(std::string& out, T value, std::endian order = std::endian::little) {
    std::array<char, sizeof(T)> bytes{};
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    out.append(bytes.data(), bytes.size());
}

std::string point_text(const Vec3& p) { return exact_text(p.x) + " " + exact_text(p.y) + " " + exact_text(p.z) + "\n"; }

std::string stl_bytes(Points points, Triangles triangles) {
    std::string out = "binary STL written by lumenline";
    out.resize(80, ' ');
    append(out, static_cast<std::uint32_t>(triangles.size()));
    const auto append_float = [&out](const Vec3& v) {
        for (const double x : {v.x, v.y, v.z}) append(out, static_cast<float>(x));
    };
    for (const auto& [a, b, c] : triangles) {
        append_float(normalized(cross(points[b] - points[a], points[c] - points[a])));
        for (const std::uint32_t corner : {a, b, c}) append_float(points[corner]);
        append(out, std::uint16_t{0});
    }
    return out;
}

std::string ply_bytes(Points points, Triangles triangles) {
    std::string out = "ply\nformat binary_little_endian 1.0\ncomment written by lumenline\nelement vertex " +
                      std::to_string(points.size()) +
                      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                      std::to_string(triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const Vec3& p : points) {
        for (const double x : {p.x, p.y, p.z}) append(out, x);
    }
    for (const auto& triangle : triangles) {
        append(out, std::uint8_t{3});
        for (const std::uint32_t corner : triangle) append(out, corner);
    }
    return out;
}

std::string vtk_bytes(Points points, Triangles triangles) {
    std::string out = "# vtk DataFile Version 3.0\nwritten by lumenline\nBINARY\nDATASET POLYDATA\nPOINTS " +
                      std::to_string(points.size()) + " double\n";
    for (const Vec3& p : points) {
        for (const double x : {p.x, p.y, p.z}) append(out, x, std::endian::big);
    }
    out += "\nPOLYGONS " + std::to_string(triangles.size()) + " " + std::to_string(4 * triangles.size()) + "\n";
    for (const auto& triangle : triangles) {
        append(out, std::uint32_t{3}, std::endian::big);
        for (const std::uint32_t corner : triangle) append(out, corner, std::endian::big);
    }
    return out + "\n";
}

std::string obj_bytes(Points points, Triangles triangles) {
    std::string out = "# written by lumenline\n";
    for (const Vec3& p : points) out += "v " + point_text(p);
    for (const auto& [a, b, c] : triangles) {
        out += "f " + std::to_string(a + 1) + " " + std::to_string(b + 1) + " " + std::to_string(c + 1) + "\n";
    }
    return out;
}

std::string off_bytes(Points points, Triangles triangles) {
    std::string out = "OFF\n" + std::to_string(points.size()) + " " + std::to_string(triangles.size()) + " 0\n";
    for (const Vec3& p : points) out += point_text(p);
    for (const auto& [a, b, c] : triangles) {
        out += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
    }
    return out;
}

void check_surface(const std::string& path, Points points, Triangles triangles, double largest) {
    constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
    if (triangles.empty()) fail(path, "the surface has no triangle");
    if (points.size() > kMost || triangles.size() > kMost) {
        fail(path, std::to_string(points.size()) + " points and " + std::to_string(triangles.size()) +
                       " triangles are more than the limit of " + std::to_string(kMost));
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (const double x : {points[i].x, points[i].y, points[i].z}) {
            if (std::fabs(x) <= largest) continue;
            fail(path, "point " + std::to_string(i) + " has the coordinate " + short_text(x) +
                           ", beyond the format's limit of " + short_text(largest));
        }
    }
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (const std::uint32_t corner : triangles[t]) {
            if (corner < points.size()) continue;
            fail(path, "triangle " + std::to_string(t) + " refers to point " + std::to_string(corner) + " of " +
                           std::to_string(points.size()));
        }
    }
}

struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

void write_file(const std::string& path, const std::string& bytes) {
    const std::string temporary = path + ".tmp";
    std::unique_ptr<std::FILE, Closer> file(std::fopen(temporary.c_str(), "wb"));
    if (!file) fail(path, "opening " + temporary + " failed (" + std::strerror(errno) + ")");
    bool good = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
    good = std::fclose(file.release()) == 0 && good;
    std::error_code error;
    if (good) {
        std::filesystem::rename(temporary, path, error);
        if (!error) return;
    }
    const std::string why = good
                                ? "renaming " + temporary + " failed (" + error.message() + ")"
                                : "writing " + counted(bytes.size(), "byte") + " failed (" + std::strerror(errno) + ")";
    std::filesystem::remove(temporary, error);
    fail(path, why);
}

}  // namespace

void write_surface(const std::string& path, Points points, Triangles triangles) {
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const bool is_stl = extension == ".stl";
    std::string (*const compose)(Points, Triangles) = is_stl                ? stl_bytes
                                                      : extension == ".ply" ? ply_bytes
                                                      : extension == ".obj" ? obj_bytes
                                                      : extension == ".off" ? off_bytes
                                                      : extension == ".vtk" ? vtk_bytes
                                                                            : nullptr;
    if (compose == nullptr) {
        fail(path, "the extension '" + extension + "' is none of .stl, .ply, .obj, .off and .vtk");
    }
    const double largest = is_stl ? double{std::numeric_limits<float>::max()} : std::numeric_limits<double>::max();
    check_surface(path, points, triangles, largest);
    write_file(path, compose(points, triangles));
}

}  // namespace lumenline
