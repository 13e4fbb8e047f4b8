// Each check goes back to the surface, the complex or the endpoints, and takes nothing from the stage that it
// checks. Tolerances are relative to the model's size or to the ball at hand: 1e-9 of the diagonal is what sums of
// a few thousand doubles may lose; balls also move by the rounding of the file's coordinates.
#include "tests/examples/promises.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

#include "engine/geometry/inside_test.h"
#include "engine/geometry/surface_distance.h"

namespace lumenline::examples {

namespace {

constexpr double kRounding = 1e-9;       // of the diagonal
constexpr double kResidual = 1e-6;       // of an arrival time
constexpr double kReachedPoles = 0.995;  // of the wall's sites

/// Collects sentences, at most three of a kind.
class Findings {
public:
    template <class... Parts>
    void require(bool kept, const std::string& promise, const Parts&... parts) {
        if (kept || ++count_[promise] > 3) return;
        std::ostringstream text;
        text.precision(17);
        text << promise;
        ((text << ' ' << parts), ...);
        broken_.push_back(text.str());
    }
    Broken take() { return std::move(broken_); }

private:
    std::map<std::string, int> count_;
    Broken broken_;
};

/// Component of each site, by the smallest site in it.
std::vector<std::uint32_t> components(const Surface& surface) {
    std::vector<std::uint32_t> parent(surface.site_count());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](std::uint32_t s) {
        while (parent[s] != s) s = parent[s] = parent[parent[s]];
        return s;
    };
    for (const auto& t : surface.triangles)
        for (const SiteId s : {t[1], t[2]}) {
            const std::uint32_t a = root(t[0].value), b = root(s.value);
            parent[std::max(a, b)] = std::min(a, b);
        }
    for (std::uint32_t s = 0; s < parent.size(); ++s) parent[s] = root(s);
    return parent;
}

void check_end(Findings& findings, Vec3 p, const Endpoint& end, double slack, std::size_t line, const char* which) {
    if (end.opening.is_none()) {
        findings.require(distance(p, end.anchor) <= slack, "the line does not end at the anchor:", line, which);
        findings.require(distance(end.anchor, end.point) <= end.anchor_radius,
                         "the anchor's ball does not hold the point:", line, which, distance(end.anchor, end.point),
                         end.anchor_radius);
    } else {
        findings.require(std::fabs(dot(p - end.point, end.normal)) <= slack,
                         "the line does not end in the plane:", line, which);
        findings.require(distance(p, end.point) <= end.radius, "the line ends outside of the opening:", line, which,
                         distance(p, end.point), end.radius);
    }
}

bool is_partition(const std::vector<std::uint32_t>& offsets, std::size_t lines, std::size_t values) {
    return offsets.size() == lines + 1 && offsets.front() == 0 && offsets.back() == values &&
           std::is_sorted(offsets.begin(), offsets.end());
}

Vec3 nearest_on_axis(const AxisTruth& truth, Vec3 p, double& radius) {
    Vec3 best = truth.points.front();
    radius = truth.radius.front();
    for (std::size_t i = 1; i < truth.points.size(); ++i) {
        const Vec3 a = truth.points[i - 1], e = truth.points[i] - a;
        const double t = std::clamp(dot(p - a, e) / squared_norm(e), 0.0, 1.0);
        const Vec3 q = a + t * e;
        if (squared_norm(q - p) >= squared_norm(best - p) && i > 1) continue;
        best = q;
        radius = std::lerp(truth.radius[i - 1], truth.radius[i], t);
    }
    return best;
}

}  // namespace

Broken check_surface(const Surface& surface) {
    Findings findings;
    std::map<std::pair<SiteId, SiteId>, int> edges;
    for (const auto& t : surface.triangles)
        for (int k = 0; k < 3; ++k) ++edges[{t[static_cast<std::size_t>(k)], t[static_cast<std::size_t>((k + 1) % 3)]}];
    for (const auto& [edge, count] : edges) {
        findings.require(count == 1, "edge used twice in one direction:", edge.first.value, edge.second.value);
        findings.require(edges.contains({edge.second, edge.first}), "open edge:", edge.first.value, edge.second.value);
    }
    const bool wall_first = std::is_partitioned(surface.origin.begin(), surface.origin.end(),
                                                [](SiteOrigin o) { return o == SiteOrigin::kWall; });
    findings.require(wall_first, "the wall's sites do not come first");
    return findings.take();
}

