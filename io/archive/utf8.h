#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace lumenline {

/// `text` as it may be stored: bytes that are no UTF-8 and NUL become U+FFFD. Other text is
/// returned as it is.
std::string valid_text(std::string_view text);

/// `text` as it may be shown on a terminal or in a line of a table: control characters (C0, DEL,
/// C1), the marks that turn the writing direction and bytes that are no UTF-8 become '?'.
std::string printable(std::string_view text);

/// Number of code points of valid UTF-8: the width of most texts on a terminal.
std::size_t code_points(std::string_view text);

/// At most `limit` bytes of `text`, cut between two characters.
std::string_view cut_text(std::string_view text, std::size_t limit);

}  // namespace lumenline
