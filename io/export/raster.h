#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/core/vec3.h"

namespace lumenline {

/// A corner of a triangle on the canvas: x to the right, y down, both in cells, z towards the eye.
struct Corner {
    Vec3 place;
    double hue = 0;    ///< 0 to 1 along the colour map; NaN = none
    double light = 0;  ///< 0 to 1
};

/// A square of cells with a depth buffer. Each cell keeps what is nearest to the eye.
class Canvas {
public:
    struct Cell {
        float depth = -1e30F;  ///< of the nearest triangle
        float hue = 0;         ///< NaN = none
        float light = 0;
        bool covered = false;
        bool line = false;
    };

    explicit Canvas(std::size_t size) : size_(size), cells_(size * size) {}

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] const Cell& at(std::size_t x, std::size_t y) const { return cells_[y * size_ + x]; }

    /// Draws a triangle; what lies outside, or has coordinates that are not finite, is left out. @cost its area
    void draw(const std::array<Corner, 3>& triangle);
    /// Draws a round stroke from a to b over everything.
    void stroke(Vec3 a, Vec3 b, double radius);

private:
    std::size_t size_;
    std::vector<Cell> cells_;
};

}  // namespace lumenline
