// Legacy VTK polydata, versions 1.0 to 5.1, ascii and binary (always big-endian). Up to 4.x a cell section is
// "POLYGONS n size" and n times "k i0 ... ik-1"; from 5.0 on it is "POLYGONS n+1 size" and two arrays, OFFSETS and
// CONNECTIVITY. The word OFFSETS tells the forms apart. Sections end at POINT_DATA or CELL_DATA, behind which no
// geometry follows.
//
// Binary arrays begin right behind the line of their header and have no mark at their end. A METADATA block may
// follow any array and ends with an empty line.

#include <algorithm>
#include <array>
#include <utility>

#include "io/mesh/faces.h"
#include "io/mesh/formats.h"
#include "io/mesh/scalars.h"

namespace lumenline::mesh {
namespace {

constexpr std::array<std::pair<std::string_view, ScalarType>, 16> kTypes{{
    {"char", ScalarType::kInt8},
    {"signed_char", ScalarType::kInt8},
    {"unsigned_char", ScalarType::kUint8},
    {"short", ScalarType::kInt16},
    {"unsigned_short", ScalarType::kUint16},
    {"int", ScalarType::kInt32},
    {"vtkidtype", ScalarType::kInt32},  // written as int whatever its size in memory
    {"unsigned_int", ScalarType::kUint32},
    {"long", ScalarType::kInt64},
    {"unsigned_long", ScalarType::kUint64},
    {"long_long", ScalarType::kInt64},
    {"vtktypeint64", ScalarType::kInt64},
    {"vtktypeint32", ScalarType::kInt32},
    {"vtktypeuint64", ScalarType::kUint64},
    {"float", ScalarType::kFloat32},
    {"double", ScalarType::kFloat64},
}};

enum class CellKind { kSkipped, kPolygons, kStrips };

class VtkParser {
public:
    explicit VtkParser(const SourceFile& given)
        : file_(given), cursor_(file_, 0, Layout::kFree), faces_(file_), reader_(parse_header()) {}
    VtkParser(const VtkParser&) = delete;
    VtkParser& operator=(const VtkParser&) = delete;

    TriangleSoup parse() {
        while (parse_section()) {
        }
        if (!has_points_) fail_file(file_, ErrorCode::kFileFormat, "expected a section POINTS, found none");
        return make_soup(file_, std::move(points_), faces_, file_.text ? cursor_.digits() : 0);
    }

private:
    ScalarReader parse_header();
    bool parse_section();
    void parse_points();
    void parse_cells(CellKind kind);
    void parse_packed_cells(CellKind kind, std::uint64_t cell_count, std::uint64_t size);
    void parse_offset_cells(CellKind kind, std::uint64_t offset_count, std::uint64_t size);
    void parse_cell(CellKind kind, ScalarType type, std::uint64_t corner_count, std::size_t position);
    void skip_metadata();
    void skip_field();
    void skip_strings(std::uint64_t count);
    ScalarType parse_type();
    void begin_array();
    [[noreturn]] void fail(std::size_t position, const std::string& what) const {
        fail_at(file_, position, ErrorCode::kFileFormat, what);
    }

