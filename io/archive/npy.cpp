// The format is a magic, a version, the length of a header, the header (a Python dictionary, padded with spaces so that
// the data start at a multiple of 64) and the data. numpy's own text is UTF-32 of a fixed width.

#include "io/archive/npy.h"

#include <algorithm>
#include <ostream>
#include <string_view>

#include "io/archive/utf8.h"

namespace lumenline::hdf {

namespace {

constexpr std::size_t kAlignment = 64;
constexpr std::size_t kBlock = 65536;  ///< values that are read at a time
constexpr std::string_view kMagic("\x93NUMPY\x01\x00", 8);

/// numpy's name of a type: "<f8", "|u1".
std::string type_name(const std::string& type) {
    const std::size_t digits = type.find_first_of("0123456789");
    const std::size_t bytes = std::stoul(type.substr(digits)) / 8;
    const char kind = type.starts_with("float") ? 'f' : type.starts_with("uint") ? 'u' : 'i';
    return std::string(bytes == 1 ? "|" : "<") + kind + std::to_string(bytes);
}

std::string header(const std::string& type, const std::vector<std::uint64_t>& shape) {
    std::string lengths;
    for (const std::uint64_t length : shape) lengths += std::to_string(length) + ", ";
    if (shape.size() > 1) lengths.resize(lengths.size() - 2);
    std::string text = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + lengths + "), }";
    const std::size_t before = kMagic.size() + 2;  // two bytes say the header's length
    text.append(kAlignment - (before + text.size() + 1) % kAlignment, ' ').push_back('\n');
    const std::size_t size = text.size();
    std::string all(kMagic);
    all.push_back(static_cast<char>(size & 0xFFU));
    all.push_back(static_cast<char>(size >> 8U));
    return all + text;
}

/// Code points of valid UTF-8.
std::vector<char32_t> decoded(const std::string& text) {
    std::vector<char32_t> points;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if ((byte & 0xC0U) == 0x80U)
            points.back() = (points.back() << 6U) | (byte & 0x3FU);
        else
            points.push_back(byte < 0x80U   ? byte
                             : byte < 0xE0U ? byte & 0x1FU
                             : byte < 0xF0U ? byte & 0x0FU
                                            : byte & 7U);
    }
    return points;
}

void write_texts(const Values& values, std::ostream& out) {
    std::vector<std::vector<char32_t>> texts;
    std::size_t width = 1;
    for (const std::string& text : values.texts(0, values.rows())) {
        texts.push_back(decoded(valid_text(text)));
        width = std::max(width, texts.back().size());
    }
    out << header("<U" + std::to_string(width), values.shape());
    for (std::vector<char32_t>& text : texts) {
        text.resize(width, U'\0');
        for (const char32_t point : text)
            for (unsigned shift = 0; shift < 32; shift += 8) out.put(static_cast<char>((point >> shift) & 0xFFU));
    }
}

}  // namespace

void write_npy(const Values& values, std::ostream& out) {
    if (values.is_text()) return write_texts(values, out);
    if (values.type() == "other") throw Error("holds values of a type that numpy's format has no name for");
    out << header(type_name(values.type()), values.shape());
    const std::size_t step = std::max<std::size_t>(1, kBlock / std::max<std::size_t>(1, values.row_length()));
    for (std::size_t first = 0; first < values.rows(); first += step)
        out << values.bytes(first, std::min(step, values.rows() - first));
}

}  // namespace lumenline::hdf
