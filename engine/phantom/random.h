#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace lumenline {

/// Uniform and normal numbers made of raw mt19937_64 words, because the distributions of the
/// standard library differ between implementations.
class RandomStream {
public:
    explicit RandomStream(std::uint64_t seed) : engine_(seed) {}

    /// In [0, 1), all 53 bits.
    double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    /// In [-1, 1).
    double symmetric() { return 2 * unit() - 1; }
    /// Mean 0, variance 1 (Box and Muller).
    double normal() {
        const double radius = std::sqrt(-2 * std::log(1 - unit()));
        return radius * std::cos(2 * std::numbers::pi * unit());
    }

private:
    std::mt19937_64 engine_;
};

}  // namespace lumenline
