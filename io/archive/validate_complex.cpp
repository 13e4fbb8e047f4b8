// What follows from the method holds up to what it allows itself: Voronoi vertices closer than 1e-9 of their radius, or
// than 64 roundings of the file's coordinates, were made one, several in a chain; times and distances are stored in
// single precision; a front's distances satisfy its update, and the triangle inequality up to the update's error.

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/core/text.h"
#include "io/archive/inspection.h"
#include "io/archive/line_names.h"

namespace lumenline {

namespace {

using Numbers = std::vector<double>;

constexpr double kMergedShare = 1e-8;      ///< of the radius
constexpr double kMergedRoundings = 1024;  ///< of the coordinates
constexpr double kSingle = 1e-6;           ///< a few roundings of single precision, relative
constexpr double kMarchShare = 0.01;       ///< error of a march over one edge, as a share of the radius there

std::string site_text(std::size_t s) { return "site " + std::to_string(s); }

class Complex {
public:
    explicit Complex(Inspection& inspection) : inspection_(inspection) {
        if (!inspection.file().has(names::kSurface)) return;
        const std::string text = inspection.file().attribute(names::kSurface, "coordinate_rounding").value_or("");
        std::from_chars(text.data(), text.data() + text.size(), rounding_);
        if (!(rounding_ >= 0)) rounding_ = 0;
    }

    void check() {
        check_polygons();
        check_poles();
        check_reached();
        check_distances();
        check_bound();
        check_triangle_inequality();
    }

private:
    [[nodiscard]] Vec3 vertex(std::size_t v) const { return point_at(inspection_.numbers(names::kVertices), v); }
    [[nodiscard]] Vec3 site(std::size_t s) const { return point_at(inspection_.numbers(names::kSurfacePoints), s); }
    [[nodiscard]] double radius(std::size_t v) const { return inspection_.numbers(names::kBallRadius)[v]; }
    [[nodiscard]] bool touches(std::size_t v, std::size_t s) const {
        const double slack = kMergedShare * radius(v) + kMergedRoundings * rounding_;
        return std::fabs(distance(vertex(v), site(s)) - radius(v)) <= slack;
    }
    [[nodiscard]] std::pair<std::size_t, std::size_t> polygon(std::size_t p) const {
        const Numbers& offsets = inspection_.numbers(names::kPolygonOffsets);
        return {static_cast<std::size_t>(offsets[p]), static_cast<std::size_t>(offsets[p + 1])};
    }
    [[nodiscard]] std::size_t corner(std::size_t i) const {
        return static_cast<std::size_t>(inspection_.numbers(names::kPolygonVertices)[i]);
    }
    [[nodiscard]] bool is_complex_sound() const {
        return inspection_.are_sound({&names::kVertices, &names::kBallRadius, &names::kPolygonOffsets,
                                      &names::kPolygonVertices, &names::kPolygonSites, &names::kSurfacePoints});
    }

    void check_polygons() {
        if (!is_complex_sound()) return;
        const Numbers& sites = inspection_.numbers(names::kPolygonSites);
        inspection_.all_hold(names::kPolygonSites.path, sites.size() / 2, [&](std::size_t p) {
            const auto [first, last] = polygon(p);
            const std::string name = "polygon " + std::to_string(p);
            const bool bare = sites[2 * p] < 0;
            if (bare != (sites[2 * p + 1] < 0)) return name + " has one site";
            if (bare) return last - first == 2 ? std::string() : name + " has no sites and is no edge";
            if (last - first < 3) return name + " has sites, but fewer than three vertices";
            for (std::size_t i = first; i < last; ++i)
                for (const std::size_t side : {std::size_t{0}, std::size_t{1}})
                    if (const auto s = static_cast<std::size_t>(sites[2 * p + side]); !touches(corner(i), s))
                        return "the ball at vertex " + std::to_string(corner(i)) + " of " + name +
                               " does not touch its site " + std::to_string(s);
            return std::string();
        });
    }

    void check_poles() {
        if (!inspection_.are_sound({&names::kPole, &names::kVertices, &names::kBallRadius, &names::kSurfacePoints}))
            return;
        const Numbers& pole = inspection_.numbers(names::kPole);
        inspection_.all_hold(names::kPole.path, pole.size(), [&](std::size_t s) {
            if (pole[s] < 0 || touches(static_cast<std::size_t>(pole[s]), s)) return std::string();
            return "the ball at the pole " + short_text(pole[s], 10) + " of " + site_text(s) + " does not touch it";
        });
    }

    void check_reached() {
        if (!inspection_.are_sound({&names::kArrivalTime, &names::kReached})) return;
        const Numbers &time = inspection_.numbers(names::kArrivalTime), &reached = inspection_.numbers(names::kReached);
        const std::size_t vertices = inspection_.length('V');
        inspection_.all_hold(names::kReached.path, reached.size(), [&](std::size_t s) {
            const auto row = time.begin() + static_cast<std::ptrdiff_t>(s * vertices);
            const auto found = std::count_if(row, row + static_cast<std::ptrdiff_t>(vertices),
                                             [](double t) { return std::isfinite(t); });
            if (static_cast<double>(found) == reached[s]) return std::string();
            return "source " + std::to_string(s) + " reached " + std::to_string(found) +
                   " vertices by /voronoi/arrival_time, not " + short_text(reached[s], 10);
        });
    }