    SourceFile file_;
    Cursor cursor_;
    FaceCollector faces_;
    ScalarReader reader_;
    std::vector<Vec3> points_;
    bool has_points_ = false;
    std::vector<std::uint32_t> corners_;  // scratch
};

ScalarReader VtkParser::parse_header() {
    const std::string_view magic = cursor_.line();
    constexpr std::string_view kMagic = "# vtk datafile version ";
    if (!is_word(magic.substr(0, kMagic.size()), kMagic))
        fail(0, "expected '# vtk DataFile Version', found " + in_quotes(magic));
    const std::string_view version = magic.substr(kMagic.size());
    if (version.size() < 2 || version[0] < '1' || version[0] > '5' || version[1] != '.') {
        fail(0, "expected a legacy VTK version from 1.0 to 5.1, found " + in_quotes(version));
    }
    cursor_.line();  // title
    const std::string_view encoding = cursor_.token();
    const bool binary = is_word(encoding, "binary");
    if (!binary && !is_word(encoding, "ascii")) {
        cursor_.fail_expected(cursor_.position() - encoding.size(), "'ASCII' or 'BINARY'");
    }
    if (!binary) require_text(file_);
    cursor_.expect("dataset");
    const std::string_view dataset = cursor_.token();
    if (!is_word(dataset, "polydata")) {
        cursor_.fail_expected(cursor_.position() - dataset.size(), "'POLYDATA', the only VTK dataset that is read");
    }
    file_.text = !binary;
    return {file_, cursor_, binary ? Encoding::kBigEndian : Encoding::kText};
}

// False at the end of the geometry.
bool VtkParser::parse_section() {
    const std::string_view word = cursor_.token();
    if (word.empty() || is_word(word, "point_data") || is_word(word, "cell_data")) return false;
    if (is_word(word, "points")) {
        parse_points();
    } else if (is_word(word, "polygons")) {
        parse_cells(CellKind::kPolygons);
    } else if (is_word(word, "triangle_strips")) {
        parse_cells(CellKind::kStrips);
    } else if (is_word(word, "vertices") || is_word(word, "lines")) {
        parse_cells(CellKind::kSkipped);
    } else if (is_word(word, "metadata")) {
        skip_metadata();
    } else if (is_word(word, "field")) {
        skip_field();
    } else {
        cursor_.fail_expected(cursor_.position() - word.size(),
                              "a section POINTS, VERTICES, LINES, POLYGONS, TRIANGLE_STRIPS, METADATA, FIELD, "
                              "POINT_DATA or CELL_DATA");
    }
    return true;
}

ScalarType VtkParser::parse_type() {
    const std::string_view word = cursor_.token();
    for (const auto& [name, type] : kTypes) {
        if (is_word(word, name)) return type;
    }
    cursor_.fail_expected(cursor_.position() - word.size(), "a VTK number type such as float, double or vtktypeint64");
}

// Leaves the header line of an array.
void VtkParser::begin_array() {
    if (file_.text) return;
    const std::size_t end = file_.bytes.find('\n', cursor_.position());
    if (end == std::string_view::npos)
        fail(cursor_.position(), "expected an array behind its header line, found the end of the file");
    cursor_.move_to(end + 1);
}

void VtkParser::parse_points() {
    const std::size_t begin = cursor_.position();
    if (has_points_) fail(begin, "expected one section POINTS, found a second one");
    const std::uint64_t count = cursor_.count("the number of points");
    const ScalarType type = parse_type();
    begin_array();
    // The last number of a text file needs no separator.
    check_count(file_, cursor_.position(), count, 3 * reader_.least_size(type) - (file_.text ? 1 : 0), "points");
    points_.resize(count);
    for (Vec3& p : points_) {
        p.x = reader_.coordinate(type);
        p.y = reader_.coordinate(type);
        p.z = reader_.coordinate(type);
    }
    has_points_ = true;
}

void VtkParser::parse_cells(CellKind kind) {
    const std::size_t begin = cursor_.position();
    const std::uint64_t count = cursor_.count("the number of cells");
    const std::uint64_t size = cursor_.count("the size of the cell list");
    if (kind != CellKind::kSkipped && count > 0 && !has_points_) {
        fail(begin, "expected the section POINTS before the cells, found the cells first");
    }
    const std::size_t header_end = cursor_.position();
    if (is_word(cursor_.peek(), "offsets")) {
        parse_offset_cells(kind, count, size);
        return;
    }
    cursor_.move_to(header_end);
    begin_array();
    parse_packed_cells(kind, count, size);
}

void VtkParser::parse_packed_cells(CellKind kind, std::uint64_t cell_count, std::uint64_t size) {
    constexpr ScalarType kType = ScalarType::kInt32;
    const std::size_t begin = cursor_.position();
    check_count(file_, begin, size, file_.text ? 1 : scalar_size(kType), "numbers of the cell list");
    if (cell_count > size) {
        fail(begin, "expected a cell list of at least " + std::to_string(cell_count) +
                        " numbers, one per cell, found " + "a size of " + std::to_string(size));
    }
    if (kind == CellKind::kSkipped) {
        reader_.skip(kType, size);
        return;
    }
    std::uint64_t used = 0;
    for (std::uint64_t c = 0; c < cell_count; ++c) {
        const std::int64_t corners = reader_.integer(kType, "the number of corners of a cell");
        const std::size_t position = reader_.last_position();
        if (corners < 0 || static_cast<std::uint64_t>(corners) >= size - used) {
            fail(position, "expected at most " + std::to_string(size - used) +
                               " more numbers in the cell list, found " + "a cell of " + std::to_string(corners) +
                               " corners");
        }
        parse_cell(kind, kType, static_cast<std::uint64_t>(corners), position);
        used += 1 + static_cast<std::uint64_t>(corners);
    }
    if (used != size) {
        fail(cursor_.position(), "expected " + std::to_string(size) + " numbers in the cell list, found " +
                                     std::to_string(used) + " in its " + std::to_string(cell_count) + " cells");
    }
}

void VtkParser::parse_offset_cells(CellKind kind, std::uint64_t offset_count, std::uint64_t size) {
    cursor_.expect("offsets");
    const ScalarType offset_type = parse_type();
    begin_array();
    check_count(file_, cursor_.position(), offset_count, file_.text ? 1 : scalar_size(offset_type), "cell offsets");
    std::vector<std::uint64_t> offsets(offset_count);
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        const std::int64_t value = reader_.integer(offset_type, "a cell offset");
        const std::uint64_t least = i == 0 ? 0 : offsets[i - 1];
        const std::uint64_t most = i == 0 ? 0 : size;
        if (value < 0 || static_cast<std::uint64_t>(value) < least || static_cast<std::uint64_t>(value) > most) {
            fail(reader_.last_position(), "expected a cell offset from " + std::to_string(least) + " to " +
                                              std::to_string(most) + ", found " + std::to_string(value));
        }
        offsets[i] = static_cast<std::uint64_t>(value);
    }
    const std::uint64_t last = offsets.empty() ? 0 : offsets.back();
    if (last != size) {
        fail(reader_.last_position(), "expected the last cell offset to be the number of corners, " +
                                          std::to_string(size) + ", found " + std::to_string(last));
    }
    cursor_.expect("connectivity");
    const ScalarType type = parse_type();
    begin_array();
    check_count(file_, cursor_.position(), size, file_.text ? 1 : scalar_size(type), "corners");
    if (kind == CellKind::kSkipped) {
        reader_.skip(type, size);
        return;
    }
    for (std::size_t i = 1; i < offsets.size(); ++i) {
        parse_cell(kind, type, offsets[i] - offsets[i - 1], cursor_.position());
    }
}

void VtkParser::parse_cell(CellKind kind, ScalarType type, std::uint64_t corner_count, std::size_t position) {
    corners_.resize(corner_count);
    for (std::uint32_t& corner : corners_) corner = reader_.index(type, points_.size());
    if (kind == CellKind::kPolygons || corner_count < 3) {
        faces_.add(corners_, position);
        return;
    }
    for (std::size_t i = 2; i < corners_.size(); ++i) {
        // Every other triangle of a strip runs backwards.
        const std::size_t odd = i % 2;
        faces_.add(std::array{corners_[i - 2 + odd], corners_[i - 1 - odd], corners_[i]}, position);
    }
}

void VtkParser::skip_metadata() {
    cursor_.line();
    while (!cursor_.at_end()) {
        if (cursor_.line().find_first_not_of(" \t\r") == std::string_view::npos) return;
    }
}

// FIELD name n, then n arrays "name components tuples type".
void VtkParser::skip_field() {
    if (cursor_.token().empty()) cursor_.fail_expected(cursor_.position(), "the name of a field");
    const std::uint64_t arrays = cursor_.count("the number of arrays of a field");
    check_count(file_, cursor_.position(), arrays, 8, "arrays");
    for (std::uint64_t a = 0; a < arrays; ++a) {
        while (is_word(cursor_.peek(), "metadata")) skip_metadata();
        if (cursor_.token().empty()) cursor_.fail_expected(cursor_.position(), "the name of a field array");
        const std::uint64_t components = cursor_.count("the number of components of a field array");
        const std::uint64_t tuples = cursor_.count("the number of tuples of a field array");
        check_count(file_, cursor_.position(), components, 1, "components");
        check_count(file_, cursor_.position(), tuples, 1, "tuples");
        const std::uint64_t numbers = components * tuples;  // both below 2^31
        const std::string_view type = cursor_.peek();
        const bool is_string = is_word(type, "string");
        const bool is_bit = is_word(type, "bit");
        const ScalarType scalar = is_string || is_bit ? ScalarType::kUint8 : parse_type();
        if (is_string || is_bit) cursor_.token();
        begin_array();
        if (is_string) {
            skip_strings(numbers);
        } else {
            reader_.skip(scalar, is_bit && !file_.text ? (numbers + 7) / 8 : numbers);
        }
    }
}

// Text: one encoded line each. Binary: the two highest bits of the first byte tell how many bytes hold the length.
void VtkParser::skip_strings(std::uint64_t count) {
    if (file_.text) cursor_.line();
    for (std::uint64_t i = 0; i < count; ++i) {
        if (cursor_.at_end()) fail(cursor_.position(), "expected a string of a field array, found the end of the file");
        if (file_.text) {
            cursor_.line();
            continue;
        }
        const auto first = static_cast<unsigned char>(file_.bytes[cursor_.position()]);
        const std::size_t width = std::size_t{8} >> (first >> 6U);
        check_count(file_, cursor_.position(), width, 1, "bytes of a string's length");
        std::uint64_t length = first & 0x3FU;
        for (std::size_t b = 1; b < width; ++b) {
            length = length << 8U | static_cast<unsigned char>(file_.bytes[cursor_.position() + b]);
        }
        cursor_.move_to(cursor_.position() + width);
        reader_.skip(ScalarType::kUint8, length);
    }
}

}  // namespace

TriangleSoup parse_vtk_legacy(const SourceFile& file) { return VtkParser(file).parse(); }

}  // namespace lumenline::mesh
