#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace lumenline {

/// Index into one particular array; indices of different arrays do not mix.
/// A default-constructed index refers to nothing (`kNone`).
template <class Tag>
struct Index {
    static constexpr std::uint32_t kNoneValue = std::numeric_limits<std::uint32_t>::max();

    std::uint32_t value = kNoneValue;

    constexpr Index() = default;
    constexpr explicit Index(std::size_t v) : value(static_cast<std::uint32_t>(v)) {}

    [[nodiscard]] constexpr bool is_none() const { return value == kNoneValue; }
    constexpr auto operator<=>(const Index&) const = default;
};

using SiteId = Index<struct SiteTag>;                    ///< vertex of the conditioned surface
using TriangleId = Index<struct TriangleTag>;            ///< triangle of the conditioned surface
using VoronoiVertexId = Index<struct VoronoiVertexTag>;  ///< vertex of the embedded Voronoi complex
using PolygonId = Index<struct PolygonTag>;              ///< polygon (or bare edge) of the complex
using OpeningId = Index<struct OpeningTag>;              ///< opening of the conditioned surface
using EndpointId = Index<struct EndpointTag>;            ///< inlet or outlet of a model
using LoopId = Index<struct LoopTag>;                    ///< loop of the lumen

/// The position an index stands for, for use with `operator[]`.
template <class Tag>
constexpr std::size_t at(Index<Tag> i) {
    return i.value;
}

}  // namespace lumenline
