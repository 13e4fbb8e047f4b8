#pragma once

#include "engine/core/condition_options.h"
#include "engine/core/soup.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"

namespace lumenline {

/// Makes a closed, oriented, manifold surface of the triangles of a file.
///
/// Welds, drops degenerate and duplicate triangles, orients, splits what is not manifold, takes off flat
/// caps if asked to (flat_caps.h), fills tiny holes, extends every other opening along its vessel and closes
/// it with a refined cap, turns the normals outward, and verifies the result. Wall sites come first, in the
/// order of the input; sites and triangles of the wall keep their coordinates bit for bit.
///
/// @param soup     any triangles; must not be changed by the caller meanwhile
/// @param options  tolerances relative to the model: results do not depend on its unit
/// @param context  receives notes (welded_vertices, degenerate_triangles, duplicate_triangles,
///                 unreferenced_vertices, orientation_flipped, zero_area_triangles, flat_caps_opened) and warnings
///                 (non_manifold_split, triangles_reoriented, fragment_removed, hole_filled, opening_in_wall,
///                 multiple_components, extension_shortened, extension_blocked, crooked_opening,
///                 self_intersections)
/// @returns        the surface; openings in descending order of area
/// @throws StageError kNoSurface, kBadCoordinate, kTooLarge, kNonManifold, kOpenBoundary, kNotClosed,
///                 kNoVolume, kNestedComponents, kInterrupted
/// @cost O(n log n) time; the test for self-intersections takes more than all the rest
Surface condition_surface(const TriangleSoup& soup, const ConditionOptions& options, StageContext& context);

}  // namespace lumenline
