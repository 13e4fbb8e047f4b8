// What all formats share after parsing. A quad is first stored as the fan (a, b, c), (a, c, d) and turned when
// the points are known: some formats give the faces before the points.
//
// Rounding: half a unit in the last place at the largest coordinate. Coordinates that are all float32 numbers
// were most likely computed in float32, also when they are stored or printed with more digits.

#include "io/mesh/faces.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

namespace lumenline::mesh {
namespace {

// Whether x is a float32 number, told from its bits: GCC 12 may drop a conversion to float and back.
bool is_float32(double x) {
    constexpr double kLeastNormal = std::numeric_limits<float>::min();
    constexpr int kLowestBit = -149;                       // of float32, as a power of two
    constexpr std::uint64_t kLostBits = (1U << 29U) - 1U;  // 52 mantissa bits against 23
    if (std::fabs(x) > std::numeric_limits<float>::max()) return false;
    if (std::fabs(x) >= kLeastNormal) return (std::bit_cast<std::uint64_t>(x) & kLostBits) == 0;
    const double units = std::ldexp(x, -kLowestBit);
    return units == std::trunc(units);
}

// Unit of the last of `digits` significant digits of x > 0. The exponent is read from x in decimal, which is
// exact also at and beside powers of ten.
double last_digit(double x, int digits) {
    std::array<char, 32> text{};
    const char* end = std::to_chars(text.begin(), text.end(), x, std::chars_format::scientific).ptr;
    const char* sign = std::find(text.cbegin(), end, 'e') + 1;
    int exponent = 0;
    std::from_chars(sign + 1, end, exponent);
    return std::pow(10.0, (*sign == '-' ? -exponent : exponent) + 1 - digits);
}

}  // namespace

void FaceCollector::add(std::span<const std::uint32_t> corners, std::size_t position) {
    if (corners.size() < 3) {
        fail_at(file_, position, ErrorCode::kFileFormat,
                "expected a face of at least 3 corners, found " + std::to_string(corners.size()));
    }
    if (triangles_.size() + corners.size() - 2 > kMaxCount) {
        fail_at(file_, position, ErrorCode::kTooLarge,
                "the faces make more triangles than the limit of " + std::to_string(kMaxCount));
    }
    if (corners.size() == 4) quads_.push_back(static_cast<std::uint32_t>(triangles_.size()));
    for (std::size_t i = 2; i < corners.size(); ++i) triangles_.push_back({corners[0], corners[i - 1], corners[i]});
}

std::vector<std::array<std::uint32_t, 3>> FaceCollector::take(std::span<const Vec3> points) {
    for (const std::uint32_t quad : quads_) {
        const auto [a, b, c] = triangles_[quad];
        const std::uint32_t d = triangles_[quad + 1][2];
        if (squared_norm(points[b] - points[d]) < squared_norm(points[a] - points[c])) {
            triangles_[quad] = {a, b, d};
            triangles_[quad + 1] = {b, c, d};
        }
    }
    quads_.clear();
    return std::move(triangles_);
}

double coordinate_rounding(std::span<const Vec3> points, int digits) {
    double largest = 0;
    bool all_float32 = true;
    for (const Vec3& p : points) {
        largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
        all_float32 = all_float32 && is_float32(p.x) && is_float32(p.y) && is_float32(p.z);
    }
    if (largest == 0) return 0;
    const double binary = std::ldexp(largest, all_float32 ? -24 : -53);
    if (digits == 0) return binary;
    return std::max(binary, 0.5 * last_digit(largest, digits));
}

TriangleSoup make_soup(const SourceFile& file, std::vector<Vec3> points, FaceCollector& faces, int digits) {
    TriangleSoup soup;
    soup.triangles = faces.take(points);
    if (soup.triangles.empty()) {
        fail_file(file, ErrorCode::kNoSurface,
                  "expected at least one triangle or polygon, found none beside " + std::to_string(points.size()) +
                      " points");
    }
    soup.coordinate_rounding = coordinate_rounding(points, digits);
    soup.points = std::move(points);
    return soup;
}

}  // namespace lumenline::mesh
