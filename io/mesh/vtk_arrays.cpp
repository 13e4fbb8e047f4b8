// Arrays of legacy VTK files. Attributes are point and cell data: sections SCALARS, VECTORS, FIELD and so on, each
// with a form of its own. They are read for the labels of the cells; nothing of them is needed for the surface, so
// that a fault among them costs the labels behind it and not the model.
//
// In binary files an array begins right behind the line of its header and has no mark at its end: to find the next
// section, every array before it must be understood.

#include "io/mesh/vtk_arrays.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace lumenline::mesh {
namespace {

constexpr std::array<std::pair<std::string_view, ScalarType>, 21> kTypes{{
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
    {"vtktypeint16", ScalarType::kInt16},
    {"vtktypeint8", ScalarType::kInt8},
    {"vtktypeuint64", ScalarType::kUint64},
    {"vtktypeuint32", ScalarType::kUint32},
    {"vtktypeuint16", ScalarType::kUint16},
    {"vtktypeuint8", ScalarType::kUint8},
    {"float", ScalarType::kFloat32},
    {"double", ScalarType::kFloat64},
}};

// "a%20b" is the name "a b".
std::string decoded(std::string_view word) {
    std::string name;
    for (std::size_t i = 0; i < word.size(); ++i) {
        unsigned char code = 0;
        const char* hex = word.data() + i + 1;
        if (word[i] == '%' && i + 2 < word.size() && std::from_chars(hex, hex + 2, code, 16).ptr == hex + 2) {
            name += static_cast<char>(code);
            i += 2;
        } else {
            name += word[i];
        }
    }
    return name;
}

bool is_section(std::string_view word) { return is_word(word, "point_data") || is_word(word, "cell_data"); }

}  // namespace

ScalarType LegacyArrays::parse_type() {
    const std::string_view word = cursor_.token();
    for (const auto& [name, type] : kTypes) {
        if (is_word(word, name)) return type;
    }
    cursor_.fail_expected(cursor_.position() - word.size(), "a VTK number type such as float, double or vtktypeint64");
}

void LegacyArrays::begin_array() {
    if (file_.text) return;
    const std::size_t end = file_.bytes.find('\n', cursor_.position());
    if (end == std::string_view::npos) {
        fail_at(file_, cursor_.position(), ErrorCode::kFileFormat,
                "expected an array behind its header line, found the end of the file");
    }
    cursor_.move_to(end + 1);
}

// A block METADATA ends with an empty line.
void LegacyArrays::skip_metadata() {
    cursor_.line();
    while (!cursor_.at_end()) {
        if (cursor_.line().find_first_not_of(" \t\r") == std::string_view::npos) return;
    }
}

std::string LegacyArrays::parse_name() {
    const std::string_view name = cursor_.token();
    if (name.empty()) cursor_.fail_expected(cursor_.position(), "the name of an array");
    return decoded(name);
}

std::uint64_t LegacyArrays::parse_components() {
    const std::uint64_t components = cursor_.count("the number of components of an array");
    check_count(file_, cursor_.position(), components, 0, "components");
    return components;
}

// FIELD name n, then n arrays "name components tuples type".
void LegacyArrays::parse_field(VtkCells* cells) {
    parse_name();
    const std::uint64_t arrays = cursor_.count("the number of arrays of a field");
    check_count(file_, cursor_.position(), arrays, 8, "arrays");
    for (std::uint64_t a = 0; a < arrays; ++a) {
        while (is_word(cursor_.peek(), "metadata")) skip_metadata();
        const std::string name = parse_name();
        const std::uint64_t components = parse_components();
        const std::uint64_t tuples = cursor_.count("the number of tuples of a field array");
        check_count(file_, cursor_.position(), tuples, 0, "tuples");
        parse_values(name, parse_array_type(), components, tuples, cells);
    }
}

LegacyArrays::ArrayType LegacyArrays::parse_array_type() {
    const std::string_view word = cursor_.peek();
    const bool is_bit = is_word(word, "bit");
    if (!is_bit && !is_word(word, "string")) return {ArrayType::Kind::kNumbers, parse_type()};
    cursor_.token();
    return {is_bit ? ArrayType::Kind::kBits : ArrayType::Kind::kStrings, ScalarType::kUint8};
}

// At the end of the array's header.
void LegacyArrays::parse_values(const std::string& name, ArrayType type, std::uint64_t components, std::uint64_t tuples,
                                VtkCells* cells) {
    const std::uint64_t numbers = components * tuples;  // both below 2^31
    begin_array();
    if (type.kind == ArrayType::Kind::kStrings) return skip_strings(numbers);
    if (type.kind == ArrayType::Kind::kBits) {
        return reader_.skip(type.scalar, file_.text ? numbers : (numbers + 7) / 8);
    }
    if (cells == nullptr || components != 1 || tuples != cells->cells() || !cells->takes_arrays()) {
        return reader_.skip(type.scalar, numbers);
    }
    check_count(file_, cursor_.position(), tuples, file_.text ? 1 : scalar_size(type.scalar), "numbers");
    std::vector<double> values(tuples);
    for (double& value : values) value = reader_.number(type.scalar);
    cells->add_array(name, values);
}

