#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/model_record.h"

namespace lumenline::examples {

/// What is wrong, one sentence each; empty = the promise is kept.
using Broken = std::vector<std::string>;

/// Closed, manifold and oriented: every directed edge once and its reverse once; the wall's sites come first.
Broken check_surface(const Surface& surface);

/// As many lines as outlets; arrays of the lengths that the offsets ask for; all numbers finite.
Broken check_counts(const Centerlines& lines, const Endpoints& endpoints);

/// Abscissa: 0 at the first point, strictly increasing, never less than the chord.
Broken check_abscissa(const Centerlines& lines);

/// Lines run from their source to their target: they end in the planes of openings, within the opening's circle,
/// and at the anchors of given points.
Broken check_ends(const Centerlines& lines, const Endpoints& endpoints, const Surface& surface);

/// Every point is inside, its clearance is the distance to the surface, and its ball obeys
/// clearance^2 <= R^2 <= clearance^2 + rho^2, rho the covering radius of the nearest triangle.
Broken check_balls(const Centerlines& lines, const Surface& surface);

/// Paths: abscissa increasing, line abscissa monotone from 0 to the line's length.
Broken check_paths(const Centerlines& lines);

/// Times: finite and >= 0 or +inf, as many finite ones as `reached` says, residual at most 1e-6.
Broken check_field(const ArrivalField& field, const VoronoiComplex& complex);

/// At least 99.5 % of the wall's sites, in the components that hold a source, have a pole that a front reached.
Broken check_poles(const ModelRecord& record);

/// All of the above for a finished model, and that it has not failed.
Broken check_model(const ModelRecord& record);

/// Axis and inscribed radius of a phantom, as its *_axis.tsv states them.
struct AxisTruth {
    std::vector<double> abscissa, radius;  ///< [length]
    std::vector<Vec3> points;              ///< [length]
};

/// @throws std::runtime_error  not such a file
AxisTruth read_truth(const std::filesystem::path& file);

/// How far the first line of a phantom is from its truth; means are weighted by arc length [length].
struct TruthErrors {
    double mean_distance = 0, max_distance = 0;  ///< from the line's points to the axis
    double mean_radius = 0, max_radius = 0;      ///< |radius - inscribed radius at the nearest point of the axis|
    double length = 0;                           ///< |length of the line - length of the axis|
};

TruthErrors compare_with_truth(const Centerlines& lines, const AxisTruth& truth);

}  // namespace lumenline::examples
