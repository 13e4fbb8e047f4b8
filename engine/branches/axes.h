#pragma once

#include <span>
#include <vector>

#include "engine/branches/graph.h"
#include "engine/core/branch_options.h"
#include "engine/core/branches.h"

namespace lumenline {

/// Derivatives of a curve with respect to its arc length, smoothed. NaN where there are too few points.
struct CurveFit {
    Vec3 first, second, third;  ///< [1], [1/length], [1/length^2]
};

/// Polynomial of degree five fitted to the points within `half_width` of `s`, weighted by the tricube of their
/// distance (local regression, Cleveland 1979). Near the curve's ends the window moves inside, and its degree is three;
/// with few points it is less.
/// @param abscissa  ascending [length]
CurveFit fit_curve(std::span<const Vec3> points, std::span<const double> abscissa, double s, double half_width);

/// Curvature |x' x x''| / |x'|^3, torsion det(x', x'', x''') / |x' x x''|^2, and the Frenet frame. Torsion and normal
/// are NaN where the curve turns by less than 0.02 radians along `half_width`.
struct CurveGeometry {
    double curvature = 0, torsion = 0;  ///< [1/length]
    Vec3 tangent, normal;               ///< unit
};
CurveGeometry curve_geometry(const CurveFit& fit, double half_width);

/// Carries `normal` along a curve without turning it about the tangent, by double reflection (Wang et al. 2008).
/// @param normals  one per point; the first is given, the others are set
void transport(std::span<const Vec3> points, std::span<const Vec3> tangents, std::span<Vec3> normals);

/// Axes of the branches, resampled, with curvature, torsion and frames.
///
/// Direction of angle 0: at the first junction of a branch that of its sibling, at the first of them if there are more;
/// a root has it at its last junction, of the first branch that leaves there. If that is within a tenth of the branch's
/// own direction the next one counts. A branch without a junction has it where its line bows, from the chord to the
/// point farthest from it; a straight one, by less than a hundredth of its radius, in some direction.
BranchLines make_axes(const GraphDraft& draft, std::span<const LineView> views, const BranchOptions& options);

/// What the centerlines' points take from their branches.
LineBranches branches_of_points(const LinePieces& pieces, const BranchLines& axes, std::span<const LineView> views);

/// Interpolates on the axis of a branch.
struct AxisPlace {
    std::size_t point = 0;  ///< of BranchLines: between it and the next
    double share = 0;       ///< of the way, 0 to 1
};
AxisPlace place_on(const BranchLines& axes, BranchId branch, double abscissa);

/// Value between two points; where one is NaN, the other.
double value_at(const std::vector<double>& values, AxisPlace place);
inline Vec3 position_at(const BranchLines& axes, AxisPlace p) {
    return lerp(axes.points[p.point], axes.points[p.point + 1], p.share);
}

/// Place of a branch that a centerline's abscissa belongs to.
struct BranchPlace {
    BranchId branch;
    JunctionId junction;
    double abscissa = 0;  ///< of the branch [length]
};
BranchPlace branch_place(const LinePieces& pieces, std::size_t line, double abscissa);

}  // namespace lumenline
