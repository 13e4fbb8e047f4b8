#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/core/vec3.h"

namespace lumenline {

/// Finite tetrahedra of a Delaunay triangulation, as flat arrays.
struct Tetrahedra {
    static constexpr std::uint32_t kOuter = std::numeric_limits<std::uint32_t>::max();

    std::vector<std::array<std::uint32_t, 4>> sites;  ///< (C) corners
    std::vector<std::array<std::uint32_t, 4>>
        neighbours;  ///< (C) across the face opposite to each corner; kOuter = none
    /// Sites at the place of an earlier one, with that one: (duplicate, kept). They belong to no cell.
    std::vector<std::array<std::uint32_t, 2>> duplicates;

    [[nodiscard]] std::size_t count() const { return sites.size(); }
};

/// Delaunay triangulation Del(P) of the sites (CGAL, exact predicates, sequential).
///
/// @returns empty when the points are fewer than four or all coplanar
/// @cost O(n log n) in practice: 4-5 us per site on anatomy, more on exactly circular tubes
Tetrahedra delaunay_tetrahedra(std::span<const Vec3> points);

}  // namespace lumenline
