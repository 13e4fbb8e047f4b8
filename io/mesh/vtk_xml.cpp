// VTK XML polydata (.vtp). The XML is parsed by pugixml from a copy of the file's head, byte for byte at the same
// place, so that a text of the tree is found again in the file and messages can tell its line; text is therefore
// left as it stands (no line ends changed, no trimming).
//
// Raw appended data are no XML at all: any byte may stand there. The head ends where <AppendedData> begins; the
// data go from the '_' behind that tag to the last </AppendedData> of the file.
//
// Offsets are the end of each cell in the connectivity, without the zero in front. The arrays of cells count
// vertices, lines, polygons and strips in this order, whatever that of the elements.

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <new>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <utility>

#include "engine/core/text.h"
#include "io/mesh/formats.h"
#include "io/mesh/vtk_cells.h"
#include "io/mesh/vtk_xml_array.h"

namespace lumenline::mesh {
namespace {

constexpr std::array<std::pair<std::string_view, ScalarType>, 10> kTypes{{{"Int8", ScalarType::kInt8},
                                                                          {"UInt8", ScalarType::kUint8},
                                                                          {"Int16", ScalarType::kInt16},
                                                                          {"UInt16", ScalarType::kUint16},
                                                                          {"Int32", ScalarType::kInt32},
                                                                          {"UInt32", ScalarType::kUint32},
                                                                          {"Int64", ScalarType::kInt64},
                                                                          {"UInt64", ScalarType::kUint64},
                                                                          {"Float32", ScalarType::kFloat32},
                                                                          {"Float64", ScalarType::kFloat64}}};
constexpr std::string_view kAppendedBegin = "<AppendedData";
constexpr std::string_view kAppendedEnd = "</AppendedData";

class XmlParser {
public:
    explicit XmlParser(const SourceFile& file) : file_(file), cells_(file_) {}
    XmlParser(const XmlParser&) = delete;
    XmlParser& operator=(const XmlParser&) = delete;

    TriangleSoup parse() {
        parse_tree();
        const pugi::xml_node root = tree_.document_element();
        parse_root(root);
        const pugi::xml_node data = root.child("PolyData");
        if (!data) fail(root, "expected an element PolyData, found none");
        for (const pugi::xml_node piece : data.children("Piece")) parse_piece(piece);
        return cells_.make_soup(std::move(points_), digits_);
    }

private:
    void parse_tree();
    void cut_appended(std::size_t begin);
    void parse_root(pugi::xml_node root);
    void parse_piece(pugi::xml_node piece);
    void parse_points(pugi::xml_node piece, std::uint64_t count);
    void parse_cells(pugi::xml_node piece, const char* element, const char* number);
    void parse_labels(pugi::xml_node piece);
    XmlArray array_of(pugi::xml_node element);
    void find_text(pugi::xml_node element, XmlArray& array);
    std::uint64_t parse_count(pugi::xml_node piece, const char* name) const;
    std::optional<std::uint64_t> whole_number(pugi::xml_node element, const char* name) const;

    [[nodiscard]] std::size_t position(pugi::xml_node node) const {
        return static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0));
    }
    [[noreturn]] void fail(pugi::xml_node node, const std::string& what) const {
        fail_at(file_, position(node), ErrorCode::kFileFormat, what);
    }

    SourceFile file_;
    std::string head_;  // copy of the file without the appended data, in which pugixml leaves its texts
    pugi::xml_document tree_;
    XmlStorage storage_;
    bool has_appended_ = false;
    bool appended_is_base64_ = false;
    std::size_t appended_begin_ = 0, appended_end_ = 0;  // behind the '_'
    std::size_t tail_begin_ = 0;                         // in head_, of what follows the appended data
    VtkCells cells_;
    std::vector<Vec3> points_;
    std::size_t first_point_ = 0;  // of the piece
    int digits_ = 0;
    std::vector<std::uint64_t> offsets_;  // scratch
    std::vector<std::uint32_t> corners_;  // scratch
};

void XmlParser::parse_tree() {
    const std::size_t cut = file_.bytes.find(kAppendedBegin);
    if (cut != std::string_view::npos) {
        cut_appended(cut);
    } else {
        head_ = file_.bytes;
    }
    if (const std::size_t nul = head_.find('\0'); nul != std::string::npos) {
        fail_at(file_, nul, ErrorCode::kFileFormat, "expected XML, found a NUL byte");
    }
    const pugi::xml_parse_result result =
        tree_.load_buffer_inplace(head_.data(), head_.size(), pugi::parse_escapes, pugi::encoding_utf8);
    if (result.status == pugi::status_out_of_memory) throw std::bad_alloc();
    if (!result) {
        auto at = static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0));
        if (has_appended_ && at > tail_begin_) at += appended_end_ - tail_begin_;
        at = std::min(at, file_.bytes.size());
        std::string why = result.description();
        why.front() =
            why.front() >= 'A' && why.front() <= 'Z' ? static_cast<char>(why.front() - 'A' + 'a') : why.front();
        fail_at(file_, at, ErrorCode::kFileFormat, "expected well-formed XML to the end of the file, found: " + why);
    }
}

