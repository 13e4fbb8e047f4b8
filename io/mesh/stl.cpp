// STL, ascii and binary. Binary files are known by their size alone (84 + 50 n bytes, n at byte 80): many of
// them begin with "solid". The stored normals are not used, and not even parsed: exporters print "nan" there.
//
// STL repeats each corner in every triangle. Corners become one point where all coordinates are identical, by a
// hash table of point numbers with linear probing; a part of the hash is kept beside the number, so that nearly
// every probe is settled without a look at the points.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "engine/core/text.h"
#include "io/mesh/faces.h"
#include "io/mesh/formats.h"
#include "io/mesh/scalars.h"

namespace lumenline::mesh {
namespace {

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kFacetBytes = 50;

class CornerWelder {
public:
    explicit CornerWelder(std::size_t expected_points) { rehash(2 * expected_points); }

    /// Number of the point with exactly these coordinates.
    std::uint32_t add(Vec3 p) {
        p = {p.x + 0.0, p.y + 0.0, p.z + 0.0};  // -0.0 becomes +0.0
        const std::uint64_t hash = hash_of(p);
        const auto tag = static_cast<std::uint32_t>(hash >> 32U);
        for (std::size_t i = hash & mask_;; i = (i + 1) & mask_) {
            Slot& slot = slots_[i];
            if (slot.point == kEmpty) {
                slot = {static_cast<std::uint32_t>(points_.size()), tag};
                points_.push_back(p);
                const std::uint32_t added = slot.point;
                if (2 * points_.size() > slots_.size()) rehash(2 * slots_.size());
                return added;
            }
            if (slot.tag == tag && points_[slot.point] == p) return slot.point;
        }
    }

    [[nodiscard]] std::size_t size() const { return points_.size(); }
    std::vector<Vec3> take_points() { return std::move(points_); }

private:
    static constexpr std::uint32_t kEmpty = std::numeric_limits<std::uint32_t>::max();
    struct Slot {
        std::uint32_t point = kEmpty;
        std::uint32_t tag = 0;
    };

    static std::uint64_t hash_of(const Vec3& p) {
        std::uint64_t hash = 0;
        for (const double x : {p.x, p.y, p.z}) {
            hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15U;
            hash ^= hash >> 32U;
        }
        hash *= 0xD6E8FEB86659FD93U;
        return hash ^ (hash >> 29U);
    }

    void rehash(std::size_t at_least) {
        slots_.assign(std::bit_ceil(std::max<std::size_t>(at_least, 64)), Slot{});
        mask_ = slots_.size() - 1;
        for (std::size_t k = 0; k < points_.size(); ++k) {
            const std::uint64_t hash = hash_of(points_[k]);
            std::size_t i = hash & mask_;
            while (slots_[i].point != kEmpty) i = (i + 1) & mask_;
            slots_[i] = {static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(hash >> 32U)};
        }
    }

    std::vector<Vec3> points_;
    std::vector<Slot> slots_;
    std::size_t mask_ = 0;
};

void add_facet(const SourceFile& file, std::size_t position, std::span<const std::uint32_t> corners,
               const CornerWelder& welder, FaceCollector& faces) {
    if (welder.size() > kMaxCount) {
        fail_at(file, position, ErrorCode::kTooLarge, "more points than the limit of " + std::to_string(kMaxCount));
    }
    faces.add(corners, position);
}

std::uint64_t announced_facets(const SourceFile& file) {
    return load<std::uint32_t>(file.bytes.data() + kHeaderBytes - 4, Encoding::kLittleEndian);
}

TriangleSoup parse_binary(SourceFile file) {
    file.text = false;
    const std::uint64_t facets = announced_facets(file);
    check_count(file, kHeaderBytes, facets, kFacetBytes, "triangles");
    FaceCollector faces(file);
    faces.reserve(facets);
    CornerWelder welder(facets / 2);  // a closed surface has half as many points as triangles
    for (std::uint64_t f = 0; f < facets; ++f) {
        const std::size_t facet = kHeaderBytes + f * kFacetBytes;
        std::array<std::uint32_t, 3> corners{};
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t at = facet + 12 * (c + 1);
            const char* bytes = file.bytes.data() + at;
            const Vec3 p{load<float>(bytes, Encoding::kLittleEndian), load<float>(bytes + 4, Encoding::kLittleEndian),
                         load<float>(bytes + 8, Encoding::kLittleEndian)};
            if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))) {
                fail_at(file, at, ErrorCode::kBadCoordinate,
                        "expected finite coordinates, found " + short_text(p) + " in triangle " + std::to_string(f));
            }
            corners[c] = welder.add(p);
        }
        add_facet(file, facet, corners, welder, faces);
    }
    return make_soup(file, welder.take_points(), faces, 0);
}

