// Base64 as VTK writes it (RFC 4648). The header of a compressed array is encoded apart from its blocks, with
// padding of its own, that of a plain array together with its numbers by VTK and apart by others: taking padding
// for the end of a part, and not of the whole, reads them all.

#include "io/mesh/base64.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "engine/core/text.h"

namespace lumenline::mesh {
namespace {

constexpr signed char kBlank = -1, kPadding = -2, kForeign = -3;

constexpr std::array<signed char, 256> kValues = [] {
    std::array<signed char, 256> values{};
    values.fill(kForeign);
    constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < kAlphabet.size(); ++i) {
        values[static_cast<unsigned char>(kAlphabet[i])] = static_cast<signed char>(i);
    }
    for (const unsigned char blank : {' ', '\t', '\n', '\r'}) values[blank] = kBlank;
    values['='] = kPadding;
    return values;
}();

}  // namespace

std::uint64_t StoredBytes::remaining() const {
    const std::uint64_t characters = end_ - position_;
    return is_base64_ ? group_end_ - group_begin_ + characters / 4 * 3 : characters;
}

void StoredBytes::read(char* out, std::size_t size, std::string_view noun) {
    if (size > remaining()) {
        fail_at(file_, position_, ErrorCode::kFileFormat,
                "expected " + std::string(noun) + " of " + counted(size, "byte") + ", found at most " +
                    std::to_string(remaining()) + " before the end of the array");
    }
    if (size == 0) return;  // where `out` may be null, which memcpy must not see
    if (!is_base64_) {
        std::memcpy(out, file_.bytes.data() + position_, size);
        position_ += size;
        return;
    }
    while (size > 0) {
        if (group_begin_ == group_end_) decode_group(noun);
        const std::size_t part = std::min(size, group_end_ - group_begin_);
        out = std::copy_n(group_.data() + group_begin_, part, out);
        group_begin_ += part;
        size -= part;
    }
}

void StoredBytes::decode_group(std::string_view noun) {
    std::uint32_t bits = 0;
    std::size_t characters = 0;
    std::size_t padding = 0;
    while (characters < 4) {
        if (position_ >= end_) {
            fail_at(file_, position_, ErrorCode::kFileFormat,
                    "expected " + std::string(noun) + " in base64, found the end of the array");
        }
        const signed char value = kValues[static_cast<unsigned char>(file_.bytes[position_])];
        const bool misplaced = value == kPadding ? characters < 2 : value >= 0 && padding > 0;
        if (value == kForeign || misplaced) {
            fail_at(
                file_, position_, ErrorCode::kFileFormat,
                "expected " + std::string(noun) + " in base64, found " + in_quotes(file_.bytes.substr(position_, 1)));
        }
        ++position_;
        if (value == kBlank) continue;
        padding += value == kPadding ? 1 : 0;
        bits = bits << 6U | static_cast<std::uint32_t>(std::max<int>(value, 0));
        ++characters;
    }
    for (std::size_t i = 0; i < 3; ++i) group_[i] = static_cast<char>(bits >> (16 - 8 * i) & 0xFFU);
    group_begin_ = 0;
    group_end_ = 3 - padding;
}

}  // namespace lumenline::mesh
