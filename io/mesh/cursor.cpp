// Shared text parsing. Numbers go through std::from_chars: fast, and deaf to the locale. A number counts only
// if it fills its token, so that "1.5e" at a cut end, "1,5" and "0x10" are refused instead of half read.
// Line numbers are counted when a message needs one, never while parsing.

#include "io/mesh/cursor.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

namespace lumenline::mesh {
namespace {

constexpr int kMaxDigits = 17;  // a double holds no more

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }
char lower_case(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

int significant_digits(const char* begin, const char* end) {
    int digits = 0;
    for (const char* c = begin; c != end && lower_case(*c) != 'e'; ++c) {
        if (*c >= '0' && *c <= '9' && (digits > 0 || *c != '0')) ++digits;
    }
    return digits;
}

// from_chars takes no plus sign.
const char* skip_plus(const char* begin, const char* end) {
    return end - begin > 1 && *begin == '+' && begin[1] != '-' ? begin + 1 : begin;
}

std::size_t line_number(std::string_view bytes, std::size_t position) {
    const char end = bytes.find('\n') == std::string_view::npos ? '\r' : '\n';
    const std::string_view before = bytes.substr(0, position);
    return 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), end));
}

std::string place(const SourceFile& file, std::size_t position) {
    if (file.origin != nullptr) {
        return place(*file.origin, file.origin_position) + ", decoded byte " + std::to_string(position);
    }
    return file.text ? "line " + std::to_string(line_number(file.bytes, position)) : "byte " + std::to_string(position);
}

}  // namespace

void fail_at(const SourceFile& file, std::size_t position, ErrorCode code, const std::string& what) {
    throw StageError(Stage::kLoad, code, file.path + ", " + place(file, position) + ": " + what);
}

void fail_file(const SourceFile& file, ErrorCode code, const std::string& what) {
    throw StageError(Stage::kLoad, code, file.path + ": " + what);
}

std::string in_quotes(std::string_view piece) {
    constexpr std::size_t kLongest = 32;
    std::string text = "'";
    for (const char c : piece.substr(0, kLongest)) text += c >= ' ' && c <= '~' ? c : '?';
    return text + (piece.size() > kLongest ? "...'" : "'");
}

void check_count(const SourceFile& file, std::size_t position, std::uint64_t count, std::uint64_t bytes_each,
                 std::string_view noun) {
    const std::uint64_t rest = file.bytes.size() - position;
    if (bytes_each > 0 && count > rest / bytes_each) {
        fail_at(file, position, ErrorCode::kFileFormat,
                "expected " + std::to_string(count) + " " + std::string(noun) + " of at least " +
                    std::to_string(bytes_each) + " bytes each, found only " + std::to_string(rest) + " bytes up to " +
                    std::string(file.end));
    }
    if (count > kMaxCount) {
        fail_at(file, position, ErrorCode::kTooLarge,
                std::to_string(count) + " " + std::string(noun) + " are more than the limit of " +
                    std::to_string(kMaxCount));
    }
}

void require_text(const SourceFile& file) {
    const std::size_t nul = file.bytes.find('\0');
    if (nul == std::string_view::npos) return;
    fail_at(file, nul, ErrorCode::kFileFormat,
            "expected text, found a NUL byte (byte " + std::to_string(nul) + " of the file)");
}

bool is_word(std::string_view token, std::string_view lower) {
    return std::equal(token.begin(), token.end(), lower.begin(), lower.end(),
                      [](char a, char b) { return lower_case(a) == b; });
}

bool Cursor::ends_token(char c) const {
    return is_space(c) || (comment_ != '\0' && c == comment_) || (layout_ == Layout::kLines && c == '\\');
}

std::size_t Cursor::token_end(std::size_t position) const {
    const std::string_view bytes = file_.bytes;
    if (position >= bytes.size()) return position;
    if (layout_ == Layout::kLines && is_line_end(bytes[position])) return position;
    std::size_t end = position + 1;
    while (end < bytes.size() && !ends_token(bytes[end])) ++end;
    return end;
}

