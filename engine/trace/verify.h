#pragma once

#include <boost/container_hash/hash.hpp>
#include <cstddef>
#include <string>
#include <unordered_map>
#include <vector>

#include "engine/core/surface.h"
#include "engine/geometry/surface_distance.h"
#include "engine/trace/polyline.h"

namespace lumenline {

/// What the checks of one line found.
struct LineCheck {
    std::vector<double> clearance;  ///< per point: distance to the surface [length]
    bool inside = true;             ///< every point and every segment is in the lumen
    Vec3 outside_at;                ///< where it is not
    /// Largest violation of clearance^2 <= R^2 <= clearance^2 + rho^2 relative to R^2, rho the
    /// covering radius of the nearest triangle; <= 0 is as it should be.
    double ball_excess = 0;
};

/// Checks lines of one surface.
class LineVerifier {
public:
    explicit LineVerifier(const Surface& surface);

    /// @cost one distance query per point; more only where a segment is longer than its ends' clearances;
    ///       O(triangles) for the first line and for lines that start elsewhere
    [[nodiscard]] LineCheck check(const Polyline& line);

    /// Distance to the nearest site. @cost as one point of `check`
    [[nodiscard]] double empty_ball_radius(Vec3 x);

    [[nodiscard]] const Surface& surface() const { return surface_; }
    [[nodiscard]] const SurfaceDistance& surface_distance() const { return distance_; }

private:
    struct Ball {
        Vec3 centre;
        double radius = 0;
    };
    struct PlaceHash {
        std::size_t operator()(const Vec3& x) const { return boost::hash_range(&x.x, &x.x + 3); }
    };

    [[nodiscard]] bool inside(Vec3 x, double clearance);
    SurfaceDistance::Nearest nearest(Vec3 x, SurfaceDistance::Nearest& last);
    [[nodiscard]] bool segment_inside(Vec3 a, Vec3 b, double clearance_a, double clearance_b, int depth,
                                      SurfaceDistance::Nearest& last);

    const Surface& surface_;
    SurfaceDistance distance_;
    // Lines of one source share their beginnings, to the bit where they were refined together: asked once.
    std::unordered_map<Vec3, SurfaceDistance::Nearest, PlaceHash> walls_;
    std::unordered_map<Vec3, double, PlaceHash> balls_;
    std::vector<Ball> known_;  // that hold nothing of the surface, with their centres in the lumen
};

}  // namespace lumenline
