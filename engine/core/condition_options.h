#pragma once

#include <cstdint>

namespace lumenline {

/// What becomes of triangles that close the flat end of a vessel.
enum class FlatCaps : std::uint8_t {
    kKeep,          ///< they are wall
    kOpenIfClosed,  ///< taken off where the surface has no opening
    kOpen,          ///< taken off
};

/// What becomes of a surface of several components, specks left out.
enum class ComponentPolicy : std::uint8_t {
    kFail,     ///< the model is refused
    kLargest,  ///< the component of largest area is kept
    kEach,     ///< all are kept; each that has two ends or more gets an inlet of its own
};

/// Options of engine/condition. With a repair switched off, a surface that needs it is refused.
struct ConditionOptions {
    double weld_tolerance = 1e-7;  ///< vertices closer than this share of the bounding box's diagonal become one
    double extension_radii = 1.2;  ///< openings are extended by this many of their radii; 0 = plain caps
    bool check_self_intersections = true;
    FlatCaps flat_caps = FlatCaps::kKeep;   ///< of a pipeline: what its endpoint modes ask for
    bool drop_faces = true;                 ///< leave out degenerate and repeated triangles
    bool orient_faces = true;               ///< turn flipped triangles, and components that face inward
    bool split_non_manifold = true;         ///< part sheets that meet in an edge of more than two triangles or a vertex
    bool fill_holes = true;                 ///< close small holes in the wall; else every boundary loop is an opening
    bool repair_self_intersections = true;  ///< replace small patches of triangles that cross each other
    double speck_share = 0.001;             ///< components below this share of the area are removed; 0 = none
    ComponentPolicy components = ComponentPolicy::kEach;
    bool refine_undersampled = true;  ///< add sites on curved patches where triangles are large for the vessel
    double decimate = 0;              ///< share of the diagonal by which a coarser surface may differ; 0 = off
};

}  // namespace lumenline
