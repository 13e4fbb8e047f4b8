// Centerlines of one surface by the library's stages, without scheduler, configuration or archive.
//
//     cmake_minimum_required(VERSION 3.25)
//     project(OneModel LANGUAGES C CXX)
//     find_package(Lumenline REQUIRED)
//     add_executable(one_model one_model.cpp)
//     target_link_libraries(one_model PRIVATE Lumenline::lumenline_stages Lumenline::lumenline_io)
//
// What links the stages is under the terms of the GPL-3, since they use packages of CGAL that are.
#include <cstdio>
#include <exception>
#include <memory>

#include "engine/characterize/characterize.h"
#include "engine/condition/condition.h"
#include "engine/core/options.h"
#include "engine/eikonal/eikonal.h"
#include "engine/endpoints/endpoints.h"
#include "engine/trace/trace.h"
#include "engine/voronoi/voronoi.h"
#include "io/mesh/mesh_io.h"

using namespace lumenline;

namespace {

void print_lines(const char* path) {
    const PipelineOptions options;
    StageContext context(Stage::kLoad);  // serial; gathers what the stages find

    const TriangleSoup soup = read_surface(path);
    const Surface surface = condition_surface(soup, options.condition, context);
    const VoronoiComplex complex = build_voronoi(surface, options.voronoi, context);
    const Endpoints endpoints = find_endpoints(surface, complex, options.endpoints, context);

    EikonalWorkspace work;
    ArrivalField field = solve_eikonal(complex, endpoints.front().seeds, work, context);  // from the inlet
    field.source = EndpointId(std::size_t{0});
    const std::vector fields{std::make_shared<const ArrivalField>(std::move(field))};

    const Centerlines lines = trace_centerlines(surface, complex, endpoints, fields, options.trace, context);
    const SurfaceCharacter character = characterize_surface(surface, complex, endpoints, lines, context);

    for (std::size_t line = 0; line < lines.line_count(); ++line) {
        const std::size_t first = lines.offsets[line], last = lines.offsets[line + 1] - 1;
        std::printf("line %zu: length %.4g, radius %.4g to %.4g\n", line, lines.abscissa[last], lines.radius[first],
                    lines.radius[last]);
    }
    std::printf("tangency deviation, mean over the wall: %.4g\n",
                character.normalized_tangency_deviation_statistics.mean);
    for (const Diagnostic& finding : context.diagnostics()) std::printf("%s\n", finding.message.c_str());
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: one_model SURFACE\n");
        return 2;
    }
    try {
        print_lines(argv[1]);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "one_model: %s\n", error.what());
        return 1;
    }
}