void Cursor::skip() {
    const std::string_view bytes = file_.bytes;
    while (position_ < bytes.size()) {
        const char c = bytes[position_];
        if (layout_ == Layout::kLines && is_line_end(c)) return;
        if (is_space(c)) {
            ++position_;
        } else if (comment_ != '\0' && c == comment_) {
            while (position_ < bytes.size() && !is_line_end(bytes[position_])) ++position_;
        } else if (layout_ == Layout::kLines && c == '\\' && position_ + 1 < bytes.size() &&
                   is_line_end(bytes[position_ + 1])) {
            position_ += bytes.substr(position_ + 1, 2) == "\r\n" ? 3 : 2;
        } else {
            return;
        }
    }
}

std::string_view Cursor::peek() {
    skip();
    return file_.bytes.substr(position_, token_end(position_) - position_);
}

std::string_view Cursor::token() {
    const std::string_view found = peek();
    position_ += found.size();
    return found;
}

std::string_view Cursor::line() {
    const std::size_t begin = position_;
    const std::size_t end = std::min(file_.bytes.find_first_of("\r\n", begin), file_.bytes.size());
    position_ = end;
    if (file_.bytes.substr(end, 2) == "\r\n") ++position_;
    if (!at_end()) ++position_;
    return file_.bytes.substr(begin, end - begin);
}

void Cursor::expect(std::string_view lower) {
    const std::string_view found = peek();
    if (!is_word(found, lower)) fail_expected(position_, in_quotes(lower));
    position_ += found.size();
}

Cursor::Decimal Cursor::decimal(std::string_view noun) {
    skip();
    const char* begin = file_.bytes.data() + position_;
    const char* end = file_.bytes.data() + file_.bytes.size();
    double value = 0;
    const auto [stop, error] = std::from_chars(skip_plus(begin, end), end, value);
    if (error == std::errc::invalid_argument || (stop != end && !ends_token(*stop))) fail_expected(position_, noun);
    return {{begin, static_cast<std::size_t>(stop - begin)},
            error == std::errc{} ? value : std::numeric_limits<double>::quiet_NaN()};
}

double Cursor::coordinate() {
    const auto [text, value] = decimal("a coordinate");
    if (!std::isfinite(value)) {
        fail_at(file_, position_, ErrorCode::kBadCoordinate, "expected a finite coordinate, found " + in_quotes(text));
    }
    if (digits_<kMaxDigits&& static_cast<int>(text.size())> digits_) {
        digits_ = std::max(digits_, std::min(significant_digits(text.data(), text.data() + text.size()), kMaxDigits));
    }
    position_ += text.size();
    return value;
}

double Cursor::number() {
    const auto [text, value] = decimal("a number");
    position_ += text.size();
    return value;
}

std::optional<std::int64_t> Cursor::integer_prefix() {
    const char* begin = file_.bytes.data() + position_;
    const char* end = file_.bytes.data() + file_.bytes.size();
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(skip_plus(begin, end), end, value);
    if (error != std::errc{}) return std::nullopt;
    position_ += static_cast<std::size_t>(stop - begin);
    return value;
}

std::int64_t Cursor::integer(std::string_view noun) {
    skip();
    const std::size_t begin = position_;
    const std::optional<std::int64_t> value = integer_prefix();
    if (!value || !at_token_end()) fail_expected(begin, noun);
    return *value;
}

std::uint64_t Cursor::count(std::string_view noun) {
    skip();
    const std::size_t begin = position_;
    const std::int64_t value = integer(noun);
    if (value < 0) fail_expected(begin, noun);
    return static_cast<std::uint64_t>(value);
}

void Cursor::fail_expected(std::size_t position, std::string_view what) const {
    const std::string_view found = file_.bytes.substr(position, token_end(position) - position);
    std::string name = in_quotes(found);
    if (found.empty()) name = position >= file_.bytes.size() ? std::string(file_.end) : "the end of the line";
    fail_at(file_, position, ErrorCode::kFileFormat, "expected " + std::string(what) + ", found " + name);
}

}  // namespace lumenline::mesh
