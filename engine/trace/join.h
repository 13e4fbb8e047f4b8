#pragma once

#include <optional>

#include "engine/core/endpoints.h"
#include "engine/trace/final_line.h"
#include "engine/trace/medial.h"
#include "engine/trace/verify.h"

namespace lumenline {

/// The line bent at its ends onto the area centroids of its openings: within the last radius of either end
/// points are shifted by a growing share of the way from where the line ends on the axis to the centroid.
/// The share is twice differentiable; radii, clearances and ball radii there are measured anew, and the position
/// error grows by the shift. Ends at given points and tips stay.
/// @param refiner  of refined lines; null: radii are ball radii
/// @returns nothing where the bent line leaves the lumen or turns sharply
std::optional<FinalLine> join_centres(const FinalLine& axis, const Endpoint& from, const Endpoint& to,
                                      MedialRefiner* refiner, LineVerifier& verifier);

/// The second of two refined lines that meet, the sides of a loop, bent in the same way to end in the last point of the
/// first, with its values there.
/// @returns nothing where their ends are more than a quarter of the radius apart, or the bent line is of no use
std::optional<FinalLine> end_together(const FinalLine& first, const FinalLine& second, MedialRefiner& refiner,
                                      LineVerifier& verifier);

}  // namespace lumenline
