#include "tests/condition/shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>

#include "engine/condition/condition.h"
#include "engine/condition/crossings.h"

namespace lumenline::testing {

using std::numbers::pi;

TriangleSoup tube(std::size_t around, std::size_t rings, const TubePoint& point) {
    TriangleSoup soup;
    for (std::size_t k = 0; k < rings; ++k)
        for (std::size_t i = 0; i < around; ++i) soup.points.push_back(point(i, k));
    const auto at = [&](std::size_t i, std::size_t k) { return static_cast<std::uint32_t>(k * around + i % around); };
    for (std::size_t k = 0; k + 1 < rings; ++k) {
        for (std::size_t i = 0; i < around; ++i) {
            soup.triangles.push_back({at(i, k), at(i + 1, k), at(i, k + 1)});
            soup.triangles.push_back({at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)});
        }
    }
    return soup;
}

TriangleSoup round_tube(std::size_t around, std::size_t rings, double radius, double length) {
    return tube(around, rings, [=](std::size_t i, std::size_t k) {
        const double angle = 2 * pi * static_cast<double>(i) / static_cast<double>(around);
        const double z = length * static_cast<double>(k) / static_cast<double>(rings - 1);
        return Vec3{radius * std::cos(angle), radius * std::sin(angle), z};
    });
}

TriangleSoup swept_tube(std::size_t around, const std::vector<Vec3>& path) {
    return tube(around, path.size(), [&](std::size_t i, std::size_t k) {
        const Vec3 before = path[k == 0 ? 0 : k - 1], after = path[std::min(k + 1, path.size() - 1)];
        const Vec3 tangent = normalized(after - before), u{0, 1, 0}, v = cross(tangent, u);
        const double angle = 2 * pi * static_cast<double>(i) / static_cast<double>(around);
        return path[k] + std::cos(angle) * u + std::sin(angle) * v;
    });
}

TriangleSoup cube(std::size_t n, Vec3 centre, double half_side) {
    TriangleSoup soup;
    std::map<std::array<std::size_t, 3>, std::uint32_t> numbers;
    const auto vertex = [&](std::array<std::size_t, 3> g) {
        const auto [place, fresh] = numbers.try_emplace(g, static_cast<std::uint32_t>(soup.points.size()));
        const auto x = [&](std::size_t i) {
            return half_side * (2.0 * static_cast<double>(i) / static_cast<double>(n) - 1);
        };
        if (fresh) soup.points.push_back(centre + Vec3{x(g[0]), x(g[1]), x(g[2])});
        return place->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const bool high : {false, true}) {
            for (std::size_t i = 0; i < n; ++i) {
                for (std::size_t j = 0; j < n; ++j) {
                    const auto corner = [&](std::size_t di, std::size_t dj) {
                        std::array<std::size_t, 3> g{};
                        g[axis] = high ? n : 0;
                        g[(axis + 1) % 3] = i + di;
                        g[(axis + 2) % 3] = j + dj;
                        return vertex(g);
                    };
                    std::array<std::uint32_t, 3> s{corner(0, 0), corner(1, 0), corner(1, 1)};
                    std::array<std::uint32_t, 3> t{corner(0, 0), corner(1, 1), corner(0, 1)};
                    if (!high) {
                        std::swap(s[1], s[2]);
                        std::swap(t[1], t[2]);
                    }
                    soup.triangles.push_back(s);
                    soup.triangles.push_back(t);
                }
            }
        }
    }
    return soup;
}

TriangleSoup tetrahedron(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    TriangleSoup soup;
    soup.points = {a, b, c, d};
    soup.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    return soup;
}

TriangleSoup merged(const TriangleSoup& a, const TriangleSoup& b) {
    TriangleSoup soup = a;
    const auto shift = static_cast<std::uint32_t>(a.points.size());
    soup.points.insert(soup.points.end(), b.points.begin(), b.points.end());
    for (const auto& t : b.triangles) soup.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    return soup;
}

TriangleSoup exploded(const TriangleSoup& soup) {
    TriangleSoup loose;
    for (const auto& t : soup.triangles) {
        const auto first = static_cast<std::uint32_t>(loose.points.size());
        for (const std::uint32_t v : t) loose.points.push_back(soup.points[v]);
        loose.triangles.push_back({first, first + 1, first + 2});
    }
    return loose;
}

TriangleSoup mapped(TriangleSoup soup, const std::function<Vec3(Vec3)>& map) {
    for (Vec3& p : soup.points) p = map(p);
    return soup;
}

TriangleSoup shuffled(const TriangleSoup& soup, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::uint32_t> place(soup.points.size());
    std::iota(place.begin(), place.end(), 0U);
    std::shuffle(place.begin(), place.end(), random);
    TriangleSoup other = soup;
    for (std::size_t v = 0; v < place.size(); ++v) other.points[place[v]] = soup.points[v];
    for (auto& t : other.triangles) {
        for (auto& v : t) v = place[v];
        std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(random() % 3), t.end());
    }
    std::shuffle(other.triangles.begin(), other.triangles.end(), random);
    return other;
}

