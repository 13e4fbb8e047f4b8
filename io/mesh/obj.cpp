// Wavefront OBJ: lines "v x y z ..." and "f a/b/c ..."; all other lines (normals, groups, materials, lines,
// free-form geometry) are passed over. Indices count from 1, or back from the last point if negative. A positive
// index may run ahead of the points read so far, so the largest one is checked at the end.
//
// The format has no counts: a file cut between two faces, or inside the last number of a face, can be a valid
// smaller file, and nobody can tell.

#include "io/mesh/faces.h"
#include "io/mesh/formats.h"

namespace lumenline::mesh {
namespace {

/// Largest index used, to be checked when all points are known.
struct LargestIndex {
    std::uint64_t value = 0;  ///< from 1; 0 = none
    std::size_t position = 0;
};

// Index of the point in a corner "a", "a/b", "a//c" or "a/b/c", from 0.
std::uint32_t parse_corner(const SourceFile& file, Cursor& cursor, std::size_t point_count, LargestIndex& largest) {
    const std::size_t begin = cursor.position();
    const std::optional<std::int64_t> index = cursor.integer_prefix();
    if (!index) cursor.fail_expected(begin, "a point index");
    int slashes = 0;
    while (!cursor.at_token_end()) {
        const char c = file.bytes[cursor.position()];
        slashes += c == '/' ? 1 : 0;
        const bool after_slash = slashes > 0 && (c == '-' || (c >= '0' && c <= '9'));
        if (slashes > 2 || (c != '/' && !after_slash)) cursor.fail_expected(begin, "a corner such as 1, 1/2 or 1/2/3");
        cursor.move_to(cursor.position() + 1);
    }
    const auto count = static_cast<std::int64_t>(point_count);
    if (*index == 0 || *index < -count || *index > static_cast<std::int64_t>(kMaxCount)) {
        fail_at(file, begin, ErrorCode::kFileFormat,
                "expected a point index from 1, or from -" + std::to_string(count) + " to -1 after " +
                    std::to_string(count) + " points, found " + std::to_string(*index));
    }
    const auto from_one = static_cast<std::uint64_t>(*index > 0 ? *index : count + *index + 1);
    if (from_one > largest.value) largest = {from_one, begin};
    return static_cast<std::uint32_t>(from_one - 1);
}

Vec3 parse_point(Cursor& cursor) {
    const double x = cursor.coordinate();
    const double y = cursor.coordinate();
    const double z = cursor.coordinate();
    return {x, y, z};
}

}  // namespace

TriangleSoup parse_obj(const SourceFile& file) {
    require_text(file);
    std::vector<Vec3> points;
    FaceCollector faces(file);
    std::vector<std::uint32_t> corners;
    LargestIndex largest;
    Cursor cursor(file, file.bytes.starts_with("\xEF\xBB\xBF") ? 3 : 0, Layout::kLines, '#');
    while (!cursor.at_end()) {
        const std::string_view word = cursor.token();
        if (word == "v") {
            if (points.size() == kMaxCount) {
                fail_at(file, cursor.position(), ErrorCode::kTooLarge,
                        "more points than the limit of " + std::to_string(kMaxCount));
            }
            points.push_back(parse_point(cursor));
        } else if (word == "f" || word == "fo") {
            const std::size_t begin = cursor.position();
            corners.clear();
            while (!cursor.peek().empty()) corners.push_back(parse_corner(file, cursor, points.size(), largest));
            faces.add(corners, begin);
        }
        cursor.line();
    }
    if (largest.value > points.size()) {
        fail_at(file, largest.position, ErrorCode::kFileFormat,
                "expected a point index of at most the number of points, " + std::to_string(points.size()) +
                    ", found " + std::to_string(largest.value));
    }
    return make_soup(file, std::move(points), faces, cursor.digits());
}

}  // namespace lumenline::mesh