std::uint32_t parse_vertex(Cursor& cursor, CornerWelder& welder) {
    cursor.expect("vertex");
    const double x = cursor.coordinate();
    const double y = cursor.coordinate();
    const double z = cursor.coordinate();
    return welder.add({x, y, z});
}

// One "facet normal ... endfacet", the word facet being taken already.
void parse_facet(const SourceFile& file, Cursor& cursor, CornerWelder& welder, FaceCollector& faces) {
    const std::size_t begin = cursor.position();
    cursor.expect("normal");
    for (int i = 0; i < 3; ++i) {
        if (cursor.token().empty()) cursor.fail_expected(file.bytes.size(), "a normal");
    }
    cursor.expect("outer");
    cursor.expect("loop");
    std::array<std::uint32_t, 3> corners{};
    for (std::uint32_t& corner : corners) corner = parse_vertex(cursor, welder);
    cursor.expect("endloop");
    cursor.expect("endfacet");
    add_facet(file, begin, corners, welder, faces);
}

TriangleSoup parse_ascii(const SourceFile& file, std::size_t begin) {
    require_text(file);
    constexpr std::size_t kTypicalFacetBytes = 250;
    const std::size_t expected = file.bytes.size() / kTypicalFacetBytes;
    FaceCollector faces(file);
    faces.reserve(expected);
    CornerWelder welder(expected / 2);
    Cursor cursor(file, begin, Layout::kFree);
    do {
        cursor.expect("solid");
        cursor.line();  // the rest of the line is a name
        while (true) {
            const std::string_view word = cursor.token();
            if (is_word(word, "facet")) {
                parse_facet(file, cursor, welder, faces);
            } else if (is_word(word, "endsolid")) {
                cursor.line();
                break;
            } else {
                cursor.fail_expected(cursor.position() - word.size(), "'facet' or 'endsolid'");
            }
        }
    } while (!cursor.peek().empty());
    return make_soup(file, welder.take_points(), faces, cursor.digits());
}

}  // namespace

bool is_binary_stl(const SourceFile& file) {
    const std::size_t size = file.bytes.size();
    return size >= kHeaderBytes && (size - kHeaderBytes) % kFacetBytes == 0 &&
           (size - kHeaderBytes) / kFacetBytes == announced_facets(file);
}

TriangleSoup parse_stl(const SourceFile& file) {
    if (is_binary_stl(file)) return parse_binary(file);
    const std::size_t begin = std::min(file.bytes.find_first_not_of(" \t\r\n\v\f\xEF\xBB\xBF"), file.bytes.size());
    const bool has_nul = file.bytes.find('\0') != std::string_view::npos;
    if (!has_nul && is_word(file.bytes.substr(begin, 5), "solid")) return parse_ascii(file, begin);
    const std::size_t size = file.bytes.size();
    std::string found = "found " + counted(size, "byte");
    if (size >= kHeaderBytes) {
        const std::uint64_t facets = announced_facets(file);
        found += ", while the " + std::to_string(facets) + " triangles announced at byte 80 make " +
                 std::to_string(kHeaderBytes + facets * kFacetBytes);
    }
    fail_file(file, ErrorCode::kFileFormat,
              "expected an STL file, either text that begins with 'solid' or exactly 84 + 50 n bytes with n at byte "
              "80, " +
                  found);
}

}  // namespace lumenline::mesh
