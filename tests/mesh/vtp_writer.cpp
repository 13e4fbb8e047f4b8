// A writer of VTK XML polydata, as small as its forms allow.

#include "tests/mesh/vtp_writer.h"

#include <zlib.h>

#include <sstream>
#include <stdexcept>

#include "tests/mesh/samples.h"

namespace lumenline::samples {
namespace {

using Numbers = std::vector<double>;

std::string header_bytes(const std::vector<std::size_t>& numbers, const VtpStyle& style) {
    std::string bytes;
    for (const std::size_t n : numbers) {
        bytes += style.header_size == 8 ? bytes_of(static_cast<std::uint64_t>(n), style.order)
                                        : bytes_of(static_cast<std::uint32_t>(n), style.order);
    }
    return bytes;
}

std::string zipped(const std::string& bytes) {
    uLongf size = compressBound(bytes.size());
    std::string out(size, '\0');
    compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    out.resize(size);
    return out;
}

class VtpWriter {
public:
    explicit VtpWriter(const VtpStyle& style) : style_(style) {}

    std::string file(const std::vector<VtpPiece>& pieces) {
        out_ << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\""
             << (style_.order == std::endian::big ? "BigEndian" : "LittleEndian") << "\" header_type=\""
             << (style_.header_size == 8 ? "UInt64" : "UInt32") << "\""
             << (style_.block > 0 ? " compressor=\"vtkZLibDataCompressor\"" : "") << ">\n<PolyData>\n";
        for (const VtpPiece& piece : pieces) write(piece);
        out_ << "</PolyData>\n";
        if (is_appended()) {
            const bool raw = style_.format == VtpStyle::Format::kAppendedRaw;
            out_ << "<AppendedData encoding=\"" << (raw ? "raw" : "base64") << "\">\n_" << appended_
                 << "\n</AppendedData>\n";
        }
        out_ << "</VTKFile>\n";
        return out_.str();
    }

private:
    [[nodiscard]] bool is_appended() const {
        return style_.format == VtpStyle::Format::kAppendedBase64 || style_.format == VtpStyle::Format::kAppendedRaw;
    }

    void write(const VtpPiece& piece) {
        out_ << "<Piece NumberOfPoints=\"" << piece.points.size() << "\" NumberOfVerts=\"" << piece.verts.size()
             << "\" NumberOfLines=\"" << piece.lines.size() << "\" NumberOfStrips=\"" << piece.strips.size()
             << "\" NumberOfPolys=\"" << piece.polys.size() << "\">\n<PointData/>\n<CellData>\n";
        for (const VtpPiece::Array& array : piece.cell_arrays) {
            write_array(array.name, array.type, piece.cells() > 0 ? array.values.size() / piece.cells() : 1,
                        array.values);
        }
        out_ << "</CellData>\n<Points>\n";
        Numbers coordinates;
        for (const Vec3& p : piece.points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
        write_array("Points", style_.point_type, 3, coordinates);
        out_ << "</Points>\n";
        write_cells("Verts", piece.verts);
        write_cells("Lines", piece.lines);
        write_cells("Strips", piece.strips);
        write_cells("Polys", piece.polys);
        out_ << "</Piece>\n";
    }

    void write_cells(const std::string& element, const std::vector<std::vector<int>>& cells) {
        Numbers corners;
        Numbers offsets;
        for (const std::vector<int>& cell : cells) {
            corners.insert(corners.end(), cell.begin(), cell.end());
            offsets.push_back(static_cast<double>(corners.size()));
        }
        out_ << "<" << element << ">\n";
        write_array("connectivity", style_.index_type, 1, corners);
        write_array("offsets", style_.index_type, 1, offsets);
        out_ << "</" << element << ">\n";
    }

    void write_array(const std::string& name, const std::string& type, std::size_t components, const Numbers& values) {
        out_ << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\"" << components
             << "\" format=\"";
        std::string bytes;
        for (const double v : values) bytes += number_bytes(v, type, style_.order);
        if (is_appended()) {
            out_ << "appended\" offset=\"" << appended_.size() << "\"/>\n";
            appended_ += stored_array(bytes, style_, style_.format == VtpStyle::Format::kAppendedBase64);
        } else if (style_.format == VtpStyle::Format::kBinary) {
            out_ << "binary\">\n  " << stored_array(bytes, style_, true) << "\n</DataArray>\n";
        } else {
            out_ << "ascii\">\n ";
            for (const double v : values) out_ << ' ' << v;
            out_ << "\n<InformationKey name=\"L2_NORM_RANGE\"><Value index=\"0\">7</Value></InformationKey>\n"
                    "</DataArray>\n";
        }
    }

    const VtpStyle& style_;
    std::ostringstream out_;
    std::string appended_;
};

}  // namespace

std::string base64(const std::string& bytes) {
    constexpr char kAlphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t b = i; b < i + 3; ++b) {
            bits = bits << 8U | (b < bytes.size() ? static_cast<unsigned char>(bytes[b]) : 0U);
        }
        for (std::size_t c = 0; c < 4; ++c) {
            text += i + c <= bytes.size() ? kAlphabet[bits >> (18 - 6 * c) & 63U] : '=';
        }
    }
    return text;
}

std::string number_bytes(double value, const std::string& type, std::endian order) {
    if (type == "Int8") return bytes_of(static_cast<std::int8_t>(value), order);
    if (type == "UInt8") return bytes_of(static_cast<std::uint8_t>(value), order);
    if (type == "Int16") return bytes_of(static_cast<std::int16_t>(value), order);
    if (type == "UInt16") return bytes_of(static_cast<std::uint16_t>(value), order);
    if (type == "Int32") return bytes_of(static_cast<std::int32_t>(value), order);
    if (type == "UInt32") return bytes_of(static_cast<std::uint32_t>(value), order);
    if (type == "Int64") return bytes_of(static_cast<std::int64_t>(value), order);
    if (type == "UInt64") return bytes_of(static_cast<std::uint64_t>(value), order);
    if (type == "Float32") return bytes_of(static_cast<float>(value), order);
    if (type == "Float64") return bytes_of(value, order);
    throw std::out_of_range("no type " + type);
}

std::string stored_array(const std::string& bytes, const VtpStyle& style, bool in_base64) {
    if (style.block == 0) {
        const std::string all = header_bytes({bytes.size()}, style) + bytes;
        return in_base64 ? base64(all) : all;
    }
    std::vector<std::size_t> numbers{(bytes.size() + style.block - 1) / style.block, style.block,
                                     bytes.size() % style.block};
    std::string blocks;
    for (std::size_t i = 0; i < bytes.size(); i += style.block) {
        const std::string block = zipped(bytes.substr(i, style.block));
        numbers.push_back(block.size());
        blocks += block;
    }
    const std::string header = header_bytes(numbers, style);
    return in_base64 ? base64(header) + base64(blocks) : header + blocks;
}

std::string vtp_file(const std::vector<VtpPiece>& pieces, const VtpStyle& style) {
    return VtpWriter(style).file(pieces);
}

}  // namespace lumenline::samples
