#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/core/endpoints.h"
#include "engine/trace/medial.h"
#include "engine/trace/polyline.h"
#include "engine/trace/verify.h"

namespace lumenline {

/// A line as it is archived: between the planes of its openings, with all its values per point.
struct FinalLine {
    Polyline line;  ///< with the best estimate of the inscribed ball's radius
    std::vector<double> ball_radius, clearance, radius_error, position_error;  ///< as Centerlines [length]
    std::vector<double> path_to_line;  ///< per point of its path: abscissa on `line`, ascending [length]
};

/// A piecewise linear function.
class Graph {
public:
    /// Keeps references. @param x  ascending
    Graph(const std::vector<double>& x, const std::vector<double>& y) : x_(x), y_(y) {}

    /// Beyond its ends the function goes on level.
    [[nodiscard]] double operator()(double at) const;

private:
    const std::vector<double>&x_, &y_;
};

/// No piece of a line turns against the one before it by more: pieces are a small part of a radius long, on which no
/// axis turns so far.
inline constexpr double kSharpestTurn = 0.5;  // cosine
/// Where a line starts or ends.
struct LineStop {
    Vec3 point, normal;  ///< a plane across the line, the normal out of it
    bool cut = false;    ///< the line goes on beyond the plane and is cut there
    bool free = false;   ///< before that its end moves across `axis`; else it stays
    Vec3 axis;           ///< of the lumen there, unit, out of the line; for free ends
};
/// At an opening the plane cuts the line; elsewhere it ends at the anchor.
LineStop stop_at(const Endpoint& endpoint);

/// The path itself as the line. True radii lie between clearance and ball radius: their difference is
/// the radius error; there is no estimate of the position's.
/// @param whole      the path from anchor to anchor
/// @param cut        its part between the planes, which begins `cut_front` after its start
FinalLine unrefined_line(const Polyline& whole, const Polyline& cut, double cut_front, const LineCheck& check);

/// The path refined, cut at the planes and checked like the path.
/// @param why  set where there is no line: what the refined line would do, for the diagnostics
/// @returns nothing where the refined line leaves the lumen, is costlier than the path by its own measure, strays
///          from it by more than its balls' radii, turns sharply, or has no part between the planes
std::optional<FinalLine> refine_line(const Polyline& path, const LineStop& from, const LineStop& to,
                                     MedialRefiner& refiner, LineVerifier& verifier, std::string& why);

}  // namespace lumenline
