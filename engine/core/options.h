#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/model_record.h"
#include "engine/core/vec3.h"

namespace lumenline {

/// Options of engine/condition.
struct ConditionOptions {
    double weld_tolerance = 1e-7;  ///< vertices closer than this share of the bounding box's diagonal become one
    double extension_radii = 1.2;  ///< openings are extended by this many of their radii; 0 = plain caps
    bool check_self_intersections = true;
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
    kNone,    ///< the descent path as traced: the paper's line
    kPath,    ///< relaxed on the complex to the shortest path of its polygon strip
    kMedial,  ///< moved off the complex to the medial axis of the smooth surface through the sites
};

/// Which source-target pairs are traced.
enum class Pairs : std::uint8_t {
    kNearest,  ///< each target from the source of least arrival time
    kAll,      ///< each target from every source that reaches it
};

/// Options of engine/trace.
struct TraceOptions {
    Refinement refine = Refinement::kMedial;
    Pairs pairs = Pairs::kNearest;
};

/// Everything that determines the result for one surface.
struct PipelineOptions {
    ConditionOptions condition;
    VoronoiOptions voronoi;
    EndpointOptions endpoints;
    TraceOptions trace;
    bool characterize = true;  ///< run engine/characterize
};

/// One model to be computed.
struct ModelTask {
    ModelIdentity identity;
    std::string surface_path;  ///< absolute, or relative to the working directory
    double scale = 1;          ///< multiplies the file's coordinates; given points are in scaled units
    PipelineOptions options;
};

std::string_view mode_name(EndpointMode mode);            ///< "auto" | "boundaries" | "points"
std::string_view refinement_name(Refinement refinement);  ///< "none" | "path" | "medial"
std::string_view pairs_name(Pairs pairs);                 ///< "nearest" | "all"

/// Canonical text of everything in `task` that determines its result, one `key=value` a line:
/// options, points, scale, and the version of every stage's algorithm. Part of `inputs_sha256`.
std::string canonical_text(const ModelTask& task);

}  // namespace lumenline
