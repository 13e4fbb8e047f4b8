// Cramer's rule for the plane equations of the bisectors, in rationals: no rounding until the end.
#include "tests/stages/exact_circumcentre.h"

#include <CGAL/Exact_rational.h>

#include <cmath>

namespace lumenline::test {

namespace {

using Exact = CGAL::Exact_rational;
using ExactVector = std::array<Exact, 3>;

ExactVector exact(Vec3 p) { return {Exact(p.x), Exact(p.y), Exact(p.z)}; }
ExactVector difference(const ExactVector& a, const ExactVector& b) {
    return {Exact(a[0] - b[0]), Exact(a[1] - b[1]), Exact(a[2] - b[2])};
}
Exact exact_dot(const ExactVector& a, const ExactVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
ExactVector exact_cross(const ExactVector& a, const ExactVector& b) {
    return {Exact(a[1] * b[2] - a[2] * b[1]), Exact(a[2] * b[0] - a[0] * b[2]), Exact(a[0] * b[1] - a[1] * b[0])};
}

}  // namespace

ExactCentre exact_circumcentre(const Corners& p) {
    const ExactVector o = exact(p[0]), a = difference(exact(p[1]), o), b = difference(exact(p[2]), o),
                      c = difference(exact(p[3]), o);
    const ExactVector bc = exact_cross(b, c), ca = exact_cross(c, a), ab = exact_cross(a, b);
    const Exact det = exact_dot(a, bc), aa = exact_dot(a, a), bb = exact_dot(b, b), cc = exact_dot(c, c);
    ExactCentre result;
    if (det == 0) return result;
    std::array<double, 3> centre{};
    Exact radius2 = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Exact offset = (aa * bc[k] + bb * ca[k] + cc * ab[k]) / (2 * det);
        radius2 += offset * offset;
        centre[k] = CGAL::to_double(Exact(o[k] + offset));
    }
    result.centre = {centre[0], centre[1], centre[2]};
    result.radius = std::sqrt(CGAL::to_double(radius2));
    result.relative_determinant =
        std::fabs(CGAL::to_double(det)) / std::sqrt(CGAL::to_double(aa) * CGAL::to_double(bb) * CGAL::to_double(cc));
    return result;
}

}  // namespace lumenline::test