// Leaves the tag in the head, closed, and the rest of the file out of it.
void XmlParser::cut_appended(std::size_t begin) {
    const std::size_t tag_end = file_.bytes.find('>', begin);
    const std::size_t end = file_.bytes.rfind(kAppendedEnd);
    if (tag_end == std::string_view::npos || end == std::string_view::npos || end < tag_end) {
        fail_at(file_, begin, ErrorCode::kFileFormat,
                "expected appended data up to '</AppendedData>', found the end of the file");
    }
    const std::size_t data = file_.bytes.find_first_not_of(" \t\r\n", tag_end + 1);
    if (file_.bytes[data] != '_') {
        fail_at(file_, data, ErrorCode::kFileFormat,
                "expected '_' before the appended data, found " + in_quotes(file_.bytes.substr(data, 1)));
    }
    has_appended_ = true;
    appended_begin_ = data + 1;
    appended_end_ = end;
    tail_begin_ = tag_end + 1;
    head_ = file_.bytes.substr(0, tail_begin_);
    head_ += file_.bytes.substr(end);
}

void XmlParser::parse_root(pugi::xml_node root) {
    if (std::strcmp(root.name(), "VTKFile") != 0) {
        fail(root, "expected an element VTKFile, found " + in_quotes(root.name()));
    }
    const std::string_view type = root.attribute("type").value();
    if (type != "PolyData") {
        fail(root, "expected type 'PolyData', the only VTK XML dataset that is read, found " + in_quotes(type));
    }
    const std::string_view order = root.attribute("byte_order").as_string("LittleEndian");
    if (order != "LittleEndian" && order != "BigEndian") {
        fail(root, "expected byte_order 'LittleEndian' or 'BigEndian', found " + in_quotes(order));
    }
    storage_.encoding = order == "BigEndian" ? Encoding::kBigEndian : Encoding::kLittleEndian;
    const std::string_view header = root.attribute("header_type").as_string("UInt32");
    if (header != "UInt32" && header != "UInt64") {
        fail(root, "expected header_type 'UInt32' or 'UInt64', found " + in_quotes(header));
    }
    storage_.header_size = header == "UInt64" ? 8 : 4;
    const std::string_view compressor = root.attribute("compressor").value();
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor") {
        fail(root, "expected compressor 'vtkZLibDataCompressor' or none, found " + in_quotes(compressor) +
                       ", which is not read; save the file with zlib compression or without any");
    }
    storage_.compressed = !compressor.empty();
    if (!has_appended_) return;
    const pugi::xml_node appended = root.child("AppendedData");
    const std::string_view encoding = appended.attribute("encoding").as_string("base64");
    if (encoding != "raw" && encoding != "base64") {
        fail(appended, "expected encoding 'raw' or 'base64' of the appended data, found " + in_quotes(encoding));
    }
    appended_is_base64_ = encoding == "base64";
}

std::optional<std::uint64_t> XmlParser::whole_number(pugi::xml_node element, const char* name) const {
    std::string_view text = element.attribute(name).value();
    text = text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    text = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
    std::uint64_t value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || stop != text.data() + text.size()) return std::nullopt;
    return value;
}

std::uint64_t XmlParser::parse_count(pugi::xml_node piece, const char* name) const {
    if (!piece.attribute(name)) return 0;
    const std::optional<std::uint64_t> count = whole_number(piece, name);
    if (!count) {
        fail(piece,
             "expected " + std::string(name) + " to be a count, found " + in_quotes(piece.attribute(name).value()));
    }
    check_count(file_, position(piece), *count, 0, name);
    return *count;
}

void XmlParser::parse_piece(pugi::xml_node piece) {
    if (!piece.attribute("NumberOfPoints"))
        fail(piece, "expected an attribute NumberOfPoints of the piece, found none");
    cells_.begin_piece();
    cells_.skip(parse_count(piece, "NumberOfVerts") + parse_count(piece, "NumberOfLines"));
    first_point_ = points_.size();
    parse_points(piece, parse_count(piece, "NumberOfPoints"));
    parse_cells(piece, "Polys", "NumberOfPolys");
    parse_cells(piece, "Strips", "NumberOfStrips");
    parse_labels(piece);
}

void XmlParser::parse_points(pugi::xml_node piece, std::uint64_t count) {
    if (count == 0) return;
    const pugi::xml_node element = piece.child("Points").child("DataArray");
    if (!element) fail(piece, "expected an array of the " + counted(count, "point") + " of the piece, found none");
    if (whole_number(element, "NumberOfComponents") != 3) {
        fail(element, "expected points of NumberOfComponents 3, found " +
                          in_quotes(element.attribute("NumberOfComponents").value()));
    }
    check_count(file_, position(element), points_.size() + count, 0, "points");
    XmlNumbers numbers(file_, storage_, array_of(element), 3 * count);
    points_.reserve(points_.size() + count);
    for (std::uint64_t i = 0; i < count; ++i) {
        const double x = numbers.coordinate();
        const double y = numbers.coordinate();
        points_.push_back({x, y, numbers.coordinate()});
    }
    numbers.expect_end();
    digits_ = std::max(digits_, numbers.digits());
}

