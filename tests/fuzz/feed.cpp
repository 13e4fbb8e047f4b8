#include "tests/fuzz/feed.h"

#include <array>
#include <cmath>
#include <stdexcept>

#include "engine/core/errors.h"
#include "io/mesh/formats.h"

namespace lumenline::fuzz {
namespace {

using Parser = TriangleSoup (*)(const mesh::SourceFile&);

constexpr std::array<std::string_view, 7> kNames{"stl", "ply", "obj", "off", "vtk_legacy", "vtk_xml", "any"};
constexpr std::array<Parser, kNames.size()> kParsers{
    mesh::parse_stl,        mesh::parse_ply,     mesh::parse_obj,     mesh::parse_off,
    mesh::parse_vtk_legacy, mesh::parse_vtk_xml, mesh::parse_surface,
};

std::string fault_of(const TriangleSoup& soup) {
    if (soup.triangles.empty()) return "a surface without a triangle";
    for (const Vec3& p : soup.points) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return "a coordinate that is not finite";
    }
    for (const auto& triangle : soup.triangles) {
        for (const std::uint32_t corner : triangle) {
            if (corner >= soup.points.size()) return "a corner beyond the points";
        }
    }
    if (!(soup.coordinate_rounding >= 0)) return "no rounding of the coordinates";
    for (const CellLabels& labels : soup.cell_labels) {
        if (labels.values.size() != soup.triangles.size()) return "labels of other triangles";
    }
    return {};
}

}  // namespace

std::span<const std::string_view> readers() { return kNames; }

std::string feed(std::string_view reader, std::string_view bytes) {
    for (std::size_t i = 0; i < kNames.size(); ++i) {
        if (kNames[i] != reader) continue;
        try {
            return fault_of(kParsers[i]({"fuzz.obj", bytes}));
        } catch (const StageError& error) {
            const std::string sentence = error.what();
            if (error.stage() != Stage::kLoad || !sentence.starts_with("fuzz.obj")) return "the refusal: " + sentence;
            return sentence.find('\n') == std::string::npos ? "" : "a refusal of several lines: " + sentence;
        }
    }
    throw std::out_of_range("no reader " + std::string(reader));
}

}  // namespace lumenline::fuzz
