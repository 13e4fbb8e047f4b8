#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace lumenline {

/// A picture of few colours.
struct Picture {
    std::size_t width = 0, height = 0;
    std::vector<std::uint8_t> pixels;                  ///< rows from above; places in the palette
    std::vector<std::array<std::uint8_t, 4>> palette;  ///< red, green, blue, opacity; at most 256
};

/// The picture as a PNG file with a palette. The same bytes for the same picture.
/// @throws std::runtime_error where memory runs out
std::string png_of(const Picture& picture);

}  // namespace lumenline
