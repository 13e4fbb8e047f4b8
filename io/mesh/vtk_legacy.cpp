// Legacy VTK polydata, versions 1.0 to 5.1, ascii and binary (always big-endian). Up to 4.x a cell section is
// "POLYGONS n size" and n times "k i0 ... ik-1"; from 5.0 on it is "POLYGONS n+1 size" and two arrays, OFFSETS and
// CONNECTIVITY. The word OFFSETS tells the forms apart. Sections end at POINT_DATA or CELL_DATA, behind which no
// geometry follows. A METADATA block may follow any array.
//
// An unstructured grid of flat cells is a surface too. Its cells stand in one section CELLS, of the same two forms,
// and their types behind them, so that corners are held until the types are known.

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "io/mesh/formats.h"
#include "io/mesh/scalars.h"
#include "io/mesh/vtk_arrays.h"
#include "io/mesh/vtk_cells.h"

namespace lumenline::mesh {
namespace {

// The first three in the order of polydata in cell arrays.
enum class CellKind { kSkipped, kPolygons, kStrips, kGrid };

class VtkParser {
public:
    explicit VtkParser(const SourceFile& given)
        : file_(given),
          cursor_(file_, 0, Layout::kFree),
          reader_(parse_header()),
          arrays_(file_, cursor_, reader_),
          cells_(file_) {}
    VtkParser(const VtkParser&) = delete;
    VtkParser& operator=(const VtkParser&) = delete;

    TriangleSoup parse() {
        while (parse_section()) {
        }
        if (!has_points_) fail_file(file_, ErrorCode::kFileFormat, "expected a section POINTS, found none");
        if (grid_offsets_.size() > 1)
            fail_file(file_, ErrorCode::kFileFormat, "expected a section CELL_TYPES, found none");
        return cells_.make_soup(std::move(points_), file_.text ? cursor_.digits() : 0);
    }

private:
    ScalarReader parse_header();
    bool parse_section();
    void parse_points();
    void parse_cells(CellKind kind);
    void parse_packed_cells(CellKind kind, std::uint64_t cell_count, std::uint64_t size);
    void parse_offset_cells(CellKind kind, std::uint64_t offset_count, std::uint64_t size);
    void parse_cell(CellKind kind, ScalarType type, std::uint64_t corner_count, std::size_t position);
    void parse_cell_types();
    void add_grid_cell(std::int64_t type, std::span<std::uint32_t> corners, std::size_t position);
    void parse_attributes(std::string_view section);
    [[noreturn]] void fail(std::size_t position, const std::string& what) const {
        fail_at(file_, position, ErrorCode::kFileFormat, what);
    }

