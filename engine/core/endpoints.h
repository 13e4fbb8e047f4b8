#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "engine/core/ids.h"
#include "engine/core/vec3.h"

namespace lumenline {

enum class EndpointKind : std::uint8_t { kBoundary, kPoint, kTip, kCap };
enum class EndpointRole : std::uint8_t { kInlet, kOutlet };

std::string_view kind_name(EndpointKind kind);  ///< "boundary" | "point" | "tip" | "cap"
std::string_view role_name(EndpointRole role);  ///< "inlet" | "outlet"

/// An arrival time fixed before the march, or the cost of a step onto the complex.
struct Seed {
    VoronoiVertexId vertex;
    double time = 0;  ///< >= 0, unit of the field it seeds
};

/// An end of the vessel tree. The inlet is the tree's root, whatever the direction of flow.
struct Endpoint {
    Vec3 point;         ///< centre of the opening, the given point, or the axis inside of a tip [length]
    Vec3 normal;        ///< unit, out of the lumen; zero for a given point
    Vec3 axis;          ///< unit, of the lumen beyond an opening, out of it; not the normal where it was cut obliquely
    double radius = 0;  ///< of the opening's circle of equal area, or the ball radius at a point or tip [length]
    EndpointKind kind = EndpointKind::kBoundary;
    EndpointRole role = EndpointRole::kOutlet;
    OpeningId opening;  ///< none for a point or tip

    Vec3 anchor;                             ///< the point on the complex where lines start or end [length]
    double anchor_radius = 0;                ///< ball radius there [length]
    VoronoiVertexId anchor_vertex;           ///< nearest vertex of the polygon that holds the anchor
    std::vector<PolygonId> anchor_polygons;  ///< polygons that hold the anchor
    std::vector<Seed> seeds;  ///< vertices around the anchor with the exact cost of reaching them from it
};

using Endpoints = std::vector<Endpoint>;

}  // namespace lumenline
