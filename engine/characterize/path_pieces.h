#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/centerlines.h"
#include "engine/core/endpoints.h"
#include "engine/core/surface.h"
#include "engine/core/surface_character.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline {

/// A stretch of a centerline's path within one polygon, or the one point where it touches it.
struct PathPiece {
    Vec3 from, to;                        ///< in the polygon; equal where it is touched [length]
    std::uint32_t point = 0;              ///< the path's points `point` and `point` + 1 hold the piece between them
    double share_from = 0, share_to = 0;  ///< where between these two its ends are, 0 to 1
    LineId line;
};

/// A place on a path, and how far it is from where it was asked for.
struct PathFoot {
    Vec3 x;  ///< c(p), on the complex [length]
    double distance = std::numeric_limits<double>::infinity();
    std::uint32_t point = 0;  ///< as in PathPiece
    double share = 0;         ///< between `point` and `point` + 1, 0 to 1
    LineId line;              ///< none = no path
};

/// Where the paths of all centerlines cross or touch the polygons of the complex.
class PathPieces {
public:
    /// @param lines  with places of its paths
    /// @cost O(path points x polygons around each)
    PathPieces(const Surface& surface, const VoronoiComplex& complex, const Endpoints& endpoints,
               const Centerlines& lines);

    [[nodiscard]] bool crosses(PolygonId p) const { return first_[at(p)] != last_[at(p)]; }
    [[nodiscard]] std::span<const PathPiece> in(PolygonId p) const {
        return {pieces_.data() + first_[at(p)], pieces_.data() + last_[at(p)]};
    }
    /// Polygons that hold a piece, ascending.
    [[nodiscard]] const std::vector<PolygonId>& polygons() const { return polygons_; }

    /// Nearest point of the paths in the polygon p to its point x. Where lines run together, within 1e-2 of
    /// `radius` from each other, the first of them has it.
    [[nodiscard]] PathFoot nearest(PolygonId p, Vec3 x, double radius) const;
    /// Distance from x to the nearest of the paths in p [length].
    [[nodiscard]] double least_distance(PolygonId p, Vec3 x) const { return nearest(p, x, 0).distance; }

private:
    std::vector<PathPiece> pieces_;
    std::vector<std::uint32_t> first_, last_;  ///< per polygon, into pieces_
    std::vector<PolygonId> polygons_;
};

}  // namespace lumenline
