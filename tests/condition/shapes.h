#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/core/options.h"
#include "engine/core/soup.h"
#include "engine/core/stage_context.h"
#include "engine/core/surface.h"

namespace lumenline::testing {

/// Position on a tube: angle index i of n, ring k of m.
using TubePoint = std::function<Vec3(std::size_t i, std::size_t k)>;

/// Open tube of `rings` rings of `around` points, facing outward if the rings advance along +z and the
/// angle runs counter-clockwise. Triangle order: ring by ring. Point k * around + i is (i, k).
TriangleSoup tube(std::size_t around, std::size_t rings, const TubePoint& point);

/// Round tube along z from 0 to `length`, odd rings turned by half a side.
TriangleSoup round_tube(std::size_t around, std::size_t rings, double radius, double length);

/// Tube of radius one around a polyline in the xz-plane.
TriangleSoup swept_tube(std::size_t around, const std::vector<Vec3>& path);

/// Closed cube of side two around `centre`, each side split in n x n squares.
TriangleSoup cube(std::size_t n, Vec3 centre, double half_side = 1);
TriangleSoup tetrahedron(Vec3 a, Vec3 b, Vec3 c, Vec3 d);

/// Both soups in one, without joining points.
TriangleSoup merged(const TriangleSoup& a, const TriangleSoup& b);
/// Each triangle with its own three points.
TriangleSoup exploded(const TriangleSoup& soup);
TriangleSoup mapped(TriangleSoup soup, const std::function<Vec3(Vec3)>& map);
/// The same surface with points and triangles in another order.
TriangleSoup shuffled(const TriangleSoup& soup, unsigned seed);

/// What condition_surface does with the options given; by default without refinement, because most shapes here
/// are as coarse as can be.
struct Conditioned {
    Surface surface;
    Diagnostics diagnostics;
    [[nodiscard]] std::size_t count(const std::string& code) const;
    [[nodiscard]] double value(const std::string& code) const;
    [[nodiscard]] std::size_t warnings() const;
};
Conditioned condition(const TriangleSoup& soup, const ConditionOptions& options);
Conditioned condition(const TriangleSoup& soup, double extension_radii = 1.2, double weld_tolerance = 1e-7);

/// Error name of the refusal, "" if there was none.
std::string refusal(const TriangleSoup& soup, const ConditionOptions& options);
std::string refusal(const TriangleSoup& soup, double weld_tolerance = 1e-7, std::string* sentence = nullptr);

/// Every directed edge once, its reverse once, every site's triangles one fan.
bool is_closed_manifold(const Surface& surface);
double volume(const Surface& surface);
int euler_characteristic(const Surface& surface);
/// Pairs of triangles that cross.
std::size_t crossings(const Surface& surface);
std::size_t count_origin(const Surface& surface, SiteOrigin origin);
/// Triangles per site, the largest among sites of `origin`.
std::size_t largest_valence(const Surface& surface, SiteOrigin origin);
double regular_polygon_radius(std::size_t n, double radius);  ///< of the circle of equal area

}  // namespace lumenline::testing
