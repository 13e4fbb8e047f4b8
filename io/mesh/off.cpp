// Geomview OFF as text: optional keyword [ST][C][N]OFF, counts "points faces [edges]" on one line, then a line
// per point (x y z, then perhaps normal, colour, texture coordinates) and per face (n, n indices, perhaps a
// colour). '#' starts a comment. Some files lack the blank after the keyword ("OFF8 12 0").
//
// What follows the needed numbers of a line is passed over, since colours come in several lengths.

#include "io/mesh/faces.h"
#include "io/mesh/formats.h"

namespace lumenline::mesh {
namespace {

// Takes the keyword, if any.
void parse_keyword(const SourceFile& file, Cursor& cursor) {
    std::string_view word = cursor.peek();
    const std::size_t begin = cursor.position();
    if (!word.empty() && word.front() >= '0' && word.front() <= '9' && word.find("OFF") == std::string_view::npos) {
        return;
    }
    std::string_view rest = word;
    for (const std::string_view prefix : {"ST", "C", "N"}) {
        if (rest.starts_with(prefix)) rest.remove_prefix(prefix.size());
    }
    if (!rest.starts_with("OFF") || rest.substr(3).find_first_not_of("0123456789") != std::string_view::npos) {
        cursor.fail_expected(begin, "'OFF', also after ST, C and N (points with three coordinates)");
    }
    cursor.move_to(begin + (word.size() - rest.size()) + 3);
    if (is_word(cursor.peek(), "binary")) {
        fail_at(file, cursor.position(), ErrorCode::kFileFormat,
                "expected a text OFF file, found 'BINARY', which is not read");
    }
}

}  // namespace

TriangleSoup parse_off(const SourceFile& file) {
    require_text(file);
    Cursor cursor(file, file.bytes.starts_with("\xEF\xBB\xBF") ? 3 : 0, Layout::kFree, '#');
    parse_keyword(file, cursor);
    const std::uint64_t point_count = cursor.count("the number of points");
    const std::size_t counts_end = cursor.position();
    const std::uint64_t face_count = cursor.count("the number of faces");
    if (file.bytes.substr(counts_end, cursor.position() - counts_end).find_first_of("\r\n") != std::string_view::npos) {
        cursor.fail_expected(counts_end, "the numbers of points and of faces on one line");
    }
    cursor.line();

    constexpr std::size_t kLeastPoint = 6;  // "0 0 0\n"
    constexpr std::size_t kLeastFace = 7;   // "3 0 1 2"
    check_count(file, cursor.position(), point_count, kLeastPoint, "points");
    std::vector<Vec3> points(point_count);
    for (Vec3& p : points) {
        p.x = cursor.coordinate();
        p.y = cursor.coordinate();
        p.z = cursor.coordinate();
        cursor.line();
    }

    check_count(file, cursor.position(), face_count, kLeastFace, "faces");
    FaceCollector faces(file);
    faces.reserve(face_count);
    std::vector<std::uint32_t> corners;
    for (std::uint64_t f = 0; f < face_count; ++f) {
        cursor.peek();
        const std::size_t begin = cursor.position();
        const std::uint64_t corner_count = cursor.count("the number of corners of face " + std::to_string(f));
        check_count(file, begin, corner_count, 2, "corners");
        corners.resize(corner_count);
        for (std::uint32_t& corner : corners) {
            cursor.peek();
            const std::size_t at = cursor.position();
            const std::uint64_t index = cursor.count("a point index");
            if (index >= point_count) {
                fail_at(file, at, ErrorCode::kFileFormat,
                        "expected a point index from 0 to below the number of points, " + std::to_string(point_count) +
                            ", found " + std::to_string(index));
            }
            corner = static_cast<std::uint32_t>(index);
        }
        cursor.line();
        faces.add(corners, begin);
    }
    return make_soup(file, std::move(points), faces, cursor.digits());
}

}  // namespace lumenline::mesh