Broken check_counts(const Centerlines& lines, const Endpoints& endpoints) {
    Findings findings;
    const auto outlets = std::count_if(endpoints.begin(), endpoints.end(),
                                       [](const Endpoint& e) { return e.role == EndpointRole::kOutlet; });
    findings.require(lines.line_count() == static_cast<std::size_t>(outlets), "lines and outlets:", lines.line_count(),
                     outlets);
    findings.require(is_partition(lines.offsets, lines.line_count(), lines.points.size()), "offsets of the lines");
    findings.require(is_partition(lines.path.offsets, lines.line_count(), lines.path.points.size()),
                     "offsets of the paths");
    for (const auto* values : {&lines.ball_radius, &lines.clearance, &lines.radius, &lines.abscissa}) {
        findings.require(values->size() == lines.points.size(), "values per point:", values->size());
        for (const double v : *values) findings.require(std::isfinite(v) && v >= 0, "value of a line:", v);
    }
    std::set<EndpointId> targets;
    for (std::size_t line = 0; line < lines.line_count(); ++line) {
        findings.require(endpoints[at(lines.source[line])].role == EndpointRole::kInlet, "source is no inlet:", line);
        findings.require(endpoints[at(lines.target[line])].role == EndpointRole::kOutlet, "target is no outlet:", line);
        findings.require(targets.insert(lines.target[line]).second, "a second line to the same target:", line);
    }
    return findings.take();
}

Broken check_abscissa(const Centerlines& lines) {
    Findings findings;
    for (std::size_t line = 0; line < lines.line_count(); ++line) {
        const std::size_t first = lines.offsets[line], last = lines.offsets[line + 1];
        findings.require(last - first >= 2, "line of fewer than two points:", line);
        findings.require(lines.abscissa[first] == 0, "abscissa does not start at 0:", line);
        for (std::size_t i = first + 1; i < last; ++i) {
            const double step = lines.abscissa[i] - lines.abscissa[i - 1];
            const double chord = distance(lines.points[i], lines.points[i - 1]);
            findings.require(step > 0, "abscissa does not increase:", line, i, step);
            findings.require(std::fabs(step - chord) <= kRounding * lines.abscissa[last - 1], "step and chord:", line,
                             i, step, chord);
        }
    }
    return findings.take();
}

Broken check_ends(const Centerlines& lines, const Endpoints& endpoints, const Surface& surface) {
    Findings findings;
    const double slack = kRounding * surface.diagonal;
    for (std::size_t line = 0; line < lines.line_count(); ++line) {
        check_end(findings, lines.points[lines.offsets[line]], endpoints[at(lines.source[line])], slack, line,
                  "source");
        check_end(findings, lines.points[lines.offsets[line + 1] - 1], endpoints[at(lines.target[line])], slack, line,
                  "target");
    }
    return findings.take();
}

Broken check_balls(const Centerlines& lines, const Surface& surface) {
    Findings findings;
    const InsideTest inside(surface.points, surface.triangles);
    const SurfaceDistance wall(surface.points, surface.triangles);
    const auto corner = [&](TriangleId t, std::size_t k) { return surface.points[at(surface.triangles[at(t)][k])]; };
    SurfaceDistance::Nearest last{0, corner(TriangleId(0), 0), TriangleId(0)};
    for (std::size_t i = 0; i < lines.points.size(); ++i) {
        const Vec3 p = lines.points[i];
        last = wall.nearest(p, last.point, last.triangle);
        const double r = lines.ball_radius[i], c = last.distance;
        const double rho =
            covering_radius(corner(last.triangle, 0), corner(last.triangle, 1), corner(last.triangle, 2));
        // Voronoi vertices closer than 64 roundings of the input become one, and both ends of an edge can have moved.
        const double slack = 1e-6 * r + 2 * std::min(64 * surface.coordinate_rounding, 1e-3 * r);
        findings.require(inside.inside(p), "point outside of the lumen:", i, p.x, p.y, p.z);
        findings.require(std::fabs(lines.clearance[i] - c) <= kRounding * surface.diagonal, "clearance:", i,
                         lines.clearance[i], c);
        findings.require(c <= r + slack, "ball smaller than the clearance:", i, r, c);
        findings.require(r <= std::hypot(c, rho) + slack, "ball reaches too far beyond the wall:", i, r, c, rho);
    }
    return findings.take();
}

