#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace lumenline {

/// SHA-256 (FIPS 180-4) of `bytes` as 64 lower-case hexadecimal digits.
/// @throws std::runtime_error if the cryptographic library refuses
std::string sha256_hex(std::span<const std::byte> bytes);

/// SHA-256 of a file's bytes, read in blocks; empty if it is no regular file or cannot be read to its end.
std::string sha256_of_file(const std::string& path);

/// SHA-256 of the characters of `text`, without any terminator.
std::string sha256_hex(std::string_view text);

}  // namespace lumenline
