#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "io/mesh/cursor.h"

namespace lumenline::mesh {

/// Bytes stored in a stretch of a file, as they are or as base64 text, read from front to back.
///
/// Base64 text may be padded ('=') after any part of the bytes and broken by blanks anywhere.
class StoredBytes {
public:
    StoredBytes(const SourceFile& file, std::size_t begin, std::size_t end, bool is_base64)
        : file_(file), position_(begin), end_(end), is_base64_(is_base64) {}

    /// Where the next byte is stored.
    [[nodiscard]] std::size_t position() const { return position_; }
    /// The most bytes that can be left.
    [[nodiscard]] std::uint64_t remaining() const;
    /// Reads `size` bytes; `noun` says what they are, as in "a header".
    /// @throws StageError kFileFormat if there are fewer, or a character that is not of base64
    void read(char* out, std::size_t size, std::string_view noun);

private:
    void decode_group(std::string_view noun);

    const SourceFile& file_;
    std::size_t position_;
    std::size_t end_;
    bool is_base64_;
    std::array<char, 3> group_{};  // bytes of the last four characters
    std::size_t group_begin_ = 0;  // of those not read yet
    std::size_t group_end_ = 0;
};

}  // namespace lumenline::mesh