Broken check_paths(const Centerlines& lines) {
    Findings findings;
    const PathLines& path = lines.path;
    for (std::size_t line = 0; line < lines.line_count(); ++line) {
        const std::size_t first = path.offsets[line], last = path.offsets[line + 1];
        const double length = lines.abscissa[lines.offsets[line + 1] - 1];
        findings.require(path.line_abscissa[first] == 0, "map does not start at 0:", line);
        findings.require(std::fabs(path.line_abscissa[last - 1] - length) <= kRounding * length,
                         "map does not end at the length:", line, path.line_abscissa[last - 1], length);
        for (std::size_t i = first + 1; i < last; ++i) {
            findings.require(path.line_abscissa[i] >= path.line_abscissa[i - 1], "map falls:", line, i);
            findings.require(path.abscissa[i] > path.abscissa[i - 1], "path abscissa does not increase:", line, i);
        }
    }
    return findings.take();
}

Broken check_field(const ArrivalField& field, const VoronoiComplex& complex) {
    Findings findings;
    findings.require(field.time.size() == complex.vertex_count(), "times and vertices:", field.time.size());
    std::size_t reached = 0;
    for (const double t : field.time) {
        findings.require(t >= 0, "time is negative or no number:", t);
        reached += std::isfinite(t) ? 1 : 0;
    }
    findings.require(reached == field.reached, "reached vertices:", reached, field.reached);
    findings.require(field.residual >= 0 && field.residual <= kResidual, "residual:", field.residual);
    return findings.take();
}

Broken check_poles(const ModelRecord& record) {
    Findings findings;
    const Surface& surface = *record.surface;
    const VoronoiComplex& complex = *record.complex;
    const std::vector<std::uint32_t> component = components(surface);
    std::set<std::uint32_t> with_source;
    for (const Endpoint& e : *record.endpoints)
        if (e.role == EndpointRole::kInlet) with_source.insert(component[at(complex.vertex_site[at(e.anchor_vertex)])]);
    std::size_t wall = 0, reached = 0;
    for (std::size_t s = 0; s < surface.site_count(); ++s) {
        if (surface.origin[s] != SiteOrigin::kWall || !with_source.contains(component[s])) continue;
        ++wall;
        const VoronoiVertexId pole = complex.pole[s];
        reached += !pole.is_none() && std::any_of(record.fields.begin(), record.fields.end(), [&](const auto& field) {
            return std::isfinite(field->time[at(pole)]);
        });
    }
    findings.require(wall > 0 && static_cast<double>(reached) >= kReachedPoles * static_cast<double>(wall),
                     "wall sites with a reached pole:", reached, "of", wall);
    return findings.take();
}

Broken check_model(const ModelRecord& record) {
    if (record.failure) return {"failed: " + record.failure->sentence};
    Broken all;
    const auto add = [&](const Broken& more) { all.insert(all.end(), more.begin(), more.end()); };
    add(check_surface(*record.surface));
    add(check_counts(*record.centerlines, *record.endpoints));
    if (!all.empty()) return all;  // the others rely on the arrays' lengths
    add(check_abscissa(*record.centerlines));
    add(check_ends(*record.centerlines, *record.endpoints, *record.surface));
    add(check_balls(*record.centerlines, *record.surface));
    add(check_paths(*record.centerlines));
    if (record.fields.empty()) all.emplace_back("no arrival times");
    for (const auto& field : record.fields) add(check_field(*field, *record.complex));
    add(check_poles(record));
    return all;
}

TruthErrors compare_with_truth(const Centerlines& lines, const AxisTruth& truth) {
    TruthErrors errors;
    const std::size_t count = lines.offsets[1];
    double weights = 0;
    for (std::size_t i = 0; i < count; ++i) {
        double radius = 0;
        const double away = distance(nearest_on_axis(truth, lines.points[i], radius), lines.points[i]);
        const double wrong = std::fabs(lines.radius[i] - radius);
        const double before = lines.abscissa[i == 0 ? 0 : i - 1], after = lines.abscissa[std::min(i + 1, count - 1)];
        const double weight = (after - before) / 2;
        errors.mean_distance += weight * away;
        errors.mean_radius += weight * wrong;
        errors.max_distance = std::max(errors.max_distance, away);
        errors.max_radius = std::max(errors.max_radius, wrong);
        weights += weight;
    }
    errors.mean_distance /= weights;
    errors.mean_radius /= weights;
    errors.length = std::fabs(lines.abscissa[count - 1] - truth.abscissa.back());
    return errors;
}

}  // namespace lumenline::examples