std::size_t Conditioned::count(const std::string& code) const {
    return static_cast<std::size_t>(
        std::count_if(diagnostics.begin(), diagnostics.end(), [&](const Diagnostic& d) { return d.code == code; }));
}

double Conditioned::value(const std::string& code) const {
    const auto found =
        std::find_if(diagnostics.begin(), diagnostics.end(), [&](const Diagnostic& d) { return d.code == code; });
    return found == diagnostics.end() ? 0 : found->value;
}

std::size_t Conditioned::warnings() const {
    return static_cast<std::size_t>(std::count_if(diagnostics.begin(), diagnostics.end(),
                                                  [](const Diagnostic& d) { return d.severity != Severity::kNote; }));
}

Conditioned condition(const TriangleSoup& soup, const ConditionOptions& options) {
    StageContext context(Stage::kCondition);
    Conditioned result;
    result.surface = condition_surface(soup, options, context);
    result.diagnostics = context.diagnostics();
    return result;
}

Conditioned condition(const TriangleSoup& soup, double extension_radii, double weld_tolerance) {
    ConditionOptions options;
    options.extension_radii = extension_radii;
    options.weld_tolerance = weld_tolerance;
    options.refine_undersampled = false;
    return condition(soup, options);
}

std::string refusal(const TriangleSoup& soup, const ConditionOptions& options) {
    try {
        condition(soup, options);
    } catch (const StageError& e) {
        return e.stage() == Stage::kCondition ? std::string(error_name(e.code())) : "wrong stage";
    }
    return "";
}

std::string refusal(const TriangleSoup& soup, double weld_tolerance, std::string* sentence) {
    try {
        condition(soup, 1.2, weld_tolerance);
    } catch (const StageError& e) {
        if (sentence != nullptr) *sentence = e.what();
        return e.stage() == Stage::kCondition ? std::string(error_name(e.code())) : "wrong stage";
    }
    return "";
}

bool is_closed_manifold(const Surface& surface) {
    std::map<std::pair<SiteId, SiteId>, SiteId> third;  // of the triangle on a directed edge
    std::vector<std::size_t> valence(surface.site_count(), 0);
    for (const auto& t : surface.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (!third.try_emplace({t[k], t[(k + 1) % 3]}, t[(k + 2) % 3]).second) return false;
            ++valence[at(t[k])];
        }
    }
    for (const auto& [edge, apex] : third)
        if (third.count({edge.second, edge.first}) == 0) return false;
    std::vector<char> seen(surface.site_count(), 0);
    for (const auto& t : surface.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (std::exchange(seen[at(t[k])], 1)) continue;
            std::size_t turns = 0;
            SiteId spoke = t[(k + 1) % 3];
            do {
                spoke = third.at({t[k], spoke});
                ++turns;
            } while (spoke != t[(k + 1) % 3]);
            if (turns != valence[at(t[k])]) return false;
        }
    }
    return std::all_of(seen.begin(), seen.end(), [](char c) { return c != 0; });
}

double volume(const Surface& surface) {
    const Vec3 o = surface.points.front();
    double sum = 0;
    for (const auto& t : surface.triangles)
        sum += dot(surface.points[at(t[0])] - o, cross(surface.points[at(t[1])] - o, surface.points[at(t[2])] - o)) / 6;
    return sum;
}

int euler_characteristic(const Surface& surface) {
    return static_cast<int>(surface.site_count()) - static_cast<int>(surface.triangles.size() / 2);
}

std::size_t crossings(const Surface& surface) {
    std::vector<Corners> triangles;
    for (const auto& t : surface.triangles) triangles.push_back({t[0].value, t[1].value, t[2].value});
    return crossing_triangles(surface.points, triangles, 1000000).size();
}

std::size_t count_origin(const Surface& surface, SiteOrigin origin) {
    return static_cast<std::size_t>(std::count(surface.origin.begin(), surface.origin.end(), origin));
}

std::size_t largest_valence(const Surface& surface, SiteOrigin origin) {
    std::vector<std::size_t> valence(surface.site_count(), 0);
    for (const auto& t : surface.triangles)
        for (const SiteId s : t) ++valence[at(s)];
    std::size_t largest = 0;
    for (std::size_t s = 0; s < valence.size(); ++s)
        if (surface.origin[s] == origin) largest = std::max(largest, valence[s]);
    return largest;
}

double regular_polygon_radius(std::size_t n, double radius) {
    const auto sides = static_cast<double>(n);
    return radius * std::sqrt(sides / 2 * std::sin(2 * pi / sides) / pi);
}

}  // namespace lumenline::testing
