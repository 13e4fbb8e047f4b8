#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/condition/wall_mesh.h"

namespace lumenline {

inline constexpr std::uint32_t kNoHalfEdge = 0xffffffffU;

/// Which half-edges of a triangle list meet. Half-edge 3 t + k runs from corner k of triangle t to
/// the next corner.
struct HalfEdgePairs {
    std::vector<std::uint32_t> opposite;          ///< (3 M) kNoHalfEdge at a boundary or at a non-manifold edge
    std::size_t boundary_edges = 0;               ///< edges of one triangle
    std::size_t conflicting_edges = 0;            ///< edges of two triangles that run the same way; they are paired
    std::size_t non_manifold_edges = 0;           ///< edges of more than two triangles
    std::uint32_t first_irregular = kNoHalfEdge;  ///< a half-edge of a conflicting or non-manifold edge
};

inline std::uint32_t next_half_edge(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
inline std::uint32_t previous_half_edge(std::uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }
inline std::uint32_t start_of(const std::vector<Corners>& triangles, std::uint32_t h) {
    return triangles[h / 3][h % 3];
}

/// Finds the partner of each half-edge. @cost linear unless single vertices have huge valences
HalfEdgePairs pair_half_edges(const std::vector<Corners>& triangles, std::size_t vertex_count);

/// A vertex whose triangles form more than one fan, kDropped if there is none.
/// Needs pairs without conflicting or non-manifold edges.
std::uint32_t find_split_vertex(const std::vector<Corners>& triangles, const HalfEdgePairs& pairs,
                                std::size_t vertex_count);

}  // namespace lumenline
