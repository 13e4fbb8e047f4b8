#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/mesh/cursor.h"
#include "io/mesh/scalars.h"

namespace lumenline::mesh {

/// How a VTK XML file stores the numbers of its arrays that are not text.
struct XmlStorage {
    Encoding encoding = Encoding::kLittleEndian;
    std::size_t header_size = 4;  ///< bytes of each number of a header, 4 or 8
    bool compressed = false;      ///< blocks of zlib streams
};

/// Where a VTK XML file holds one array.
struct XmlArray {
    enum class Format { kText, kBase64, kRaw };

    ScalarType type = ScalarType::kFloat32;
    Format format = Format::kText;
    std::size_t begin = 0;  ///< in the file; of the header, where there is one
    std::size_t end = 0;    ///< what is stored there ends no later
};

/// The numbers of one array, read one after the other.
class XmlNumbers {
public:
    /// Decodes the array; text is parsed number by number later.
    /// @param count  numbers that the array must hold
    /// @throws StageError kFileFormat unless header, size and compressed blocks agree with `count`. Nothing is
    ///         allocated that the bytes of the file, unpacked, cannot hold.
    XmlNumbers(const SourceFile& file, const XmlStorage& storage, const XmlArray& array, std::uint64_t count);
    XmlNumbers(const XmlNumbers&) = delete;
    XmlNumbers& operator=(const XmlNumbers&) = delete;

    /// Next number, as those of ScalarReader.
    double coordinate() { return reader_.coordinate(type_); }
    double number() { return reader_.number(type_); }
    std::int64_t integer(std::string_view noun) { return reader_.integer(type_, noun); }
    std::uint32_t index(std::uint64_t limit) { return reader_.index(type_, limit); }
    /// Refuses text behind the last number.
    void expect_end();

    /// Position in the file of the number read last, or of its array where that is encoded.
    [[nodiscard]] std::size_t position() const;
    /// Fails with "PATH, place of the number read last: what".
    [[noreturn]] void fail(const std::string& what) const;
    /// As Cursor::digits(); 0 unless the array is text.
    [[nodiscard]] int digits() const { return cursor_.digits(); }

private:
    SourceFile open(const XmlStorage& storage, const XmlArray& array, std::uint64_t count);

    SourceFile file_;            // the whole file
    std::vector<char> decoded_;  // the array's bytes, unless they stand in the file as they are
    std::size_t begin_ = 0;
    ScalarType type_;
    SourceFile source_;  // from which numbers are read
    Cursor cursor_;
    ScalarReader reader_;
};

}  // namespace lumenline::mesh
