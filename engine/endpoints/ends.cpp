// Three kinds of ends and one anchor each: only the anchoring differs.
#include "engine/endpoints/ends.h"

#include <algorithm>

#include "engine/core/text.h"
#include "engine/endpoints/anchor.h"

namespace lumenline {

namespace {

constexpr double kOutsideShare = 0.25;  // of the local radius
constexpr double kRivalShare = 0.1;     // of the local radius
constexpr double kOffAxisShare = 0.1;   // of the local radius, beyond which another anchor is looked for
constexpr double kFarFromAxis = 1;      // of the local radius, beyond which the user is told

/// Least distance from the opening's axis to its boundary loop.
double inner_radius(const Surface& surface, const Opening& opening) {
    double least = opening.radius;
    for (const SiteId s : opening.loop) {
        const Vec3 d = surface.points[at(s)] - opening.point;
        least = std::min(least, norm(d - dot(d, opening.axis) * opening.axis));
    }
    return least;
}

/// The balls on the axis of a capped tube reach its cap from one inner radius before it. The anchor
/// is halfway between that place and the opening's centre, or at that place if it lies within.
double anchor_height(const Surface& surface, const Opening& opening) {
    const double reach = opening.extension_length - inner_radius(surface, opening);
    return reach > 0 ? 0.5 * reach : reach;
}

void warn_if_off_axis(const Endpoint& e, Vec3 wanted, const std::string& name, StageContext& context) {
    const double share = distance(e.anchor, wanted) / e.anchor_radius;
    if (share > kFarFromAxis)
        context.warn("endpoint_off_axis",
                     name + " is " + short_text(share, 3) + " local radii away from the axis: its line ends at " +
                         short_text(e.anchor) + ", where the radius is " + short_text(e.anchor_radius) +
                         "; state the end as a point if that is another place",
                     share, kFarFromAxis);
}

}  // namespace

void refuse_endpoints(ErrorCode code, const std::string& sentence) {
    throw StageError(Stage::kEndpoints, code, sentence);
}

Endpoint end_of_opening(const Surface& surface, OpeningId id) {
    const Opening& opening = surface.openings[at(id)];
    Endpoint e;
    e.point = opening.point;
    e.normal = opening.normal;
    e.axis = opening.axis;
    e.radius = opening.radius;
    e.kind = opening.flat_cap ? EndpointKind::kCap : EndpointKind::kBoundary;
    e.opening = id;
    return e;
}

void anchor_end(const Surface& surface, const VoronoiComplex& complex, Endpoint& e, StageContext& context) {
    if (e.opening.is_none()) return;
    const Opening& opening = surface.openings[at(e.opening)];
    const Vec3 axis_point = opening.point + anchor_height(surface, opening) * opening.axis;
    anchor_at_point(surface, complex, nearest_on_complex(surface, complex, axis_point), e);
    // The centroid of a concave or lopsided section is not on its medial axis: then take the deepest ball around it.
    if (distance(e.anchor, axis_point) > kOffAxisShare * e.anchor_radius) {
        e.seeds.clear();
        anchor_at_vertex(complex, deepest_vertex(complex, axis_point, kRivalShare).vertex, e);
        warn_if_off_axis(e, axis_point, "the centre of the opening at " + short_text(opening.point), context);
    }
}

Endpoint endpoint_at_point(const VoronoiComplex& complex, Vec3 point, const std::string& name, StageContext& context) {
    const DeepestVertex deepest = deepest_vertex(complex, point, kRivalShare);
    Endpoint e;
    e.point = point;
    e.kind = EndpointKind::kPoint;
    anchor_at_vertex(complex, deepest.vertex, e);
    e.radius = e.anchor_radius;
    if (deepest.depth < -kOutsideShare * e.anchor_radius)
        refuse_endpoints(ErrorCode::kEndpointOutside,
                         name + " is " + short_text(-deepest.depth) + " outside of the nearest maximal ball, centre " +
                             short_text(e.anchor) + ", radius " + short_text(e.anchor_radius) +
                             "; at most a quarter of the radius is accepted: move the point into the "
                             "lumen (are its units the surface's?)");
    if (!deepest.rival.is_none())
        refuse_endpoints(ErrorCode::kEndpointAmbiguous,
                         name + " lies between two branches, with balls at " + short_text(e.anchor) + " and " +
                             short_text(complex.vertices[at(deepest.rival)]) + ": move it into the one that is meant");
    warn_if_off_axis(e, point, name, context);
    return e;
}

Endpoint endpoint_at_tip(const VoronoiComplex& complex, const Tip& tip) {
    Endpoint e;
    anchor_at_vertex(complex, tip.vertex, e);
    e.point = e.anchor;
    e.normal = tip.direction;
    e.radius = e.anchor_radius;
    e.kind = EndpointKind::kTip;
    return e;
}

}  // namespace lumenline
