// Openings and points become endpoints in one list of wishes; only the anchoring differs.
#include "engine/endpoints/endpoints.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/text.h"
#include "engine/endpoints/anchor.h"

namespace lumenline {

namespace {

constexpr double kOutsideShare = 0.25;  // of the local radius
constexpr double kRivalShare = 0.1;     // of the local radius
constexpr double kOffAxisShare = 0.1;   // of the local radius
constexpr double kClearLargest = 1.2;   // ratio of radii of the largest opening to the second

[[noreturn]] void fail(ErrorCode code, const std::string& sentence) {
    throw StageError(Stage::kEndpoints, code, sentence);
}

/// Least distance from the opening's centre to its boundary loop.
double inner_radius(const Surface& surface, const Opening& opening) {
    double least = opening.radius;
    for (const SiteId s : opening.loop) {
        const Vec3 d = surface.points[at(s)] - opening.point;
        least = std::min(least, norm(d - dot(d, opening.normal) * opening.normal));
    }
    return least;
}

/// The balls on the axis of a capped tube reach its cap from one inner radius before it. The anchor
/// is halfway between that place and the opening's plane, or at that place if it lies within.
double anchor_height(const Surface& surface, const Opening& opening) {
    const double reach = opening.extension_length - inner_radius(surface, opening);
    return reach > 0 ? 0.5 * reach : reach;
}

Endpoint from_opening(const Surface& surface, const VoronoiComplex& complex, OpeningId id, EndpointRole role) {
    const Opening& opening = surface.openings[at(id)];
    Endpoint e;
    e.point = opening.point;
    e.normal = opening.normal;
    e.radius = opening.radius;
    e.kind = EndpointKind::kBoundary;
    e.role = role;
    e.opening = id;
    const Vec3 axis_point = opening.point + anchor_height(surface, opening) * opening.normal;
    anchor_at_point(surface, complex, nearest_on_complex(surface, complex, axis_point), e);
    // The centroid of a concave or lopsided section is not on its medial axis: then take the deepest ball around it.
    if (distance(e.anchor, axis_point) > kOffAxisShare * e.anchor_radius) {
        e.seeds.clear();
        anchor_at_vertex(complex, deepest_vertex(complex, axis_point, kRivalShare).vertex, e);
    }
    return e;
}

Endpoint from_point(const VoronoiComplex& complex, Vec3 point, EndpointRole role) {
    const std::string name = std::string(role_name(role)) + " point " + short_text(point);
    const DeepestVertex deepest = deepest_vertex(complex, point, kRivalShare);
    Endpoint e;
    e.point = point;
    e.kind = EndpointKind::kPoint;
    e.role = role;
    anchor_at_vertex(complex, deepest.vertex, e);
    e.radius = e.anchor_radius;
    if (deepest.depth < -kOutsideShare * e.anchor_radius)
        fail(ErrorCode::kEndpointOutside, "the " + name + " is " + short_text(-deepest.depth) +
                                              " outside of the nearest maximal ball, centre " + short_text(e.anchor) +
                                              ", radius " + short_text(e.anchor_radius) +
                                              "; at most a quarter of the radius is accepted: move the point into the "
                                              "lumen (are its units the surface's?)");
    if (!deepest.rival.is_none())
        fail(ErrorCode::kEndpointAmbiguous,
             "the " + name + " lies between two branches, with balls at " + short_text(e.anchor) + " and " +
                 short_text(complex.vertices[at(deepest.rival)]) + ": move it into the one that is meant");
    return e;
}

/// The opening that a point means: the nearest whose centre is within one of its radii.
OpeningId opening_at(const Surface& surface, Vec3 point) {
    OpeningId best;
    double least = 1;
    for (std::size_t i = 0; i < surface.openings.size(); ++i) {
        const double share = distance(surface.openings[i].point, point) / surface.openings[i].radius;
        if (share < least) {
            least = share;
            best = OpeningId(i);
        }
    }
    return best;
}

class Finder {
public:
    Finder(const Surface& surface, const VoronoiComplex& complex, const EndpointOptions& options)
        : surface_(surface), complex_(complex), options_(options), taken_(surface.openings.size(), false) {}