void XmlParser::parse_cells(pugi::xml_node piece, const char* element, const char* number) {
    const std::uint64_t count = parse_count(piece, number);
    if (count == 0) return;
    const pugi::xml_node section = piece.child(element);
    const pugi::xml_node ends = section.find_child_by_attribute("DataArray", "Name", "offsets");
    const pugi::xml_node connectivity = section.find_child_by_attribute("DataArray", "Name", "connectivity");
    if (!ends || !connectivity) {
        fail(section ? section : piece, "expected arrays 'connectivity' and 'offsets' in " + std::string(element) +
                                            " of the piece, which has " + std::to_string(count) + ", found not both");
    }
    XmlNumbers offsets(file_, storage_, array_of(ends), count);
    offsets_.clear();
    std::int64_t last = 0;
    for (std::uint64_t c = 0; c < count; ++c) {
        const std::int64_t end = offsets.integer("a cell offset");
        if (end < last) {
            offsets.fail("expected a cell offset of at least " + std::to_string(last) + ", found " +
                         std::to_string(end));
        }
        offsets_.push_back(static_cast<std::uint64_t>(end));
        last = end;
    }
    offsets.expect_end();
    check_count(file_, position(ends), offsets_.back(), 0, "corners");

    XmlNumbers corners(file_, storage_, array_of(connectivity), offsets_.back());
    const bool is_strips = std::strcmp(element, "Strips") == 0;
    std::uint64_t begin = 0;
    for (const std::uint64_t end : offsets_) {
        corners_.resize(end - begin);
        for (std::uint32_t& corner : corners_) {
            corner = static_cast<std::uint32_t>(first_point_ + corners.index(points_.size() - first_point_));
        }
        if (is_strips) {
            cells_.add_strip(corners_, corners.position());
        } else {
            cells_.add_polygon(corners_, corners.position());
        }
        begin = end;
    }
    corners.expect_end();
}

// The surface is complete without the arrays of its cells: a fault among them costs the labels only.
void XmlParser::parse_labels(pugi::xml_node piece) {
    for (const pugi::xml_node element : piece.child("CellData").children("DataArray")) {
        const char* components = element.attribute("NumberOfComponents").as_string("1");
        const std::string_view type = element.attribute("type").value();
        if (std::strcmp(components, "1") != 0 || type == "String" || !cells_.takes_arrays()) continue;
        try {
            XmlNumbers numbers(file_, storage_, array_of(element), cells_.cells());
            std::vector<double> values;
            values.reserve(cells_.cells());
            for (std::uint64_t c = 0; c < cells_.cells(); ++c) values.push_back(numbers.number());
            numbers.expect_end();
            cells_.add_array(element.attribute("Name").value(), values);
        } catch (const StageError& error) {
            cells_.report_unread(std::string(error.what()) + "; this array of the cells is not read");
        }
    }
}

XmlArray XmlParser::array_of(pugi::xml_node element) {
    XmlArray array;
    const std::string_view type = element.attribute("type").value();
    const auto found = std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& t) { return t.first == type; });
    if (found == kTypes.end()) {
        fail(element, "expected an array of type Int8 to UInt64, Float32 or Float64, found " + in_quotes(type));
    }
    array.type = found->second;
    const std::string_view format = element.attribute("format").as_string("ascii");
    if (format == "ascii" || format == "binary") {
        array.format = format == "ascii" ? XmlArray::Format::kText : XmlArray::Format::kBase64;
        find_text(element, array);
        return array;
    }
    if (format != "appended") {
        fail(element, "expected format 'ascii', 'binary' or 'appended', found " + in_quotes(format));
    }
    if (!has_appended_) fail(element, "expected an element AppendedData for the appended array, found none");
    const std::optional<std::uint64_t> offset = whole_number(element, "offset");
    if (!offset || *offset >= appended_end_ - appended_begin_) {
        fail(element, "expected an offset below the size of the appended data, " +
                          std::to_string(appended_end_ - appended_begin_) + ", found " +
                          in_quotes(element.attribute("offset").value()));
    }
    array.format = appended_is_base64_ ? XmlArray::Format::kBase64 : XmlArray::Format::kRaw;
    array.begin = appended_begin_ + *offset;
    array.end = appended_end_;
    return array;
}

// The one text among the children: VTK puts elements of information behind it.
void XmlParser::find_text(pugi::xml_node element, XmlArray& array) {
    pugi::xml_node text;
    for (const pugi::xml_node child : element.children()) {
        if (child.type() != pugi::node_pcdata) continue;
        if (text) fail(element, "expected the numbers of the array in one piece of text, found several");
        text = child;
    }
    array.begin = text ? static_cast<std::size_t>(text.value() - head_.data()) : position(element);
    array.end = text ? std::min(file_.bytes.find('<', array.begin), file_.bytes.size()) : array.begin;
    array.begin = std::min(file_.bytes.find_first_not_of(" \t\r\n", array.begin), array.end);
}

}  // namespace

TriangleSoup parse_vtk_xml(const SourceFile& file) { return XmlParser(file).parse(); }

}  // namespace lumenline::mesh
