#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/model_record.h"
#include "engine/core/vec3.h"

namespace lumenline {

/// What becomes of a surface of several components, specks left out.
enum class ComponentPolicy : std::uint8_t {
    kFail,     ///< the model is refused
    kLargest,  ///< the component of largest area is kept
    kEach,     ///< all are kept; each that has two openings or more gets an inlet of its own
};

/// Options of engine/condition. With a repair switched off, a surface that needs it is refused.
struct ConditionOptions {
    double weld_tolerance = 1e-7;  ///< vertices closer than this share of the bounding box's diagonal become one
    double extension_radii = 1.2;  ///< openings are extended by this many of their radii; 0 = plain caps
    bool check_self_intersections = true;
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

/// Options of engine/voronoi.
struct VoronoiOptions {
    double merge_tolerance = 1e-9;  ///< Voronoi vertices closer than this share of their ball radius become one
};

/// How inlets and outlets are found.
enum class EndpointMode : std::uint8_t {
    kAuto,        ///< points if any are given and the surface is closed, else boundaries
    kBoundaries,  ///< openings of the surface
    kPoints,      ///< the given points only
};

/// Inlets and outlets of one model as the user states them.
struct EndpointOptions {
    EndpointMode mode = EndpointMode::kAuto;
    std::vector<Vec3> inlets;   ///< with boundaries: the opening nearest to each is an inlet; empty = the largest
    std::vector<Vec3> outlets;  ///< with boundaries: the openings to use; empty = all that are no inlets
};

/// How a centerline is made from the arrival times.
enum class Refinement : std::uint8_t {
    kNone,  ///< the descent path as traced: the paper's line
    kPath,  ///< relaxed on the complex to the shortest path of its polygon strip
};

/// Which source-target pairs are traced.
enum class Pairs : std::uint8_t {
    kNearest,  ///< each target from the source of least arrival time
    kAll,      ///< each target from every source that reaches it
};

/// Options of engine/trace.
struct TraceOptions {
    Refinement refine = Refinement::kPath;
    Pairs pairs = Pairs::kNearest;
};

/// Everything that determines the result for one surface.
struct PipelineOptions {
    ConditionOptions condition;
    VoronoiOptions voronoi;
    EndpointOptions endpoints;
    TraceOptions trace;
};

/// One model to be computed.
struct ModelTask {
    ModelIdentity identity;
    std::string surface_path;  ///< absolute, or relative to the working directory
    double scale = 1;          ///< multiplies the file's coordinates; given points are in scaled units
    PipelineOptions options;
};

std::string_view components_name(ComponentPolicy policy);  ///< "fail" | "largest" | "each"
std::string_view mode_name(EndpointMode mode);            ///< "auto" | "boundaries" | "points"
std::string_view refinement_name(Refinement refinement);  ///< "none" | "path"
std::string_view pairs_name(Pairs pairs);                 ///< "nearest" | "all"

/// Canonical text of everything in `task` that determines its result, one `key=value` a line:
/// options, points, scale, and the version of every stage's algorithm. Part of `inputs_sha256`.
std::string canonical_text(const ModelTask& task);

}  // namespace lumenline
