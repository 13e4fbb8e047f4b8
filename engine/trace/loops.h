#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/arrival_field.h"
#include "engine/core/centerlines.h"
#include "engine/core/endpoints.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"
#include "engine/core/voronoi_complex.h"
#include "engine/trace/path.h"

namespace lumenline {

/// The way around a handle of the lumen: from a source down one side to where the fronts meet, and back up the other.
struct LoopPath {
    std::array<EndpointId, 2> sources;  ///< of the first and the second side; one and the same, or two of one part
    VoronoiVertexId meeting;            ///< of the two vertices of the edge where the fronts meet, the later one
    double time = 0;                    ///< when they do
    ComplexPath path;                   ///< starts and ends at the anchors of its sources
};

/// Which fronts can make a loop.
enum class Fronts : std::uint8_t {
    kOfOneSource,  ///< of each connected part, those of the first source that reaches it
    kOfAll,        ///< every vertex belongs to its nearest source: also the fronts of two sources make loops
};

struct LoopSearch {
    std::vector<LoopPath> paths;
    std::size_t between_sources = 0;  ///< of these, how many there would be without a handle: one less than sources
};

/// The handles of the lumen that the front from a source runs around on both sides, by the time when it meets itself
/// behind them: the shortest independent cycles from the source. Where all fronts count, the sources of a part are
/// taken as one: so the ways from one to the other are found too, on both sides of where their fronts meet.
///
/// Two neighbours on the complex that the front reached on different ways make a cycle: to the one, across, and back
/// from the other. It counts if polygons do not fill it (CycleClasses), if no sum of earlier ones does the same, and
/// if it goes around something that balls cannot be brought across: the two sides cannot be walked down in
/// step with balls that overlap so far that their spheres meet at more than a right angle. So a hole that the
/// sampling leaves in a sheet of the complex is no loop. Nor is a cycle that only passes through the wall, where the
/// sampling is too coarse to keep the complex off it.
/// @param fields  one per source, each with its source set
/// @param inside  whether a path stays within the wall
/// @returns as many as the surface's genus, and as there are between sources, where the sampling is sound and every
///          part has a source
/// @cost O(V log V)
LoopSearch find_loops(const VoronoiComplex& complex, const Endpoints& endpoints,
                      std::span<const std::shared_ptr<const ArrivalField>> fields, Fronts fronts,
                      const std::function<bool(const ComplexPath&)>& inside, StageContext& context);

/// The loop as it is archived.
LumenLoop loop_of(const VoronoiComplex& complex, const LoopPath& path);

/// Says how many loops there are, where, and whether lines cover them: loop_not_covered, loops_covered; and
/// loops_unlike_genus where their number is not the genus and what there is between sources.
void report_loops(const Surface& surface, const std::vector<LumenLoop>& loops, std::size_t between_sources,
                  bool covered, StageContext& context);

}  // namespace lumenline