    /// Equations 7 and 8, site by site, and D_e as the distance it is.
    void check_distances() {
        if (!inspection_.are_sound({&names::kGeodesic, &names::kCenterlineDistance, &names::kPole, &names::kVertices,
                                    &names::kSurfacePoints}))
            return;
        const Numbers &geodesic = inspection_.numbers(names::kGeodesic),
                      &along = inspection_.numbers(names::kCenterlineDistance),
                      &pole = inspection_.numbers(names::kPole);
        const auto at_pole = [&](std::size_t s) { return along[static_cast<std::size_t>(pole[s])]; };
        const auto has_way = [&](std::size_t s) { return pole[s] >= 0 && !std::isnan(geodesic[s]); };
        inspection_.all_hold(names::kGeodesic.path, geodesic.size(), [&](std::size_t s) {
            if (std::isnan(geodesic[s])) return std::string();
            if (pole[s] < 0) return site_text(s) + " has a distance but no pole";
            const double expected = distance(site(s), vertex(static_cast<std::size_t>(pole[s]))) + at_pole(s);
            if (std::fabs(geodesic[s] - expected) <= kSingle * expected) return std::string();
            return site_text(s) + " has " + short_text(geodesic[s]) + ", its pole " + short_text(expected) +
                   " by eq. 7";
        });
        if (inspection_.are_sound({&names::kGeodesic, &names::kTangencyDeviation})) {
            const Numbers& deviation = inspection_.numbers(names::kTangencyDeviation);
            inspection_.all_hold(names::kTangencyDeviation.path, deviation.size(), [&](std::size_t s) {
                if (!has_way(s))
                    return std::isnan(deviation[s]) ? std::string() : site_text(s) + " has no way, but a value";
                const double expected = geodesic[s] > 0 ? at_pole(s) / geodesic[s] : 0;
                if (std::fabs(deviation[s] - expected) <= kSingle) return std::string();
                return site_text(s) + " has " + short_text(deviation[s]) + ", by eq. 8 it is " + short_text(expected);
            });
        }
        if (!inspection_.are_sound({&names::kEuclidean, &names::kCenterlinePoint})) return;
        const Numbers &straight = inspection_.numbers(names::kEuclidean),
                      &end = inspection_.numbers(names::kCenterlinePoint);
        inspection_.all_hold(names::kEuclidean.path, straight.size(), [&](std::size_t s) {
            if (std::isnan(straight[s])) return std::string();
            const double expected = distance(site(s), point_at(end, s));
            const double slack = kSingle * expected + kMergedRoundings * rounding_;
            if (std::fabs(straight[s] - expected) <= slack) return std::string();
            return site_text(s) + " has " + short_text(straight[s]) + ", its centerline_point is at " +
                   short_text(expected);
        });
    }

    /// D_e is at most the way over the pole.
    void check_bound() {
        if (!inspection_.are_sound(
                {&names::kEuclidean, &names::kDescentLength, &names::kPole, &names::kVertices, &names::kSurfacePoints}))
            return;
        const Numbers &straight = inspection_.numbers(names::kEuclidean),
                      &descent = inspection_.numbers(names::kDescentLength), &pole = inspection_.numbers(names::kPole);
        inspection_.all_hold(names::kDescentLength.path, straight.size(), [&](std::size_t s) {
            if (std::isnan(straight[s]) || pole[s] < 0) return std::string();
            const double way = distance(site(s), vertex(static_cast<std::size_t>(pole[s]))) + descent[s];
            if (straight[s] <= way * (1 + kSingle) + kMergedRoundings * rounding_) return std::string();
            return site_text(s) + " has a way of " + short_text(way) + " to a point at " + short_text(straight[s]);
        });
    }

    /// |T~(x) - T~(y)| <= |x - y| along each edge (eq. 6).
    void check_triangle_inequality() {
        if (!is_complex_sound() || !inspection_.is_sound(names::kCenterlineDistance.path)) return;
        const Numbers& along = inspection_.numbers(names::kCenterlineDistance);
        const std::size_t polygons = inspection_.length('P');
        inspection_.all_hold(names::kCenterlineDistance.path, polygons, [&](std::size_t p) {
            const auto [first, last] = polygon(p);
            for (std::size_t i = first; i < last; ++i) {
                const std::size_t a = corner(i), b = corner(i + 1 < last ? i + 1 : first);
                if (!std::isfinite(along[a]) || !std::isfinite(along[b])) continue;
                const double slack = kMarchShare * radius(a) + kSingle * along[a];
                if (std::fabs(along[a] - along[b]) > distance(vertex(a), vertex(b)) + slack)
                    return "between the vertices " + std::to_string(a) + " and " + std::to_string(b) +
                           " it changes by more than their distance";
            }
            return std::string();
        });
    }

    Inspection& inspection_;
    double rounding_ = 0;
};

}  // namespace

void check_complex(Inspection& inspection) { Complex(inspection).check(); }

}  // namespace lumenline
