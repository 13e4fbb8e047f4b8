#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <string_view>
#include <vector>

#include "engine/core/arrival_field.h"
#include "engine/core/centerlines.h"
#include "engine/core/endpoints.h"
#include "engine/core/model_record.h"
#include "engine/core/options.h"
#include "engine/core/soup.h"
#include "engine/core/surface.h"
#include "engine/core/voronoi_complex.h"
#include "engine/phantom/phantom.h"

namespace lumenline::test {

/// Numbers for test cases: the same on every run.
class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
    Vec3 in_box(Vec3 low, Vec3 high) {
        return {uniform(low.x, high.x), uniform(low.y, high.y), uniform(low.z, high.z)};
    }
    Vec3 direction();  ///< uniform on the unit sphere

private:
    std::mt19937_64 engine_;
};

/// A capped phantom in general position. Straight shapes are `length` long, a hairpin's legs 15 with a
/// bend of radius 7; everything else is as in PhantomOptions.
PhantomOptions capped_options(PhantomKind kind, double jitter, int points_around, double length);

/// A phantom with caps as a conditioned surface without openings, made here without engine/condition.
Surface closed_surface(const Phantom& capped);

/// Both surfaces as two components of one, without openings.
Surface disjoint_union(const Surface& a, const Surface& b);

/// The complex with default options. @param merge_tolerance  as VoronoiOptions
VoronoiComplex complex_of(const Surface& surface, double merge_tolerance = 1e-9);

/// Endpoints on a closed surface from given points.
Endpoints endpoints_at(const Surface& surface, const VoronoiComplex& complex, const std::vector<Vec3>& inlets,
                       const std::vector<Vec3>& outlets);

ArrivalField field_of(const VoronoiComplex& complex, std::span<const Seed> seeds);

/// A closed surface after all stages.
struct Traced {
    VoronoiComplex complex;
    Endpoints endpoints;
    std::vector<std::shared_ptr<const ArrivalField>> fields;
    Centerlines lines;
    Diagnostics findings;  ///< of the trace
};

/// Complex, endpoints at the given points, fields and lines of a closed surface.
Traced trace_closed(const Surface& surface, const std::vector<Vec3>& inlets, const std::vector<Vec3>& outlets,
                    const TraceOptions& options = {});

/// All stages on a soup in memory.
ModelRecord run_pipeline(const TriangleSoup& soup, const PipelineOptions& options = {});

/// Options of one inlet and one outlet near the two ends of a phantom's axis.
PipelineOptions from_start_to_end(const PhantomTruth& truth);

/// Distance from x to the nearest point of a triangle, by cases (Ericson 2005, 5.1.5).
double distance_to_triangle(Vec3 x, Vec3 a, Vec3 b, Vec3 c);

/// Largest distance from a vertex of one polyline to the other polyline, both ways.
double distance_between_lines(std::span<const Vec3> a, std::span<const Vec3> b);

/// Points or radii of line number `line`.
template <class T>
std::span<const T> part(const std::vector<T>& values, const std::vector<std::uint32_t>& offsets, std::size_t line) {
    return {values.data() + offsets[line], values.data() + offsets[line + 1]};
}

/// True if the record has a finding of that code.
bool has_finding(const Diagnostics& diagnostics, std::string_view code);

}  // namespace lumenline::test