    SourceFile file_;
    Cursor cursor_;
    bool is_grid_ = false;
    ScalarReader reader_;
    LegacyArrays arrays_;
    VtkCells cells_;
    std::vector<Vec3> points_;
    bool has_points_ = false;
    CellKind last_kind_ = CellKind::kSkipped;
    bool in_order_ = true;                         // the cells, as their arrays will be
    std::vector<std::uint32_t> grid_corners_;      // of the cells of a grid whose types are not known yet
    std::vector<std::size_t> grid_offsets_ = {0};  // into grid_corners_, of each cell and one more
    std::vector<std::uint32_t> corners_;           // scratch
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
    is_grid_ = is_word(dataset, "unstructured_grid");
    if (!is_grid_ && !is_word(dataset, "polydata")) {
        cursor_.fail_expected(cursor_.position() - dataset.size(),
                              "'POLYDATA' or 'UNSTRUCTURED_GRID', the only VTK datasets that are read");
    }
    file_.text = !binary;
    return {file_, cursor_, binary ? Encoding::kBigEndian : Encoding::kText};
}

// False at the end of the geometry.
bool VtkParser::parse_section() {
    const std::string_view word = cursor_.token();
    if (word.empty() || is_word(word, "point_data") || is_word(word, "cell_data")) {
        parse_attributes(word);
        return false;
    }
    if (is_word(word, "points")) {
        parse_points();
    } else if (is_grid_ && is_word(word, "cells")) {
        parse_cells(CellKind::kGrid);
    } else if (is_grid_ && is_word(word, "cell_types")) {
        parse_cell_types();
    } else if (!is_grid_ && is_word(word, "polygons")) {
        parse_cells(CellKind::kPolygons);
    } else if (!is_grid_ && is_word(word, "triangle_strips")) {
        parse_cells(CellKind::kStrips);
    } else if (!is_grid_ && (is_word(word, "vertices") || is_word(word, "lines"))) {
        parse_cells(CellKind::kSkipped);
    } else if (is_word(word, "metadata")) {
        arrays_.skip_metadata();
    } else if (is_word(word, "field")) {
        arrays_.parse_field(nullptr);
    } else {
        cursor_.fail_expected(cursor_.position() - word.size(),
                              is_grid_ ? "a section POINTS, CELLS, CELL_TYPES, METADATA, FIELD, POINT_DATA or CELL_DATA"
                                       : "a section POINTS, VERTICES, LINES, POLYGONS, TRIANGLE_STRIPS, METADATA, "
                                         "FIELD, POINT_DATA or CELL_DATA");
    }
    return true;
}

void VtkParser::parse_attributes(std::string_view section) {
    if (in_order_) return arrays_.parse_attributes(section, cells_);
    cells_.report_unread(file_.path +
                         ": the cell data are not read, because the cells do not stand in the order vertices, lines, "
                         "polygons, strips");
}

void VtkParser::parse_points() {
    const std::size_t begin = cursor_.position();
    if (has_points_) fail(begin, "expected one section POINTS, found a second one");
    const std::uint64_t count = cursor_.count("the number of points");
    const ScalarType type = arrays_.parse_type();
    arrays_.begin_array();
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
    if (count > 0) {
        in_order_ = in_order_ && kind >= last_kind_;
        last_kind_ = kind;
    }
    const std::size_t header_end = cursor_.position();
    if (is_word(cursor_.peek(), "offsets")) {
        parse_offset_cells(kind, count, size);
        return;
    }
    cursor_.move_to(header_end);
    arrays_.begin_array();
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
        cells_.skip(cell_count);
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
    const ScalarType offset_type = arrays_.parse_type();
    arrays_.begin_array();
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
    const ScalarType type = arrays_.parse_type();
    arrays_.begin_array();
    check_count(file_, cursor_.position(), size, file_.text ? 1 : scalar_size(type), "corners");
    if (kind == CellKind::kSkipped) {
        reader_.skip(type, size);
        cells_.skip(offsets.empty() ? 0 : offsets.size() - 1);
        return;
    }
    for (std::size_t i = 1; i < offsets.size(); ++i) {
        parse_cell(kind, type, offsets[i] - offsets[i - 1], cursor_.position());
    }
}

void VtkParser::parse_cell(CellKind kind, ScalarType type, std::uint64_t corner_count, std::size_t position) {
    corners_.resize(corner_count);
    for (std::uint32_t& corner : corners_) corner = reader_.index(type, points_.size());
    if (kind == CellKind::kGrid) {
        grid_corners_.insert(grid_corners_.end(), corners_.begin(), corners_.end());
        grid_offsets_.push_back(grid_corners_.size());
    } else if (kind == CellKind::kStrips) {
        cells_.add_strip(corners_, position);
    } else {
        cells_.add_polygon(corners_, position);
    }
}

// Cells of a grid, once their types are known.
void VtkParser::parse_cell_types() {
    const std::size_t begin = cursor_.position();
    const std::uint64_t count = cursor_.count("the number of cell types");
    if (count + 1 != grid_offsets_.size()) {
        fail(begin, "expected as many cell types as cells, " + std::to_string(grid_offsets_.size() - 1) + ", found " +
                        std::to_string(count));
    }
    arrays_.begin_array();
    for (std::size_t c = 0; c < count; ++c) {
        const std::int64_t type = reader_.integer(ScalarType::kInt32, "the type of a cell");
        const std::size_t size = grid_offsets_[c + 1] - grid_offsets_[c];
        add_grid_cell(type, std::span(grid_corners_).subspan(grid_offsets_[c], size), reader_.last_position());
    }
    grid_offsets_ = {0};
    grid_corners_.clear();
}

// Types by VTK's numbers (vtkCellType.h).
void VtkParser::add_grid_cell(std::int64_t type, std::span<std::uint32_t> corners, std::size_t position) {
    constexpr std::int64_t kPolyline = 4, kTriangle = 5, kStrip = 6, kPixel = 8, kQuad = 9;
    if (type >= 0 && type <= kPolyline) return cells_.skip(1);
    if (type < 0 || type > kQuad) {
        fail(position, "expected a surface of triangles, quads, polygons and strips, found a cell of VTK type " +
                           std::to_string(type) + "; extract the surface of the grid first");
    }
    const std::size_t needed = type == kTriangle ? 3 : type == kPixel || type == kQuad ? 4 : corners.size();
    if (corners.size() != needed) {
        fail(position, "expected " + std::to_string(needed) + " corners of a cell of VTK type " + std::to_string(type) +
                           ", found " + std::to_string(corners.size()));
    }
    if (type == kStrip) return cells_.add_strip(corners, position);
    if (type == kPixel) std::swap(corners[2], corners[3]);  // a pixel's corners run row by row
    cells_.add_polygon(corners, position);
}

}  // namespace

TriangleSoup parse_vtk_legacy(const SourceFile& file) { return VtkParser(file).parse(); }

}  // namespace lumenline::mesh
