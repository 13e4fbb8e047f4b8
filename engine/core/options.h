#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/branch_options.h"
#include "engine/core/condition_options.h"
#include "engine/core/model_record.h"
#include "engine/core/vec3.h"

namespace lumenline {

/// Options of engine/voronoi.
struct VoronoiOptions {
    double merge_tolerance = 1e-9;  ///< Voronoi vertices closer than this share of their ball radius become one
};

/// Where the ends of a model come from.
enum class EndpointMode : std::uint8_t {
    kAuto,        ///< openings; on a closed surface flat caps; without any, the given points, else blind tips
    kBoundaries,  ///< openings of the surface
    kCaps,        ///< flat caps, taken off
    kTips,        ///< blind ends
    kPoints,      ///< the given points only
};

/// One mode or several at once: a model may have openings and blind tips.
class EndpointModes {
public:
    constexpr EndpointModes(EndpointMode mode) : bits_(bit(mode)) {}  // NOLINT: one mode is a set of one

    [[nodiscard]] constexpr bool has(EndpointMode mode) const { return (bits_ & bit(mode)) != 0; }
    constexpr EndpointModes& operator|=(EndpointModes other) {
        bits_ |= other.bits_;
        return *this;
    }
    constexpr bool operator==(const EndpointModes&) const = default;

private:
    static constexpr unsigned bit(EndpointMode mode) { return 1U << static_cast<unsigned>(mode); }
    unsigned bits_;
};

constexpr EndpointModes operator|(EndpointModes a, EndpointModes b) { return a |= b; }

/// One way to say which end is an inlet.
struct InletRule {
    enum class Kind : std::uint8_t {
        kLargest,   ///< the end of largest radius
        kSmallest,  ///< the end of least radius
        kHighest,   ///< the end whose coordinate along `axis` is greatest
        kLowest,    ///< the end whose coordinate along `axis` is least
        kNearest,   ///< the end nearest to `point`
        kBoundary,  ///< opening `number` by descending area, from 1
        kPoint,     ///< `point` itself, even next to an opening
    };
    Kind kind = Kind::kLargest;
    int axis = 2;            ///< 0 = x
    std::size_t number = 1;  ///< of an opening
    Vec3 point;              ///< [length]

    bool operator==(const InletRule&) const = default;
};

/// Inlets and outlets of one model as the user states them.
struct EndpointOptions {
    EndpointModes mode = EndpointMode::kAuto;
    std::vector<Vec3> inlets;   ///< the opening nearest to each is an inlet, or the point itself where there is none
    std::vector<Vec3> outlets;  ///< in the same way, the outlets to use; empty = all ends that are no inlets
    std::vector<InletRule> inlet_rules = {};  ///< one inlet each, beside `inlets`; none of both = the largest end
    double tip_length = 3;  ///< least length of a blind branch beyond the wall of its parent [local radii]
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

/// Where in the plane of its opening a line ends.
enum class Join : std::uint8_t {
    kAxis,    ///< where the axis crosses the plane
    kCentre,  ///< at the area centroid of the opening's loop, the last radius of the line bent there
};

/// What the lines of a lumen with loops are.
enum class Topology : std::uint8_t {
    kTree,     ///< one line to each target: loops are reported
    kNetwork,  ///< two more for each loop, which meet behind it
};

/// Options of engine/trace.
struct TraceOptions {
    Refinement refine = Refinement::kMedial;
    Pairs pairs = Pairs::kNearest;
    Join join = Join::kAxis;
    Topology topology = Topology::kTree;
};

/// Everything that determines the result for one surface.
struct PipelineOptions {
    ConditionOptions condition;
    VoronoiOptions voronoi;
    EndpointOptions endpoints;
    TraceOptions trace;
    bool characterize = true;  ///< run engine/characterize
    BranchOptions branches;
};

/// One model to be computed.
struct ModelTask {
    ModelIdentity identity;
    std::string surface_path;  ///< absolute, or relative to the working directory
    double scale = 1;          ///< multiplies the file's coordinates; given points are in scaled units
    PipelineOptions options;
};

std::string_view components_name(ComponentPolicy policy);  ///< "fail" | "largest" | "each"
std::string_view mode_name(EndpointMode mode);             ///< "auto" | "boundaries" | "caps" | "tips" | "points"
std::string modes_text(EndpointModes modes);               ///< the names with commas between them
/// As a configuration states the rule: "largest", "highest z", "nearest [1, 2, 3]", "boundary 2", ...
std::string rule_text(const InletRule& rule);
std::string_view refinement_name(Refinement refinement);  ///< "none" | "path" | "medial"
std::string_view pairs_name(Pairs pairs);                 ///< "nearest" | "all"
std::string_view join_name(Join join);                    ///< "axis" | "centre"
std::string_view topology_name(Topology topology);        ///< "tree" | "network"

/// Canonical text of everything in `task` that determines its result, one `key=value` a line:
/// options, points, scale, and the version of every stage's algorithm. Part of `inputs_sha256`.
std::string canonical_text(const ModelTask& task);

}  // namespace lumenline
