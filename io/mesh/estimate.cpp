// An estimate orders models and bounds memory: it need not be right, only cheap and the same on every machine. A text
// file without counts is measured by the bytes that one vertex and its two triangles take.

#include "io/mesh/estimate.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>

namespace lumenline {

namespace {

constexpr double kObjBytesPerSite = 90;
constexpr double kTextStlBytesPerSite = 520;
constexpr std::size_t kStlHeader = 84, kStlTriangle = 50;

std::optional<double> number_at(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r\n\"=");
    if (first == std::string_view::npos) return std::nullopt;
    std::uint64_t value = 0;
    const auto result = std::from_chars(text.data() + first, text.data() + text.size(), value);
    return result.ec == std::errc() ? std::optional(static_cast<double>(value)) : std::nullopt;
}

/// The number that follows `word`.
std::optional<double> number_behind(std::string_view text, std::string_view word) {
    const std::size_t at = text.find(word);
    return at == std::string_view::npos ? std::nullopt : number_at(text.substr(at + word.size()));
}

std::optional<double> stated_sites(std::string_view head, std::uintmax_t bytes) {
    if (head.starts_with("ply")) return number_behind(head, "element vertex");
    if (head.starts_with("# vtk")) return number_behind(head, "POINTS");
    if (head.find("<VTKFile") != std::string_view::npos) return number_behind(head, "NumberOfPoints");
    const std::string_view line = head.substr(0, head.find('\n'));
    if (const std::size_t off = line.find("OFF"); off <= 4) return number_at(head.substr(off + 3));
    if (head.size() >= kStlHeader) {
        std::uint32_t triangles = 0;
        std::memcpy(&triangles, head.data() + kStlHeader - sizeof triangles, sizeof triangles);
        if (kStlHeader + std::uintmax_t{triangles} * kStlTriangle == bytes) return triangles / 2.0;
    }
    return std::nullopt;
}

}  // namespace

SurfaceEstimate estimate_surface(const std::string& path) {
    SurfaceEstimate estimate;
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return estimate;
    const std::uintmax_t bytes = std::filesystem::file_size(path, error);
    if (error) return estimate;
    estimate.bytes = bytes;
    std::array<char, 4096> head{};
    std::ifstream in(path, std::ios::binary);
    in.read(head.data(), head.size());
    const std::string_view text(head.data(), static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
    const double by_length =
        static_cast<double>(bytes) / (text.starts_with("solid") ? kTextStlBytesPerSite : kObjBytesPerSite);
    // No format needs less than a byte for a vertex: a larger count is a damaged file's.
    estimate.sites = std::min(stated_sites(text, bytes).value_or(by_length), static_cast<double>(bytes));
    return estimate;
}

}  // namespace lumenline
