#include "bench/pipeline.h"

#include <algorithm>
#include <stdexcept>

#include "engine/branches/branches.h"
#include "engine/characterize/characterize.h"
#include "engine/condition/condition.h"
#include "engine/core/text.h"
#include "engine/eikonal/eikonal.h"
#include "engine/endpoints/endpoints.h"
#include "engine/trace/trace.h"
#include "engine/voronoi/voronoi.h"

namespace lumenline::bench {

namespace {

constexpr double kResidual = 1e-6;  // the march stops at improvements of 1e-7 of the time; updates add a few of them

void verify_axis(const Input& input, const Centerlines& lines) {
    double worst = 0;
    for (const Vec3& p : lines.points) worst = std::max(worst, input.truth->distance_to_axis(p));
    if (!(worst <= input.edge_length))
        throw std::runtime_error(input.name + ": a line is " + short_text(worst) + " off the axis, more than an edge");
}

}  // namespace

Surface condition(const Input& input) {
    StageContext context(Stage::kCondition);
    return condition_surface(input.soup, input.options.condition, context);
}

VoronoiComplex voronoi(const Surface& surface, const PipelineOptions& options) {
    StageContext context(Stage::kVoronoi);
    return build_voronoi(surface, options.voronoi, context);
}

Endpoints endpoints(const Surface& surface, const VoronoiComplex& complex, const PipelineOptions& options) {
    StageContext context(Stage::kEndpoints);
    return find_endpoints(surface, complex, options.endpoints, context);
}

Fields eikonal(const VoronoiComplex& complex, const Endpoints& ends) {
    StageContext context(Stage::kEikonal);
    EikonalWorkspace work;
    Fields fields;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        if (ends[i].role != EndpointRole::kInlet) continue;
        ArrivalField field = solve_eikonal(complex, ends[i].seeds, work, context);
        field.source = EndpointId(i);
        fields.push_back(std::make_shared<const ArrivalField>(std::move(field)));
    }
    return fields;
}

Centerlines trace(const Surface& surface, const Solved& solved, const PipelineOptions& options) {
    StageContext context(Stage::kTrace);
    return trace_centerlines(surface, solved.complex, solved.endpoints, solved.fields, options.trace, context);
}

SurfaceCharacter characterize(const Surface& surface, const Solved& solved) {
    StageContext context(Stage::kCharacterize);
    return characterize_surface(surface, solved.complex, solved.endpoints, solved.lines, context);
}

Branches branches(const Surface& surface, const Solved& solved, const PipelineOptions& options) {
    StageContext context(Stage::kBranches);
    return find_branches(surface, solved.lines, &solved.character, options.branches, context);
}

Solved solve(const Surface& surface, const PipelineOptions& options) {
    Solved solved;
    solved.complex = voronoi(surface, options);
    solved.endpoints = endpoints(surface, solved.complex, options);
    solved.fields = eikonal(solved.complex, solved.endpoints);
    solved.lines = trace(surface, solved, options);
    return solved;
}

void verify(const Input& input, const Solved& solved) {
    const auto outlets = std::count_if(solved.endpoints.begin(), solved.endpoints.end(),
                                       [](const Endpoint& e) { return e.role == EndpointRole::kOutlet; });
    if (outlets == 0 || solved.lines.line_count() != static_cast<std::size_t>(outlets))
        throw std::runtime_error(input.name + ": " + counted(solved.lines.line_count(), "line") + " for " +
                                 counted(static_cast<std::size_t>(outlets), "outlet"));
    for (const auto& field : solved.fields)
        if (!(field->residual <= kResidual))
            throw std::runtime_error(input.name + ": residual " + short_text(field->residual) + " of an arrival field");
    if (static_cast<double>(solved.character.unreached) > 0.005 * static_cast<double>(solved.character.wall_sites))
        throw std::runtime_error(input.name + ": " + counted(solved.character.unreached, "site") +
                                 " of the wall without a centerline");
    if (input.truth) verify_axis(input, solved.lines);
}

}  // namespace lumenline::bench
