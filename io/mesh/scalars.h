#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "io/mesh/cursor.h"

namespace lumenline::mesh {

enum class Encoding { kText, kLittleEndian, kBigEndian };

/// Types of the numbers that PLY and VTK files declare.
enum class ScalarType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat32, kFloat64 };

/// Bytes of one number in a binary file.
constexpr std::size_t scalar_size(ScalarType type) {
    constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

constexpr bool is_floating(ScalarType type) { return type == ScalarType::kFloat32 || type == ScalarType::kFloat64; }

namespace detail {
inline std::uint8_t swap_bytes(std::uint8_t v) { return v; }
inline std::uint16_t swap_bytes(std::uint16_t v) { return __builtin_bswap16(v); }
inline std::uint32_t swap_bytes(std::uint32_t v) { return __builtin_bswap32(v); }
inline std::uint64_t swap_bytes(std::uint64_t v) { return __builtin_bswap64(v); }
template <std::size_t Size>
struct Bits;
template <>
struct Bits<1> {
    using Type = std::uint8_t;
};
template <>
struct Bits<2> {
    using Type = std::uint16_t;
};
template <>
struct Bits<4> {
    using Type = std::uint32_t;
};
template <>
struct Bits<8> {
    using Type = std::uint64_t;
};
}  // namespace detail

/// Number stored at `bytes`, which need not be aligned.
template <class T>
T load(const char* bytes, Encoding encoding) {
    typename detail::Bits<sizeof(T)>::Type bits;
    std::memcpy(&bits, bytes, sizeof bits);
    constexpr bool kNativeLittle = std::endian::native == std::endian::little;
    if ((encoding == Encoding::kLittleEndian) != kNativeLittle) bits = detail::swap_bytes(bits);
    return std::bit_cast<T>(bits);
}

/// Reads numbers one after the other at a cursor, from text or binary. Failures are StageErrors that name the
/// position.
class ScalarReader {
public:
    ScalarReader(const SourceFile& file, Cursor& cursor, Encoding encoding)
        : file_(file), cursor_(cursor), encoding_(encoding) {}

    [[nodiscard]] Encoding encoding() const { return encoding_; }

    /// Least bytes of one number in the file, with its separator.
    [[nodiscard]] std::size_t least_size(ScalarType type) const {
        return encoding_ == Encoding::kText ? 2 : scalar_size(type);
    }
    /// Finite number (kBadCoordinate otherwise).
    double coordinate(ScalarType type);
    /// Any number, also NaN or infinite.
    double number(ScalarType type);
    /// Whole number; `noun` says what it is, as in "a point index".
    std::int64_t integer(ScalarType type, std::string_view noun);
    /// Whole number in [0, limit).
    std::uint32_t index(ScalarType type, std::uint64_t limit);
    /// Passes over `count` numbers.
    void skip(ScalarType type, std::uint64_t count);
    /// Where the number read last begins.
    [[nodiscard]] std::size_t last_position() const { return last_; }

private:
    const char* take(std::size_t size, std::string_view noun);

    const SourceFile& file_;
    Cursor& cursor_;
    Encoding encoding_;
    std::size_t last_ = 0;
};

}  // namespace lumenline::mesh
