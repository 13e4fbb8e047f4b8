// Numbers go in base64: VTK's reader of decimal text stops at the first nan or inf. Bytes are little-endian, as the
// machines that this is built for.
#include "io/export/polydata.h"

#include <openssl/evp.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <ostream>

#include "io/archive/commit.h"

namespace lumenline {

namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kBlock = 3 * 16384;  // bytes encoded at a time: whole groups of three

/// A data array in base64: its size in bytes and the values, in one stream.
template <class Stored, class Value>
void write_array(std::ostream& out, const char* type, const std::string& name, std::size_t components,
                 const std::vector<Value>& values) {
    std::vector<unsigned char> bytes(sizeof(std::uint64_t) + values.size() * sizeof(Stored));
    const std::uint64_t size = values.size() * sizeof(Stored);
    std::memcpy(bytes.data(), &size, sizeof size);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto stored = static_cast<Stored>(values[i]);
        std::memcpy(bytes.data() + sizeof size + i * sizeof stored, &stored, sizeof stored);
    }
    out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\"" << components
        << "\" format=\"binary\">\n";
    std::vector<unsigned char> text(4 * (kBlock / 3) + 1);
    for (std::size_t first = 0; first < bytes.size(); first += kBlock) {
        const std::size_t count = std::min(kBlock, bytes.size() - first);
        const int length = EVP_EncodeBlock(text.data(), bytes.data() + first, static_cast<int>(count));
        out.write(reinterpret_cast<const char*>(text.data()), length);
    }
    out << "\n</DataArray>\n";
}

void write_array(std::ostream& out, const PolyDataArray& array) {
    if (array.is_integer)
        write_array<std::int32_t>(out, "Int32", array.name, array.components, array.values);
    else
        write_array<double>(out, "Float64", array.name, array.components, array.values);
}

void write_cells(std::ostream& out, const char* kind, const PolyDataCells& cells) {
    out << '<' << kind << ">\n";
    write_array<std::int64_t>(out, "Int64", "connectivity", 1, cells.connectivity);
    write_array<std::int64_t>(out, "Int64", "offsets", 1, cells.offsets);
    out << "</" << kind << ">\n";
}

void write_document(std::ostream& out, const PolyData& data) {
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
           "header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\""
        << data.points.size() / 3 << "\" NumberOfVerts=\"0\" NumberOfLines=\"" << data.lines.offsets.size()
        << "\" NumberOfStrips=\"0\" NumberOfPolys=\"" << data.polygons.offsets.size() << "\">\n<PointData>\n";
    for (const PolyDataArray& array : data.point_arrays) write_array(out, array);
    out << "</PointData>\n<CellData>\n";
    for (const PolyDataArray& array : data.cell_arrays) write_array(out, array);
    out << "</CellData>\n<Points>\n";
    write_array(out, {"Points", 3, data.points, false});
    out << "</Points>\n";
    write_cells(out, "Lines", data.lines);
    write_cells(out, "Polys", data.polygons);
    out << "</Piece>\n</PolyData>\n</VTKFile>\n";
}

}  // namespace

void write_polydata(const std::filesystem::path& file, const PolyData& data) {
    write_file(file, [&data](std::ostream& out) { write_document(out, data); });
}

}  // namespace lumenline
