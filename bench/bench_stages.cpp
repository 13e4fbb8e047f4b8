// Every stage beside the bare Delaunay triangulation of the same sites. Both are timed in each
// iteration, one after the other, so that what the machine does besides strikes both: the ratio of
// the pair is the figure, the median of the pairs what is reported. The answer of the whole pipeline
// is verified before anything is timed, and each timed result must equal the verified one.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bench/bare_delaunay.h"
#include "bench/inputs.h"
#include "bench/measure.h"
#include "bench/pipeline.h"
#include "engine/voronoi/delaunay.h"
#include "engine/voronoi/inside_cells.h"
#include "engine/voronoi/polygons.h"

namespace lumenline::bench {

namespace {

/// An input with the verified results of all stages.
struct Model {
    Surface surface;
    Tetrahedra tetrahedra;
    InsideCells cells;
    MergedVertices merged;
    Solved solved;
};

MergedVertices merge(const Surface& surface, const InsideCells& cells, const PipelineOptions& options) {
    return merge_vertices(cells, options.voronoi.merge_tolerance, 64 * surface.coordinate_rounding);
}

VoronoiComplex polygons(const Surface& surface, const InsideCells& cells, const MergedVertices& merged) {
    VoronoiComplex complex;
    build_polygons(cells, merged, complex, StageContext(Stage::kVoronoi));
    bridge_gaps(surface, cells, merged, complex);
    return complex;
}

InsideCells inside_cells(const Surface& surface, Tetrahedra tetrahedra) {
    StageContext context(Stage::kVoronoi);
    return find_inside_cells(surface, std::move(tetrahedra), context);
}

std::size_t digest(const VoronoiComplex& c) {
    return bench::digest(c.vertices) ^ bench::digest(c.polygon_vertices) ^ bench::digest(c.polygon_offsets);
}
std::size_t digest(const Tetrahedra& t) { return bench::digest(t.sites) ^ bench::digest(t.neighbours); }
std::size_t digest(const InsideCells& c) { return bench::digest(c.centre) ^ bench::digest(c.neighbours); }
std::size_t digest(const Surface& s) { return bench::digest(s.points) ^ bench::digest(s.triangles); }
std::size_t digest(const Endpoints& ends) {
    std::vector<Vec3> anchors;
    for (const Endpoint& e : ends) anchors.push_back(e.anchor);
    return bench::digest(anchors);
}
std::size_t digest(const Fields& fields) {
    std::size_t sum = 0;
    for (const auto& field : fields) sum += bench::digest(field->time);
    return sum;
}
std::size_t digest(const Centerlines& lines) { return bench::digest(lines.points) ^ bench::digest(lines.radius); }
std::size_t digest(const SurfaceCharacter& c) {
    return bench::digest(c.geodesic_distance) ^ bench::digest(c.geodesic_distance_refined) ^ bench::digest(c.abscissa);
}
std::size_t digest(const Branches& b) {
    return bench::digest(b.lines.points) ^ bench::digest(b.sections.area) ^ bench::digest(b.surface.angle);
}
std::size_t digest(const Solved& solved) { return digest(solved.lines); }

PipelineOptions on_the_complex(PipelineOptions options) {
    options.trace.refine = Refinement::kPath;
    return options;
}

Model prepare(const Input& input) {
    Model model;
    model.surface = condition(input);
    model.tetrahedra = delaunay_tetrahedra(model.surface.points);
    model.cells = inside_cells(model.surface, model.tetrahedra);
    model.merged = merge(model.surface, model.cells, input.options);
    model.solved = solve(model.surface, input.options);
    model.solved.character = characterize(model.surface, model.solved);
    verify(input, model.solved);
    if (digest(polygons(model.surface, model.cells, model.merged)) != digest(model.solved.complex))
        throw std::runtime_error(input.name + ": the steps do not give the complex that the stage gives");
    return model;
}

/// Holds the model of one input, that of the benchmark at hand.
class ModelCache {
public:
    const Model& model(const Input& input) {
        if (name_ != input.name) {
            model_.reset();
            model_ = prepare(input);
            name_ = input.name;
        }
        return *model_;
    }

private:
    std::string name_;
    std::optional<Model> model_;
};

/// Times `run` on what `make` makes, beside the bare Delaunay.
template <class Make, class Run>
void time_pairs(benchmark::State& state, const Model& model, std::size_t expected, const Make& make, const Run& run) {
    const Surface& surface = model.surface;
    const std::size_t distinct = surface.site_count() - model.tetrahedra.duplicates.size();
    std::vector<double> own, bare, ratio;
    for ([[maybe_unused]] auto iteration : state) {
        const double reference = bare_delaunay_seconds(surface.points, distinct);
        auto argument = make();
        const double start = thread_seconds();
        const auto result = run(argument);
        const double seconds = thread_seconds() - start;
        state.SetIterationTime(seconds);
        if (digest(result) != expected) {
            state.SkipWithError("the result differs from the verified one");
            return;
        }
        own.push_back(seconds);
        bare.push_back(reference);
        ratio.push_back(seconds / reference);
    }
    const double sites = static_cast<double>(surface.site_count());
    state.counters["sites"] = sites;
    state.counters["us_per_site"] = 1e6 * median(own) / sites;
    state.counters["delaunay_us_per_site"] = 1e6 * median(bare) / sites;
    state.counters["x_delaunay"] = median(ratio);
    state.counters["x_least"] = *std::min_element(ratio.begin(), ratio.end());
    state.counters["x_most"] = *std::max_element(ratio.begin(), ratio.end());
}

template <class Run>
void time_pairs(benchmark::State& state, const Model& model, std::size_t expected, const Run& run) {
    time_pairs(
        state, model, expected, [] { return 0; }, [&](int) { return run(); });
}

/// Odd, so that a median is one of the pairs.
int iterations(std::size_t points) { return points < 8000 ? 11 : points < 100000 ? 5 : 3; }

using StageBenchmark = void (*)(benchmark::State&, const Input&, const Model&);

struct NamedStage {
    const char* name;
    StageBenchmark run;
};

const NamedStage kStages[] = {
    {"condition", [](benchmark::State& state, const Input& input,
                     const Model& m) { time_pairs(state, m, digest(m.surface), [&] { return condition(input); }); }},
    {"delaunay_flattened",
     [](benchmark::State& state, const Input&, const Model& m) {
         time_pairs(state, m, digest(m.tetrahedra), [&] { return delaunay_tetrahedra(m.surface.points); });
     }},
    {"inside_cells",
     [](benchmark::State& state, const Input&, const Model& m) {
         time_pairs(
             state, m, digest(m.cells), [&] { return m.tetrahedra; },
             [&](Tetrahedra& t) { return inside_cells(m.surface, std::move(t)); });
     }},
    {"polygons",
     [](benchmark::State& state, const Input& input, const Model& m) {
         time_pairs(state, m, digest(m.solved.complex),
                    [&] { return polygons(m.surface, m.cells, merge(m.surface, m.cells, input.options)); });
     }},
    {"voronoi",
     [](benchmark::State& state, const Input& input, const Model& m) {
         time_pairs(state, m, digest(m.solved.complex), [&] { return voronoi(m.surface, input.options); });
     }},
    {"endpoints",
     [](benchmark::State& state, const Input& input, const Model& m) {
         time_pairs(state, m, digest(m.solved.endpoints),
                    [&] { return endpoints(m.surface, m.solved.complex, input.options); });
     }},
    {"eikonal",
     [](benchmark::State& state, const Input&, const Model& m) {
         time_pairs(state, m, digest(m.solved.fields), [&] { return eikonal(m.solved.complex, m.solved.endpoints); });
     }},
    {"trace",
     [](benchmark::State& state, const Input& input, const Model& m) {
         time_pairs(state, m, digest(m.solved.lines), [&] { return trace(m.surface, m.solved, input.options); });
     }},
    {"trace_path",
     [](benchmark::State& state, const Input& input, const Model& m) {
         const PipelineOptions options = on_the_complex(input.options);
         time_pairs(state, m, digest(trace(m.surface, m.solved, options)),
                    [&] { return trace(m.surface, m.solved, options); });
     }},
    {"characterize",
     [](benchmark::State& state, const Input&, const Model& m) {
         time_pairs(state, m, digest(m.solved.character), [&] { return characterize(m.surface, m.solved); });
     }},
    {"branches",
     [](benchmark::State& state, const Input& input, const Model& m) {
         time_pairs(state, m, digest(branches(m.surface, m.solved, input.options)),
                    [&] { return branches(m.surface, m.solved, input.options); });
     }},
    {"whole",
     [](benchmark::State& state, const Input& input, const Model& m) {
         time_pairs(state, m, digest(m.solved), [&] { return solve(m.surface, input.options); });
     }},
    {"whole_path",
     [](benchmark::State& state, const Input& input, const Model& m) {
         const PipelineOptions options = on_the_complex(input.options);
         time_pairs(state, m, digest(trace(m.surface, m.solved, options)), [&] { return solve(m.surface, options); });
     }},
    {"everything",
     [](benchmark::State& state, const Input& input, const Model& m) {
         time_pairs(state, m, digest(m.solved), [&] {
             Solved solved = solve(m.surface, input.options);
             solved.character = characterize(m.surface, solved);
             return solved;
         });
     }},
};

void register_input(const std::shared_ptr<const Input>& input, const std::shared_ptr<ModelCache>& cache) {
    for (const NamedStage& stage : kStages)
        benchmark::RegisterBenchmark((input->name + "/" + stage.name).c_str(),
                                     [input, cache, run = stage.run](benchmark::State& state) {
                                         try {
                                             run(state, *input, cache->model(*input));
                                         } catch (const std::exception& error) {
                                             state.SkipWithError(error.what());
                                         }
                                     })
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond)
            ->Iterations(iterations(input->soup.points.size()));
}

}  // namespace

}  // namespace lumenline::bench

/// Arguments that are no option of Google Benchmark name inputs: known ones, or surface files.
int main(int argc, char** argv) {
    namespace bench = lumenline::bench;
    benchmark::Initialize(&argc, argv);
    try {
        std::vector<std::string> names(argv + 1, argv + argc);
        if (names.empty()) names = bench::default_inputs();
        const auto cache = std::make_shared<bench::ModelCache>();
        for (const std::string& name : names)
            bench::register_input(std::make_shared<const bench::Input>(bench::find_input(name)), cache);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_stages: %s\n", error.what());
        return 2;
    }
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