    Endpoints run(StageContext& context) {
        const bool closed = surface_.openings.empty();
        if (closed && options_.mode == EndpointMode::kBoundaries)
            fail(ErrorCode::kEndpointsMissing,
                 "the surface is closed: it has no openings; give its inlet and outlets as points");
        if ((closed || options_.mode == EndpointMode::kPoints) && (options_.inlets.empty() || options_.outlets.empty()))
            fail(ErrorCode::kEndpointsMissing, std::string(closed ? "the surface is closed and has no openings"
                                                                  : "endpoints are to be given as points") +
                                                   ", but " + (options_.inlets.empty() ? "no inlet" : "no outlet") +
                                                   " point is given: state `inlets` and `outlets` for this model");

        for (const Vec3& p : options_.inlets) add_wish(p, EndpointRole::kInlet);
        if (options_.inlets.empty()) {
            for (const std::vector<OpeningId>& openings : openings_with_an_inlet(context))
                add_largest(openings, context);
        }
        const std::size_t inlet_count = endpoints_.size();
        for (const Vec3& p : options_.outlets) add_wish(p, EndpointRole::kOutlet);
        if (options_.outlets.empty())
            for (std::size_t i = 0; i < surface_.openings.size(); ++i)
                if (!taken_[i])
                    endpoints_.push_back(from_opening(surface_, complex_, OpeningId(i), EndpointRole::kOutlet));
        if (endpoints_.size() == inlet_count)
            fail(ErrorCode::kNoOutlet, "there is no outlet: the surface has " +
                                           counted(surface_.openings.size(), "opening") +
                                           ", all of them inlets; a centerline needs an inlet and an outlet");
        refuse_shared_anchors();
        return std::move(endpoints_);
    }

private:
    void add_wish(Vec3 point, EndpointRole role) {
        const OpeningId opening = options_.mode == EndpointMode::kPoints ? OpeningId() : opening_at(surface_, point);
        if (opening.is_none()) {
            if (options_.mode == EndpointMode::kBoundaries)
                fail(ErrorCode::kEndpointOutside, "no opening has its centre within one of its radii of the " +
                                                      std::string(role_name(role)) + " point " + short_text(point));
            endpoints_.push_back(from_point(complex_, point, role));
            return;
        }
        if (taken_[at(opening)])
            fail(ErrorCode::kEndpointAmbiguous, "two of the given points mean the same opening at " +
                                                    short_text(surface_.openings[at(opening)].point));
        taken_[at(opening)] = true;
        endpoints_.push_back(from_opening(surface_, complex_, opening, role));
    }

    /// Groups of openings of which each gets an inlet: those of each component with two or more. A component with one
    /// opening has no line; its opening is left out. All openings are one group if no component has two.
    std::vector<std::vector<OpeningId>> openings_with_an_inlet(StageContext& context) {
        std::vector<OpeningId> all;
        std::map<std::uint32_t, std::vector<OpeningId>> groups;
        for (std::size_t i = 0; i < surface_.openings.size(); ++i) {
            all.emplace_back(i);
            groups[surface_.openings[i].component].emplace_back(i);
        }
        const auto alone = [](const auto& group) { return group.second.size() == 1; };
        const auto lonely = static_cast<std::size_t>(std::count_if(groups.begin(), groups.end(), alone));
        if (groups.size() < 2 || !options_.outlets.empty() || lonely == groups.size()) return {all};
        std::vector<std::vector<OpeningId>> result;
        for (const auto& group : groups) {
            if (alone(group))
                taken_[at(group.second.front())] = true;
            else
                result.push_back(group.second);
        }
        if (lonely > 0)
            context.warn("component_without_line",
                         counted(lonely, "component") + " with one opening, which no line can lead through",
                         static_cast<double>(lonely), 0);
        return result;
    }

    void add_largest(const std::vector<OpeningId>& ids, StageContext& context) {
        const auto& openings = surface_.openings;
        const auto larger = [&](OpeningId a, OpeningId b) { return openings[at(a)].radius < openings[at(b)].radius; };
        const OpeningId id = *std::max_element(ids.begin(), ids.end(), larger);
        const Opening* largest = &openings[at(id)];
        double second = 0;
        for (const OpeningId o : ids)
            if (o != id) second = std::max(second, openings[at(o)].radius);
        if (second > 0 && largest->radius < kClearLargest * second)
            context.warn("inlet_not_clear",
                         "the largest opening (radius " + short_text(largest->radius) +
                             ") is taken as the inlet, but the second is nearly as large (" + short_text(second) +
                             "): state the inlet if it is another",
                         largest->radius / second, kClearLargest);
        taken_[at(id)] = true;
        endpoints_.push_back(from_opening(surface_, complex_, id, EndpointRole::kInlet));
    }

    void refuse_shared_anchors() const {
        for (std::size_t i = 0; i < endpoints_.size(); ++i)
            for (std::size_t j = i + 1; j < endpoints_.size(); ++j)
                if (endpoints_[i].anchor_vertex == endpoints_[j].anchor_vertex)
                    fail(ErrorCode::kEndpointAmbiguous,
                         "the endpoints at " + short_text(endpoints_[i].point) + " and " +
                             short_text(endpoints_[j].point) +
                             " fall on the same place of the lumen: they are too close, or one of them is misplaced");
    }

    const Surface& surface_;
    const VoronoiComplex& complex_;
    const EndpointOptions& options_;
    std::vector<bool> taken_;
    Endpoints endpoints_;
};

}  // namespace

Endpoints find_endpoints(const Surface& surface, const VoronoiComplex& complex, const EndpointOptions& options,
                         StageContext& context) {
    return Finder(surface, complex, options).run(context);
}

}  // namespace lumenline
