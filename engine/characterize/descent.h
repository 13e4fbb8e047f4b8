#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/characterize/path_pieces.h"
#include "engine/core/voronoi_complex.h"
#include "engine/geometry/polygon_march.h"

namespace lumenline {

/// Where a descent ends, and its length.
struct DescentEnd {
    PathFoot foot;      ///< c(p); its `distance` is that of the last step
    double length = 0;  ///< of the whole descent [length]

    [[nodiscard]] bool reached() const { return !foot.line.is_none(); }
};

/// Steepest descent of T~ on the complex down to a path (Antiga et al. 2003, section 2.2), as trace_back.cpp does for
/// T: from the point reached, the best next point is the one on the edges of the polygons around it, or on a path in
/// one of them, that minimises T~ there plus the distance between the two. Ends are remembered per vertex, so that
/// descents that meet in a vertex are walked once. Several threads may ask at once: each end is the same whoever walks.
class Descent {
public:
    /// @param march  with T~ and its ways, as the march leaves it; all must outlive the descent
    Descent(const VoronoiComplex& complex, const PathPieces& pieces, const PathLines& path,
            const MarchWorkspace& march);

    /// @returns reached() is false where T~ is infinite
    /// @cost O(polygons crossed) up to the first vertex known from before
    DescentEnd from(VoronoiVertexId v);

    /// T~ at the point x of the polygon p: the best first step of a descent from there.
    [[nodiscard]] double distance_at(PolygonId p, Vec3 x, double radius) const;

private:
    /// The next point of a descent.
    struct Step {
        double value;        ///< T~ there plus the distance to it
        ComplexPoint place;  ///< none where `foot` is the next point
        PathFoot foot;       ///< on a path
        PolygonId through;   ///< the polygon on the way
    };
    /// A point of a descent.
    struct Here {
        Vec3 x;
        double radius = 0;
        double time;          ///< T~
        ComplexPoint place;   ///< none = inside a polygon
        PolygonId through{};  ///< the polygon that was crossed to get here
    };

    void try_polygon(PolygonId p, const Here& here, Step& best) const;
    [[nodiscard]] Here arrive(const ComplexPoint& place) const;
    [[nodiscard]] TimedPoint node(VoronoiVertexId v) const {
        return {complex_.vertices[at(v)], complex_.ball_radius[at(v)], time_[at(v)]};
    }
    [[nodiscard]] Step best_step(const Here& here) const;
    /// The step that gave v its time.
    [[nodiscard]] Step first_step(VoronoiVertexId v, const Here& here) const;
    /// Descends from v until known descents take over; false where `needed` have to be known first.
    bool walk(VoronoiVertexId v, std::vector<VoronoiVertexId>& needed, DescentEnd& end) const;
    /// Continues from a point of an edge between the descents of its ends; false where they part.
    bool joined(const ComplexPoint& place, DescentEnd& end) const;

    enum class State : std::uint8_t { kUnknown, kBeingStored, kKnown };

    [[nodiscard]] bool known(VoronoiVertexId v) const {
        return state_[at(v)].load(std::memory_order_acquire) == State::kKnown;
    }
    /// Remembers the end of the descent from v; returns when it is known, to whichever thread.
    void store(VoronoiVertexId v, const DescentEnd& end);

    const VoronoiComplex& complex_;
    const PathPieces& pieces_;
    const PathLines& path_;
    std::span<const double> time_;
    std::span<const PolygonId> through_;
    std::vector<std::atomic<State>> state_;  ///< per vertex, of its place in ends_
    std::vector<DescentEnd> ends_;
};

}  // namespace lumenline
