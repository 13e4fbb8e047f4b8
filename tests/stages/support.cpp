// Surfaces are assembled from phantoms with caps, so that the stages after conditioning are tested
// on input that engine/condition has not touched. Normals are weighted by angle, as Surface wants.
#include "tests/stages/support.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/eikonal/eikonal.h"
#include "engine/endpoints/endpoints.h"
#include "engine/schedule/model_job.h"
#include "engine/trace/trace.h"
#include "engine/voronoi/voronoi.h"

namespace lumenline::test {

namespace {

void finish_surface(Surface& surface) {
    surface.normals.assign(surface.points.size(), Vec3{});
    std::vector<double> edges;
    for (const auto& t : surface.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 p = surface.points[at(t[k])];
            const Vec3 u = surface.points[at(t[(k + 1) % 3])] - p, v = surface.points[at(t[(k + 2) % 3])] - p;
            const Vec3 n = cross(u, v);
            surface.normals[at(t[k])] += std::atan2(norm(n), dot(u, v)) * normalized(n);
            edges.push_back(norm(u));
        }
    for (Vec3& n : surface.normals) n = normalized(n);
    surface.origin.assign(surface.points.size(), SiteOrigin::kWall);
    surface.cap.assign(surface.triangles.size(), OpeningId());
    std::nth_element(edges.begin(), edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2), edges.end());
    surface.median_edge = edges[edges.size() / 2];
    Vec3 low = surface.points.front(), high = low;
    for (const Vec3& p : surface.points)
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    surface.diagonal = distance(low, high);
}

double distance_to_segment(Vec3 x, Vec3 a, Vec3 b) {
    const Vec3 e = b - a;
    const double e2 = squared_norm(e);
    return distance(x, e2 > 0 ? lerp(a, b, std::clamp(dot(x - a, e) / e2, 0.0, 1.0)) : a);
}

}  // namespace

Vec3 Random::direction() {
    const double z = uniform(-1, 1), angle = uniform(-std::numbers::pi, std::numbers::pi);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

PhantomOptions capped_options(PhantomKind kind, double jitter, int points_around, double length) {
    PhantomOptions options;
    options.kind = kind;
    options.points_around = points_around;
    options.jitter = jitter;
    options.length = length;
    options.leg_length = 15;
    if (kind == PhantomKind::kHairpin) options.bend_radius = 7;
    options.caps = true;
    options.rotate = true;
    return options;
}

Surface closed_surface(const Phantom& capped) {
    Surface surface;
    surface.points = capped.points;
    for (std::size_t i = 0; i < capped.points.size(); ++i)
        surface.input_vertex.push_back(static_cast<std::uint32_t>(i));
    for (const auto& t : capped.triangles) surface.triangles.push_back({SiteId(t[0]), SiteId(t[1]), SiteId(t[2])});
    surface.coordinate_rounding = to_soup(capped).coordinate_rounding;
    finish_surface(surface);
    return surface;
}

Surface disjoint_union(const Surface& a, const Surface& b) {
    Surface surface = a;
    surface.points.insert(surface.points.end(), b.points.begin(), b.points.end());
    surface.input_vertex.insert(surface.input_vertex.end(), b.input_vertex.begin(), b.input_vertex.end());
    for (auto t : b.triangles) {
        for (SiteId& s : t) s = SiteId(at(s) + a.points.size());
        surface.triangles.push_back(t);
    }
    surface.coordinate_rounding = std::max(a.coordinate_rounding, b.coordinate_rounding);
    surface.component_count = a.component_count + b.component_count;
    finish_surface(surface);
    return surface;
}

VoronoiComplex complex_of(const Surface& surface, double merge_tolerance) {
    StageContext context(Stage::kVoronoi);
    return build_voronoi(surface, {merge_tolerance}, context);
}

Endpoints endpoints_at(const Surface& surface, const VoronoiComplex& complex, const std::vector<Vec3>& inlets,
                       const std::vector<Vec3>& outlets) {
    StageContext context(Stage::kEndpoints);
    return find_endpoints(surface, complex, {EndpointMode::kPoints, inlets, outlets}, context);
}

ArrivalField field_of(const VoronoiComplex& complex, std::span<const Seed> seeds) {
    StageContext context(Stage::kEikonal);
    EikonalWorkspace work;
    return solve_eikonal(complex, seeds, work, context);
}

Traced trace_closed(const Surface& surface, const std::vector<Vec3>& inlets, const std::vector<Vec3>& outlets,
                    const TraceOptions& options) {
    Traced traced;
    traced.complex = complex_of(surface);
    traced.endpoints = endpoints_at(surface, traced.complex, inlets, outlets);
    for (std::size_t i = 0; i < inlets.size(); ++i) {
        ArrivalField field = field_of(traced.complex, traced.endpoints[i].seeds);
        field.source = EndpointId(i);
        traced.fields.push_back(std::make_shared<const ArrivalField>(std::move(field)));
    }
    StageContext context(Stage::kTrace);
    traced.lines = trace_centerlines(surface, traced.complex, traced.endpoints, traced.fields, options, context);
    traced.findings = context.diagnostics();
    return traced;
}

ModelRecord run_pipeline(const TriangleSoup& soup, const PipelineOptions& options) {
    ModelTask task;
    task.identity.id = "phantom";
    task.options = options;
    return process_model(task, [&soup](const ModelTask&) { return soup; });
}

PipelineOptions from_start_to_end(const PhantomTruth& truth) {
    PipelineOptions options;
    options.condition.refine_undersampled = false;  // the mesh as it is
    options.endpoints.inlets = {truth.position(0)};
    options.endpoints.outlets = {truth.position(truth.total_length())};
    return options;
}

double distance_to_triangle(Vec3 x, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 n = cross(b - a, c - a);
    const bool above =
        dot(cross(b - a, x - a), n) >= 0 && dot(cross(c - b, x - b), n) >= 0 && dot(cross(a - c, x - c), n) >= 0;
    if (above && squared_norm(n) > 0) return std::fabs(dot(x - a, normalized(n)));
    return std::min({distance_to_segment(x, a, b), distance_to_segment(x, b, c), distance_to_segment(x, c, a)});
}

double distance_between_lines(std::span<const Vec3> a, std::span<const Vec3> b) {
    double largest = 0;
    for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}})
        for (const Vec3& x : from) {
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t i = 0; i + 1 < to.size(); ++i)
                least = std::min(least, distance_to_segment(x, to[i], to[i + 1]));
            largest = std::max(largest, least);
        }
    return largest;
}

bool has_finding(const Diagnostics& diagnostics, std::string_view code) {
    return std::any_of(diagnostics.begin(), diagnostics.end(), [&](const Diagnostic& d) { return d.code == code; });
}

}  // namespace lumenline::test
