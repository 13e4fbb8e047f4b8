// PLY, ascii and binary of either byte order. The header declares elements and, for each, properties in any
// order and of any type; the body follows the header blindly, so properties that are not needed are passed over
// one by one by their declared type. Reading stops when points and faces are complete.
//
// In a binary file the data begin right behind the line end of "end_header", whose kind (LF, CRLF, CR) is that of
// the first line: the first data byte may itself look like a line end.

#include <array>
#include <utility>

#include "io/mesh/faces.h"
#include "io/mesh/formats.h"
#include "io/mesh/scalars.h"

namespace lumenline::mesh {
namespace {

enum class Role { kNone, kX, kY, kZ, kCorners };

struct Property {
    ScalarType type = ScalarType::kFloat32;  ///< of the number, or of the items of a list
    std::optional<ScalarType> count_type;    ///< of the list's length; none = no list
    Role role = Role::kNone;
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::size_t header_position = 0;
    std::vector<Property> properties;

    [[nodiscard]] bool has(Role role) const {
        for (const Property& p : properties) {
            if (p.role == role) return true;
        }
        return false;
    }
};

struct Header {
    Encoding encoding = Encoding::kText;
    std::vector<Element> elements;
    std::size_t body = 0;  ///< position of the data

    [[nodiscard]] const Element* find(std::string_view name) const {
        for (const Element& e : elements) {
            if (e.name == name) return &e;
        }
        return nullptr;
    }
};

ScalarType parse_type(Cursor& cursor) {
    static constexpr std::array<std::pair<std::string_view, ScalarType>, 16> kTypes{{
        {"char", ScalarType::kInt8},
        {"int8", ScalarType::kInt8},
        {"uchar", ScalarType::kUint8},
        {"uint8", ScalarType::kUint8},
        {"short", ScalarType::kInt16},
        {"int16", ScalarType::kInt16},
        {"ushort", ScalarType::kUint16},
        {"uint16", ScalarType::kUint16},
        {"int", ScalarType::kInt32},
        {"int32", ScalarType::kInt32},
        {"uint", ScalarType::kUint32},
        {"uint32", ScalarType::kUint32},
        {"float", ScalarType::kFloat32},
        {"float32", ScalarType::kFloat32},
        {"double", ScalarType::kFloat64},
        {"float64", ScalarType::kFloat64},
    }};
    const std::string_view word = cursor.token();
    for (const auto& [name, type] : kTypes) {
        if (word == name) return type;
    }
    cursor.fail_expected(cursor.position() - word.size(), "a property type (char to double, int8 to float64)");
}

Encoding parse_encoding(Cursor& cursor) {
    const std::string_view word = cursor.token();
    if (word == "ascii") return Encoding::kText;
    if (word == "binary_little_endian") return Encoding::kLittleEndian;
    if (word == "binary_big_endian") return Encoding::kBigEndian;
    cursor.fail_expected(cursor.position() - word.size(), "'ascii', 'binary_little_endian' or 'binary_big_endian'");
}

Role role_of(std::string_view element, std::string_view property, bool is_list) {
    if (element == "vertex" && !is_list && property == "x") return Role::kX;
    if (element == "vertex" && !is_list && property == "y") return Role::kY;
    if (element == "vertex" && !is_list && property == "z") return Role::kZ;
    const bool corners = property == "vertex_indices" || property == "vertex_index";
    return element == "face" && is_list && corners ? Role::kCorners : Role::kNone;
}

void parse_property(const SourceFile& file, Cursor& cursor, Element& element) {
    Property property;
    if (cursor.peek() == "list") {
        cursor.token();
        cursor.peek();
        const std::size_t at = cursor.position();
        property.count_type = parse_type(cursor);
        if (is_floating(*property.count_type)) cursor.fail_expected(at, "an integer type for the length of a list");
    }
    property.type = parse_type(cursor);
    const std::string_view name = cursor.token();
    if (name.empty()) cursor.fail_expected(cursor.position(), "the name of a property");
    property.role = role_of(element.name, name, property.count_type.has_value());
    if (property.role != Role::kNone && element.has(property.role)) {
        fail_at(file, cursor.position(), ErrorCode::kFileFormat,
                "expected each property once, found a second " + in_quotes(name));
    }
    element.properties.push_back(property);
}

Element parse_element(const SourceFile& file, Cursor& cursor, const Header& header) {
    Element element;
    element.header_position = cursor.position();
    element.name = cursor.token();
    if (element.name.empty()) cursor.fail_expected(cursor.position(), "the name of an element");
    if (header.find(element.name) != nullptr) {
        fail_at(file, element.header_position, ErrorCode::kFileFormat,
                "expected each element once, found a second " + in_quotes(element.name));
    }
    element.count = cursor.count("the number of items of element " + in_quotes(element.name));
    return element;
}

// Behind the line end at the cursor, of the kind that ends the first line.
std::size_t body_position(const SourceFile& file, const Cursor& cursor) {
    const std::size_t first = file.bytes.find_first_of("\r\n");
    const std::string_view end = file.bytes.substr(first, 2) == "\r\n" ? "\r\n" : file.bytes.substr(first, 1);
    const std::size_t at = cursor.position();
    if (!file.bytes.substr(at).starts_with(end)) cursor.fail_expected(at, "the end of the line after 'end_header'");
    return at + end.size();
}

Header parse_header(const SourceFile& file) {
    Cursor cursor(file, 0, Layout::kLines);
    if (cursor.peek() != "ply") cursor.fail_expected(cursor.position(), "'ply'");
    cursor.line();
    Header header;
    bool has_format = false;
    while (true) {
        if (cursor.at_end()) cursor.fail_expected(cursor.position(), "'end_header'");
        const std::string_view word = cursor.token();
        if (word == "format") {
            header.encoding = parse_encoding(cursor);
            has_format = true;
        } else if (word == "element") {
            header.elements.push_back(parse_element(file, cursor, header));
        } else if (word == "property" && !header.elements.empty()) {
            parse_property(file, cursor, header.elements.back());
        } else if (word == "end_header") {
            header.body = body_position(file, cursor);
            break;
        } else if (!word.empty() && word != "comment" && word != "obj_info") {
            cursor.fail_expected(
                cursor.position() - word.size(),
                "'format', 'comment', 'obj_info', 'element', 'property' of an element or 'end_header'");
        }
        cursor.line();
    }
    if (!has_format) fail_file(file, ErrorCode::kFileFormat, "expected a line 'format' in the PLY header, found none");
    return header;
}

const Element& require_element(const SourceFile& file, const Header& header, std::string_view name,
                               std::initializer_list<std::pair<Role, std::string_view>> roles) {
    const Element* element = header.find(name);
    if (element == nullptr) {
        fail_file(file, ErrorCode::kFileFormat,
                  "expected an element " + in_quotes(name) + " in the PLY header, found none");
    }
    for (const auto& [role, property] : roles) {
        if (element->has(role)) continue;
        fail_at(file, element->header_position, ErrorCode::kFileFormat,
                "expected a property " + std::string(property) + " of element " + in_quotes(name) + ", found none");
    }
    return *element;
}

void skip_property(const SourceFile& file, ScalarReader& reader, const Property& property) {
    std::uint64_t count = 1;
    if (property.count_type) {
        const std::int64_t length = reader.integer(*property.count_type, "the length of a list");
        if (length < 0) {
            fail_at(file, reader.last_position(), ErrorCode::kFileFormat,
                    "expected the length of a list, found " + std::to_string(length));
        }
        count = static_cast<std::uint64_t>(length);
    }
    reader.skip(property.type, count);
}

std::vector<Vec3> parse_points(const SourceFile& file, ScalarReader& reader, const Element& element) {
    std::vector<Vec3> points(element.count);
    for (Vec3& p : points) {
        for (const Property& property : element.properties) {
            switch (property.role) {
                case Role::kX: p.x = reader.coordinate(property.type); break;
                case Role::kY: p.y = reader.coordinate(property.type); break;
                case Role::kZ: p.z = reader.coordinate(property.type); break;
                default: skip_property(file, reader, property); break;
            }
        }
    }
    return points;
}

void parse_faces(const SourceFile& file, ScalarReader& reader, const Cursor& cursor, const Element& element,
                 std::uint64_t point_count, FaceCollector& faces) {
    faces.reserve(element.count);
    std::vector<std::uint32_t> corners;
    for (std::uint64_t f = 0; f < element.count; ++f) {
        for (const Property& property : element.properties) {
            if (property.role != Role::kCorners) {
                skip_property(file, reader, property);
                continue;
            }
            const std::int64_t length = reader.integer(*property.count_type, "the number of corners of a face");
            const std::size_t begin = reader.last_position();
            if (length < 3) {
                fail_at(file, begin, ErrorCode::kFileFormat,
                        "expected a face of at least 3 corners, found " + std::to_string(length));
            }
            check_count(file, cursor.position(), static_cast<std::uint64_t>(length),
                        reader.encoding() == Encoding::kText ? 1 : scalar_size(property.type), "corners");
            corners.resize(static_cast<std::size_t>(length));
            for (std::uint32_t& corner : corners) corner = reader.index(property.type, point_count);
            faces.add(corners, begin);
        }
    }
}

}  // namespace

TriangleSoup parse_ply(const SourceFile& given) {
    SourceFile file = given;
    const Header header = parse_header(file);
    const Element& vertices =
        require_element(file, header, "vertex", {{Role::kX, "'x'"}, {Role::kY, "'y'"}, {Role::kZ, "'z'"}});
    const Element& polygons =
        require_element(file, header, "face", {{Role::kCorners, "list 'vertex_indices' or 'vertex_index'"}});
    file.text = header.encoding == Encoding::kText;
    if (file.text) require_text(file);

    std::vector<Vec3> points;
    FaceCollector faces(file);
    Cursor cursor(file, header.body, Layout::kFree);
    ScalarReader reader(file, cursor, header.encoding);
    int open_elements = 2;
    for (const Element& element : header.elements) {
        if (open_elements == 0) break;
        std::uint64_t least = 0;
        for (const Property& p : element.properties) least += reader.least_size(p.count_type.value_or(p.type));
        // The last number of a text file needs no separator, hence one byte less there.
        if (file.text && least > 0) --least;
        check_count(file, cursor.position(), element.count, least, "items of element " + in_quotes(element.name));
        if (&element == &vertices) {
            points = parse_points(file, reader, element);
            --open_elements;
        } else if (&element == &polygons) {
            parse_faces(file, reader, cursor, element, vertices.count, faces);
            --open_elements;
        } else if (!element.properties.empty()) {
            for (std::uint64_t i = 0; i < element.count; ++i) {
                for (const Property& p : element.properties) skip_property(file, reader, p);
            }
        }
    }
    return make_soup(file, std::move(points), faces, cursor.digits());
}

}  // namespace lumenline::mesh
