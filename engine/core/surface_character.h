#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/core/ids.h"
#include "engine/core/vec3.h"

namespace lumenline {

using LineId = Index<struct LineTag>;  ///< centerline of a model

/// What a site counts as in statistics.
enum class SiteZone : std::uint8_t {
    kWall = 0,     ///< counted
    kAdded = 1,    ///< extension or cap: no wall of the vessel
    kEndZone = 2,  ///< its centerline point is within the last radius of a closed end
};

/// Distribution of a quantity over the counted wall, weighted by area. NaN where nothing is counted.
struct AreaStatistics {
    double mean = std::numeric_limits<double>::quiet_NaN();
    double sd = std::numeric_limits<double>::quiet_NaN();
    double median = std::numeric_limits<double>::quiet_NaN();
    double p95 = std::numeric_limits<double>::quiet_NaN();  ///< 95 % of the area lies at or below it
};

/// Edges of the counted wall along which D_g or c(p) jumps: changes by more than three times the edge's length and a
/// quarter of the smaller ball radius of the two poles. By cause:
struct JumpCounts {
    std::size_t pole_sheet = 0;     ///< the poles are as far apart: the pole changes sheet
    std::size_t branches_meet = 0;  ///< poles are close, c(p) far apart: their descents part, as where branches meet
    std::size_t other = 0;
};

/// Geometric characterization of the surface (Antiga et al. 2003, section 2.2). Arrays per site hold NaN (ids none)
/// where no path leads from the site to a centerline. The plain names use the paper's pole, those with the suffix
/// `refined` the medial ball that touches the surface at the site.
struct SurfaceCharacter {
    std::vector<double> centerline_distance;  ///< (V) T~ along the complex (eq. 6) [length]; +inf = unreached

    std::vector<double> geodesic_distance;                      ///< (N) D_g (eq. 7) [length]
    std::vector<double> descent_length;                         ///< (N) of the path from the pole to c(p) [length]
    std::vector<double> euclidean_distance;                     ///< (N) D_e = |c(p) - p| [length]
    std::vector<double> normalized_tangency_deviation;          ///< (N) NTD (eq. 8), in [0, 1]
    std::vector<double> geodesic_distance_refined;              ///< (N) [length]
    std::vector<double> normalized_tangency_deviation_refined;  ///< (N) in [0, 1]
    std::vector<Vec3> centerline_point;                         ///< (N) c(p), on a path of the complex [length]
    std::vector<LineId> centerline_id;                          ///< (N) line that c(p) belongs to
    std::vector<double> abscissa;                               ///< (N) of that line at c(p) [length]
    std::vector<SiteZone> zone;                                 ///< (N)

    double wall_area = 0;         ///< of the counted wall that is reached [length^2]
    std::size_t wall_sites = 0;   ///< sites of zone kWall
    std::size_t unreached = 0;    ///< of these, without a centerline
    std::size_t not_refined = 0;  ///< of these, where the refined values are those of the paper's pole
    AreaStatistics geodesic_distance_statistics;
    AreaStatistics euclidean_distance_statistics;
    AreaStatistics normalized_tangency_deviation_statistics;
    JumpCounts jumps;

    [[nodiscard]] std::size_t site_count() const { return geodesic_distance.size(); }
};

}  // namespace lumenline
