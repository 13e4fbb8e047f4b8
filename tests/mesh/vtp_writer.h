#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/vec3.h"

namespace lumenline::samples {

/// One piece of polydata as a VTK XML file holds it.
struct VtpPiece {
    std::vector<Vec3> points;
    std::vector<std::vector<int>> verts, lines, polys, strips;  ///< corners of each cell
    /// Cell arrays: name, type, values (a multiple of the cells, in the order verts, lines, polys, strips).
    struct Array {
        std::string name, type;
        std::vector<double> values;
    };
    std::vector<Array> cell_arrays;

    [[nodiscard]] std::size_t cells() const { return verts.size() + lines.size() + polys.size() + strips.size(); }
};

/// How it is stored.
struct VtpStyle {
    enum class Format { kAscii, kBinary, kAppendedBase64, kAppendedRaw } format = Format::kAscii;
    std::size_t block = 0;        ///< bytes of each compressed block; 0 = not compressed
    std::size_t header_size = 4;  ///< 4 = UInt32, 8 = UInt64
    std::endian order = std::endian::little;
    std::string point_type = "Float32", index_type = "Int64";
};

/// A VTK XML file of these pieces, written with nothing of the reader under test.
std::string vtp_file(const std::vector<VtpPiece>& pieces, const VtpStyle& style);

/// The number as `type` in binary, as in "Float32".
std::string number_bytes(double value, const std::string& type, std::endian order);

std::string base64(const std::string& bytes);

/// What stands for an array in a file: header and bytes, before any base64 unless `in_base64`.
std::string stored_array(const std::string& bytes, const VtpStyle& style, bool in_base64);

}  // namespace lumenline::samples
