#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "engine/core/errors.h"

namespace lumenline::mesh {

/// Most points or triangles of one surface.
inline constexpr std::uint64_t kMaxCount = std::numeric_limits<std::int32_t>::max();

/// A whole file in memory, owned by the caller.
struct SourceFile {
    std::string path;  ///< as given, for messages
    std::string_view bytes;
    bool text = true;                              ///< messages tell positions as line numbers; else as byte offsets
    std::string_view end = "the end of the file";  ///< what follows the last byte, for messages
    /// Where `bytes` were decoded from, for messages; null if they are those of the file.
    const SourceFile* origin = nullptr;
    std::size_t origin_position = 0;
};

/// Throws StageError(kLoad, code): "PATH, line N: what" or "PATH, byte N: what".
[[noreturn]] void fail_at(const SourceFile& file, std::size_t position, ErrorCode code, const std::string& what);

/// Throws StageError(kLoad, code): "PATH: what".
[[noreturn]] void fail_file(const SourceFile& file, ErrorCode code, const std::string& what);

/// A piece of the file for a message: in quotes, shortened, unprintable bytes as '?'.
std::string in_quotes(std::string_view piece);

/// Refuses, before anything is allocated, a count that the rest of the file cannot hold (kFileFormat) or that
/// 32-bit indices cannot address (kTooLarge).
/// @param position    where the counted items begin
/// @param bytes_each  least size of one item in the file
/// @param noun        plural, as in "points"
void check_count(const SourceFile& file, std::size_t position, std::uint64_t count, std::uint64_t bytes_each,
                 std::string_view noun);

/// Refuses a text file with a NUL byte in it (kFileFormat).
void require_text(const SourceFile& file);

/// Equal but for the case of ASCII letters; `lower` is given in lower case.
bool is_word(std::string_view token, std::string_view lower);

/// What ends a search for the next token.
enum class Layout {
    kFree,   ///< only the end of the file: line ends are blanks
    kLines,  ///< the end of the line; a backslash before it continues the line
};

/// Reading position in a file. Tokens are separated by blanks; from `comment` on the rest of a line is blank.
/// All failures are StageErrors that name the position.
class Cursor {
public:
    Cursor(const SourceFile& file, std::size_t position, Layout layout, char comment = '\0')
        : file_(file), position_(position), layout_(layout), comment_(comment) {}

    [[nodiscard]] std::size_t position() const { return position_; }
    void move_to(std::size_t position) { position_ = position; }
    [[nodiscard]] std::size_t remaining() const { return file_.bytes.size() - position_; }
    [[nodiscard]] bool at_end() const { return position_ >= file_.bytes.size(); }

    /// Next token; empty at the end of the line (kLines) or of the file.
    std::string_view token();
    /// As token(), but stays in front of it.
    std::string_view peek();
    /// Rest of the line without its end; moves behind the end.
    std::string_view line();
    /// Takes the word `lower` (in lower case), or fails.
    void expect(std::string_view lower);
    /// Next token as a finite number.
    double coordinate();
    /// Next token as any number; NaN also where it is beyond double precision.
    double number();
    /// Next token as a decimal integer; `noun` says what it is, as in "a point index".
    std::int64_t integer(std::string_view noun);
    /// Next token as a count: an integer that is not negative.
    std::uint64_t count(std::string_view noun);
    /// Integer at the very position, behind which the token may go on; none if there is no integer.
    std::optional<std::int64_t> integer_prefix();
    /// Whether the character at the position ends a token.
    [[nodiscard]] bool at_token_end() const { return at_end() || ends_token(file_.bytes[position_]); }

    /// Largest number of significant digits in any coordinate so far, at most 17.
    [[nodiscard]] int digits() const { return digits_; }

    /// Fails with "expected WHAT, found TOKEN" at `position`.
    [[noreturn]] void fail_expected(std::size_t position, std::string_view what) const;

private:
    /// A decimal number as it stands at the position, which stays; NaN beyond double precision.
    struct Decimal {
        std::string_view text;
        double value = 0;
    };
    Decimal decimal(std::string_view noun);
    void skip();
    [[nodiscard]] bool ends_token(char c) const;
    [[nodiscard]] std::size_t token_end(std::size_t position) const;

    const SourceFile& file_;
    std::size_t position_;
    Layout layout_;
    char comment_;
    int digits_ = 0;
};

}  // namespace lumenline::mesh