void LegacyArrays::parse_attributes(std::string_view section, VtkCells& cells) {
    try {
        for (; !section.empty(); section = cursor_.token()) parse_section(section, cells);
    } catch (const StageError& error) {
        cells.report_unread(std::string(error.what()) + "; the point and cell data from there on are not read");
    }
}

// "POINT_DATA n" or "CELL_DATA n", and the attributes up to the next section.
void LegacyArrays::parse_section(std::string_view section, VtkCells& cells) {
    if (!is_section(section)) {
        cursor_.fail_expected(cursor_.position() - section.size(), "a section POINT_DATA or CELL_DATA");
    }
    const bool of_cells = is_word(section, "cell_data");
    const std::size_t begin = cursor_.position();
    const std::uint64_t tuples = cursor_.count("the number of values of each array");
    check_count(file_, begin, tuples, 0, "values");
    if (of_cells && tuples != cells.cells()) {
        fail_at(file_, begin, ErrorCode::kFileFormat,
                "expected arrays of as many values as there are cells, " + std::to_string(cells.cells()) + ", found " +
                    std::to_string(tuples));
    }
    while (!cursor_.peek().empty() && !is_section(cursor_.peek())) {
        parse_attribute(cursor_.token(), tuples, of_cells ? &cells : nullptr);
    }
}

void LegacyArrays::parse_attribute(std::string_view kind, std::uint64_t tuples, VtkCells* cells) {
    const std::size_t begin = cursor_.position() - kind.size();
    if (is_word(kind, "metadata")) return skip_metadata();
    if (is_word(kind, "field")) return parse_field(cells);
    constexpr std::array<std::pair<std::string_view, std::uint64_t>, 7> kFixed{{{"vectors", 3},
                                                                                {"normals", 3},
                                                                                {"tensors", 9},
                                                                                {"tensors6", 6},
                                                                                {"global_ids", 1},
                                                                                {"pedigree_ids", 1},
                                                                                {"edge_flags", 1}}};
    for (const auto& [word, components] : kFixed) {
        if (!is_word(kind, word)) continue;
        const std::string name = parse_name();
        return parse_values(name, parse_array_type(), components, tuples, cells);
    }
    if (is_word(kind, "scalars")) {
        parse_scalars(tuples, cells);
    } else if (is_word(kind, "texture_coordinates")) {
        const std::string name = parse_name();
        const std::uint64_t components = parse_components();
        parse_values(name, parse_array_type(), components, tuples, cells);
    } else if (is_word(kind, "color_scalars")) {
        parse_name();
        skip_colours(parse_components() * tuples);
    } else if (is_word(kind, "lookup_table")) {
        parse_name();
        skip_colours(4 * parse_components());
    } else {
        cursor_.fail_expected(begin, "an attribute such as SCALARS, VECTORS, NORMALS or FIELD");
    }
}

// "SCALARS name type [components]", then a line "LOOKUP_TABLE name".
void LegacyArrays::parse_scalars(std::uint64_t tuples, VtkCells* cells) {
    const std::string name = parse_name();
    const ArrayType type = parse_array_type();
    const std::uint64_t components = is_word(cursor_.peek(), "lookup_table") ? 1 : parse_components();
    cursor_.expect("lookup_table");
    parse_name();
    parse_values(name, type, components, tuples, cells);
}

// Colours are fractions in text, and bytes in binary.
void LegacyArrays::skip_colours(std::uint64_t numbers) {
    begin_array();
    reader_.skip(ScalarType::kUint8, numbers);
}

// Text: one encoded line each. Binary: the two highest bits of the first byte tell how many bytes hold the length.
void LegacyArrays::skip_strings(std::uint64_t count) {
    if (file_.text) cursor_.line();
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::size_t begin = cursor_.position();
        if (cursor_.at_end()) {
            fail_at(file_, begin, ErrorCode::kFileFormat, "expected a string of an array, found the end of the file");
        }
        if (file_.text) {
            cursor_.line();
            continue;
        }
        const auto first = static_cast<unsigned char>(file_.bytes[begin]);
        const std::size_t width = std::size_t{8} >> (first >> 6U);
        check_count(file_, begin, width, 1, "bytes of a string's length");
        std::uint64_t length = first & 0x3FU;
        for (std::size_t b = 1; b < width; ++b) {
            length = length << 8U | static_cast<unsigned char>(file_.bytes[begin + b]);
        }
        cursor_.move_to(begin + width);
        reader_.skip(ScalarType::kUint8, length);
    }
}

}  // namespace lumenline::mesh
