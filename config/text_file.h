#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "config/values.h"

namespace lumenline {

/// A text file as it is and in the form that parsers want.
struct TextFile {
    std::string raw;   ///< byte for byte
    std::string text;  ///< UTF-8 without byte order mark; every line ends in a line feed alone
};

/// Reads a UTF-8 text file; Windows line ends and a byte order mark are accepted.
/// @param asked_by  where the file is named: the place of the error when it cannot be read
/// @throws ConfigError unreadable, a folder, UTF-16, invalid UTF-8, or a control character
TextFile read_text_file(const std::filesystem::path& file, const Place& asked_by);

/// Number of leading bytes of `text` that are valid UTF-8; all of them when the text is.
std::size_t valid_utf8_prefix(std::string_view text);

}  // namespace lumenline
