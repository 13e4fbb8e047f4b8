#include "engine/core/text.h"

#include <array>
#include <charconv>

namespace lumenline {

std::string exact_text(double value) {
    std::array<char, 32> buffer{};
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), result.ptr};
}

std::string short_text(double value, int digits) {
    std::array<char, 64> buffer{};
    const auto result =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, digits);
    return {buffer.data(), result.ptr};
}

std::string short_text(Vec3 point, int digits) {
    std::string text = "(";
    text.append(short_text(point.x, digits)).append(", ").append(short_text(point.y, digits));
    return text.append(", ").append(short_text(point.z, digits)).append(")");
}

std::string counted(std::size_t count, const std::string& noun) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace lumenline
