#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/core/surface.h"

namespace lumenline::test {

/// Segments against the wall, by CGAL's AABB tree with exact predicates.
class WallCrossing {
public:
    explicit WallCrossing(const Surface& surface);
    ~WallCrossing();
    WallCrossing(const WallCrossing&) = delete;
    WallCrossing& operator=(const WallCrossing&) = delete;

    [[nodiscard]] bool crosses(Vec3 a, Vec3 b) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

/// The embedded Voronoi diagram once more, by other means: straight from CGAL's triangulation with
/// its circulators around edges, exact circumcentres, and CGAL's inside and intersection tests. An edge
/// between inside vertices that crosses the wall is none. Nothing is merged. The surface must not cross
/// itself.
struct ReferenceComplex {
    struct Polygon {
        std::array<std::uint32_t, 2> sites;  ///< ascending
        std::vector<Vec3> loop;
    };
    std::vector<Polygon> polygons;                ///< vertices and edges all inside; ascending by sites
    std::vector<std::array<Vec3, 2>> bare_edges;  ///< between inside vertices, bounding none of these polygons
    std::vector<double> pole_distance;            ///< (N) radius of the largest inside ball at a site; -1 = none
    std::size_t inside_cells = 0;
    std::size_t crossing_edges = 0;
};

/// @cost about 60 us per tetrahedron
ReferenceComplex reference_complex(const Surface& surface);

}  // namespace lumenline::test
