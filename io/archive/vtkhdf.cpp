// Layout of VTKHDF 1.0, UnstructuredGrid, in one piece: the three counts are arrays with one entry
// per piece, `Offsets` has one entry more than there are cells, ids are int64. The grid repeats the
// points of /surface and /centerlines, since VTK follows neither links nor references.

#include "io/archive/vtkhdf.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace lumenline {

namespace {

constexpr std::uint8_t kVtkPolyLine = 4;
constexpr std::uint8_t kVtkTriangle = 5;
constexpr std::uint8_t kWallPart = 0;
constexpr std::uint8_t kCapPart = 1;
constexpr std::uint8_t kCenterlinePart = 2;

struct Cells {
    std::vector<std::int64_t> connectivity;
    std::vector<std::int64_t> offsets{0};
    std::vector<std::uint8_t> types;
    std::vector<std::uint8_t> part;

    void close_cell(std::uint8_t type, std::uint8_t cell_part) {
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
        types.push_back(type);
        part.push_back(cell_part);
    }
};

void add_triangles(const Surface& surface, Cells& cells) {
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        for (const SiteId site : surface.triangles[t]) cells.connectivity.push_back(site.value);
        cells.close_cell(kVtkTriangle, surface.cap[t].is_none() ? kWallPart : kCapPart);
    }
}

void add_lines(const Centerlines& lines, std::size_t first_point, Cells& cells) {
    for (std::size_t line = 0; line < lines.line_count(); ++line) {
        for (std::size_t k = lines.offsets[line]; k < lines.offsets[line + 1]; ++k)
            cells.connectivity.push_back(static_cast<std::int64_t>(first_point + k));
        cells.close_cell(kVtkPolyLine, kCenterlinePart);
    }
}

void write_points(hdf::Writer& writer, const std::vector<Vec3>& sites, const Centerlines& lines) {
    const hsize_t count = sites.size() + lines.points.size();
    const hsize_t shape[]{count, 3};
    const hdf::Rows points[]{{sites.data(), sites.size()}, {lines.points.data(), lines.points.size()}};
    writer.numbers(names::kVtkPoints, shape, hdf::Number::kFloat64, hdf::Number::kFloat64, points);
    std::vector<double> radius(sites.size(), std::numeric_limits<double>::quiet_NaN());
    radius.insert(radius.end(), lines.radius.begin(), lines.radius.end());
    writer.column(names::kVtkRadius, radius, count);
}

}  // namespace

void write_vtkhdf(hdf::Writer& writer, const ModelRecord& record, bool with_surface) {
    if (!(record.surface && with_surface) && !record.centerlines) return;
    const Surface no_surface;
    const Centerlines no_lines;
    const Surface& surface = record.surface && with_surface ? *record.surface : no_surface;
    const Centerlines& lines = record.centerlines ? *record.centerlines : no_lines;

    Cells cells;
    const std::size_t count = surface.triangles.size() + lines.line_count();
    cells.connectivity.reserve(3 * surface.triangles.size() + lines.points.size());
    cells.offsets.reserve(count + 1);
    cells.types.reserve(count);
    cells.part.reserve(count);
    add_triangles(surface, cells);
    add_lines(lines, surface.points.size(), cells);

    writer.group(names::kVtk);
    writer.vtk_attributes(names::kVtk);
    const auto one = [](std::size_t n) { return std::vector<std::int64_t>{static_cast<std::int64_t>(n)}; };
    writer.column(names::kVtkPointCount, one(surface.points.size() + lines.points.size()));
    writer.column(names::kVtkCellCount, one(cells.types.size()));
    writer.column(names::kVtkIdCount, one(cells.connectivity.size()));
    write_points(writer, surface.points, lines);
    writer.column(names::kVtkConnectivity, cells.connectivity);
    writer.column(names::kVtkOffsets, cells.offsets);
    writer.column(names::kVtkTypes, cells.types);
    writer.column(names::kVtkPart, cells.part);
}

}  // namespace lumenline
