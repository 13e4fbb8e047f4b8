// One function per group of the format. The order of the calls is the order of the bytes in the
// file; /provenance and /timing come last, so that the addresses of all other data do not depend on
// the length of a host's name. Arrays are checked against each other before they are written,
// because VTK and our own readers trust the lengths.

#include "io/archive/model_file.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <system_error>

#include "engine/core/index_tables.h"
#include "engine/core/text.h"
#include "engine/core/version.h"
#include "io/archive/line_names.h"
#include "io/archive/packed_rows.h"
#include "io/archive/tables.h"
#include "io/archive/vtkhdf.h"
#include "io/archive/writer.h"

namespace lumenline {

namespace {

using hdf::Number;
using hdf::Writer;

constexpr std::int32_t kWallTriangle = -1;
constexpr std::int32_t kUnusedOpening = -2;

template <class Row, class Read>
std::vector<std::string> text_column(const std::vector<Row>& rows, Read read) {
    std::vector<std::string> column;
    column.reserve(rows.size());
    for (const Row& row : rows) column.emplace_back(read(row));
    return column;
}

template <class T, class Row, class Read>
std::vector<T> number_column(const std::vector<Row>& rows, Read read) {
    std::vector<T> column;
    column.reserve(rows.size());
    for (const Row& row : rows) column.push_back(read(row));
    return column;
}

void write_identity(Writer& writer, const ModelRecord& record, const ArchiveOptions& options) {
    const ModelIdentity& who = record.identity;
    writer.attribute("/", "format", names::kModelFormat);
    writer.attribute("/", "format_version", names::kFormatVersion);
    writer.attribute("/", "lumenline_version", version());
    writer.attribute("/", "id", who.id);
    writer.attribute("/", "subject", who.subject);
    writer.attribute("/", "session", who.session);
    writer.attribute("/", "side", who.side);
    writer.attribute("/", "structure", who.structure);
    writer.attribute("/", "group", who.group);
    writer.attribute("/", "status", status_name(record.status));
    writer.attribute("/", "length_unit", who.length_unit);
    writer.attribute("/", "coordinate_system", who.coordinate_system);
    writer.attribute("/", "source_file", who.source_file);
    writer.attribute("/", "source_sha256", who.source_sha256);
    writer.attribute("/", "inputs_sha256", who.inputs_sha256);
    writer.attribute("/", "fields", fields_name(options.fields));
    const auto count = [&](const char* name, std::size_t n) { writer.attribute("/", name, static_cast<int>(n)); };
    if (record.surface) {
        count(names::kStatedSites, record.surface->site_count());
        count(names::kStatedTriangles, record.surface->triangles.size());
    }
    if (record.complex) {
        count(names::kStatedVertices, record.complex->vertex_count());
        count(names::kStatedPolygons, record.complex->polygon_count());
    }
    if (record.failure) {
        writer.attribute("/", "failure_stage", stage_name(record.failure->stage));
        writer.attribute("/", "failure_code", error_name(record.failure->code));
        writer.attribute("/", "failure_sentence", record.failure->sentence);
        if (record.failure->signal != 0) writer.attribute("/", "failure_signal", record.failure->signal);
    }
    writer.strings(names::kCovariateName, text_column(who.covariates, [](const auto& c) { return c.first; }));
    writer.strings(names::kCovariateValue, text_column(who.covariates, [](const auto& c) { return c.second; }));
}

/// Endpoint of each triangle's opening, for /surface/cap.
std::vector<std::int32_t> cap_endpoints(const Surface& surface, const Endpoints* endpoints) {
    std::vector<std::int32_t> endpoint_of(surface.openings.size(), kUnusedOpening);
    const auto slot = [&](OpeningId opening) -> std::int32_t& {
        if (at(opening) < endpoint_of.size()) return endpoint_of[at(opening)];
        throw hdf::Inconsistent("opening " + std::to_string(opening.value) + " does not exist: the surface has " +
                                counted(endpoint_of.size(), "opening"));
    };
    for (std::size_t e = 0; endpoints != nullptr && e < endpoints->size(); ++e)
        if (const OpeningId opening = (*endpoints)[e].opening; !opening.is_none())
            slot(opening) = static_cast<std::int32_t>(e);
    return number_column<std::int32_t>(
        surface.cap, [&](OpeningId opening) { return opening.is_none() ? kWallTriangle : slot(opening); });
}

void write_surface(Writer& writer, const ModelRecord& record, const ArchiveOptions& options) {
    const Surface& surface = *record.surface;
    const std::size_t sites = surface.site_count();
    writer.group(names::kSurface);
    writer.attribute(names::kSurface, "genus", surface.genus);
    writer.attribute(names::kSurface, "component_count", surface.component_count);
    writer.attribute(names::kSurface, "diagonal", surface.diagonal);
    writer.attribute(names::kSurface, "median_edge", surface.median_edge);
    writer.attribute(names::kSurface, "coordinate_rounding", surface.coordinate_rounding);
    if (options.fields == ArchiveFields::kLines) return;
    writer.column(names::kSurfacePoints, surface.points);
    writer.column(names::kTriangles, surface.triangles);
    writer.column(names::kNormals, surface.normals, sites);
    writer.column(names::kInputVertex, surface.input_vertex, sites);
    const auto origin = [](SiteOrigin o) { return static_cast<std::uint8_t>(o); };
    writer.column(names::kOrigin, number_column<std::uint8_t>(surface.origin, origin), sites);
    writer.column(names::kCap, cap_endpoints(surface, record.endpoints.get()), surface.triangles.size());
    if (record.complex && options.fields == ArchiveFields::kAll)
        writer.column(names::kPole, record.complex->pole, sites);
}

/// The values of the sites and the Voronoi vertices.
void write_character(Writer& writer, const ModelRecord& record, const ArchiveOptions& options) {
    if (options.fields == ArchiveFields::kLines) return;
    const SurfaceCharacter& c = *record.character;
    const std::size_t sites = record.surface->site_count();
    const std::pair<const names::Field*, const std::vector<double>*> scalars[] = {
        {&names::kGeodesic, &c.geodesic_distance},
        {&names::kDescentLength, &c.descent_length},
        {&names::kEuclidean, &c.euclidean_distance},
        {&names::kTangencyDeviation, &c.normalized_tangency_deviation},
        {&names::kGeodesicRefined, &c.geodesic_distance_refined},
        {&names::kTangencyDeviationRefined, &c.normalized_tangency_deviation_refined},
        {&names::kSiteAbscissa, &c.abscissa}};
    for (const auto& [field, values] : scalars) hdf::write_scalars(writer, *field, *values, sites, options);
    writer.column(names::kCenterlinePoint, c.centerline_point, sites);
    writer.column(names::kCenterlineId, c.centerline_id, sites);
    const auto zone = [](SiteZone z) { return static_cast<std::uint8_t>(z); };
    writer.column(names::kZone, number_column<std::uint8_t>(c.zone, zone), sites);
    if (options.fields == ArchiveFields::kAll)
        hdf::write_scalars(writer, names::kCenterlineDistance, c.centerline_distance, record.complex->vertex_count(),
                           options);
}

void write_statistics(Writer& writer, const SurfaceCharacter& c) {
    const std::pair<const names::Field*, const AreaStatistics*> statistics[] = {
        {&names::kStatisticsGeodesic, &c.geodesic_distance_statistics},
        {&names::kStatisticsEuclidean, &c.euclidean_distance_statistics},
        {&names::kStatisticsTangency, &c.normalized_tangency_deviation_statistics}};
    for (const auto& [field, s] : statistics)
        writer.column(*field, std::vector<double>{s->mean, s->sd, s->median, s->p95});
    writer.number(names::kWallSites, static_cast<std::int32_t>(c.wall_sites));
    writer.number(names::kUnreachedSites, static_cast<std::int32_t>(c.unreached));
    writer.number(names::kNotRefined, static_cast<std::int32_t>(c.not_refined));
    const auto count = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
    writer.column(names::kJumps, std::vector<std::uint32_t>{count(c.jumps.pole_sheet), count(c.jumps.branches_meet),
                                                            count(c.jumps.other)});
}

void write_endpoints(Writer& writer, const Endpoints& endpoints) {
    writer.column(names::kEndpointPoint, number_column<Vec3>(endpoints, [](const Endpoint& e) { return e.point; }));
    writer.column(names::kEndpointNormal, number_column<Vec3>(endpoints, [](const Endpoint& e) { return e.normal; }));
    writer.column(names::kEndpointRadius, number_column<double>(endpoints, [](const Endpoint& e) { return e.radius; }));
    writer.strings(names::kEndpointKind, text_column(endpoints, [](const Endpoint& e) { return kind_name(e.kind); }));
    writer.strings(names::kEndpointRole, text_column(endpoints, [](const Endpoint& e) { return role_name(e.role); }));
    writer.column(names::kAnchor, number_column<Vec3>(endpoints, [](const Endpoint& e) { return e.anchor; }));
    writer.column(names::kAnchorRadius,
                  number_column<double>(endpoints, [](const Endpoint& e) { return e.anchor_radius; }));
}

void write_complex(Writer& writer, const VoronoiComplex& complex) {
    writer.column(names::kVertices, complex.vertices);
    writer.column(names::kBallRadius, complex.ball_radius, complex.vertex_count());
    writer.column(names::kPolygonOffsets, complex.polygon_offsets, complex.polygon_count() + 1);
    writer.column(names::kPolygonVertices, complex.polygon_vertices, complex.polygon_offsets.back());
    writer.column(names::kPolygonSites, complex.polygon_sites);
}

void write_fields(Writer& writer, const ModelRecord& record, const ArchiveOptions& options) {
    std::vector<EndpointId> sources;
    std::vector<std::uint32_t> reached;
    std::vector<double> residual;
    std::vector<hdf::Rows> rows;
    const std::size_t vertices = record.complex ? record.complex->vertex_count() : 0;
    for (const auto& field : record.fields) {
        if (!field) continue;
        if (field->time.size() != vertices)
            throw hdf::Inconsistent(std::string(names::kArrivalTime.path) + " has " +
                                    std::to_string(field->time.size()) + " columns where the record asks for " +
                                    std::to_string(vertices));
        sources.push_back(field->source);
        reached.push_back(static_cast<std::uint32_t>(field->reached));
        residual.push_back(field->residual);
        rows.push_back({field->time.data(), 1});
    }
    if (rows.empty()) return;
    const std::array<hsize_t, 2> shape{rows.size(), vertices};
    writer.numbers(names::kArrivalTime, shape, Number::kFloat64,
                   options.float32_fields ? Number::kFloat32 : Number::kFloat64, rows);
    writer.column(names::kSources, sources);
    writer.column(names::kReached, reached);
    writer.column(names::kResidual, residual);
}

void write_centerlines(Writer& writer, const Centerlines& lines) {
    const std::size_t count = lines.line_count();
    const std::size_t points = lines.points.size();
    writer.column(names::kLineOffsets, lines.offsets, count + 1);
    if (lines.offsets.back() != points)
        throw hdf::Inconsistent(std::string(names::kLineOffsets.path) + " ends at " +
                                std::to_string(lines.offsets.back()) + " but there are " + counted(points, "point"));
    writer.column(names::kLinePoints, lines.points);
    writer.column(names::kLineBallRadius, lines.ball_radius, points);
    writer.column(names::kClearance, lines.clearance, points);
    writer.column(names::kRadius, lines.radius, points);
    writer.column(names::kRadiusError, lines.radius_error, points);
    writer.column(names::kPositionError, lines.position_error, points);
    writer.column(names::kAbscissa, lines.abscissa, points);
    writer.column(names::kLineSource, lines.source, count);
    writer.column(names::kLineTarget, lines.target, count);
    writer.column(names::kLineLoop, lines.loop, count);
    const PathLines& path = lines.path;
    writer.column(names::kPathOffsets, path.offsets, count + 1);
    writer.column(names::kPathPoints, path.points, path.offsets.back());
    writer.column(names::kPathBallRadius, path.ball_radius, path.points.size());
    writer.column(names::kPathAbscissa, path.abscissa, path.points.size());
    writer.column(names::kLineAbscissa, path.line_abscissa, path.points.size());
}

void write_loops(Writer& writer, const std::vector<LumenLoop>& loops) {
    std::vector<Vec3> points;
    std::vector<double> radii, times;
    std::vector<EndpointId> sources;
    for (const LumenLoop& loop : loops) {
        points.push_back(loop.point);
        radii.push_back(loop.ball_radius);
        times.push_back(loop.time);
        sources.push_back(loop.source);
    }
    writer.column(names::kLoopPoint, points);
    writer.column(names::kLoopBallRadius, radii);
    writer.column(names::kLoopTime, times);
    writer.column(names::kLoopSource, sources);
}

void write_diagnostics(Writer& writer, const Diagnostics& found) {
    writer.strings(names::kCode, text_column(found, [](const Diagnostic& d) { return d.code; }));
    writer.strings(names::kSeverity, text_column(found, [](const Diagnostic& d) { return severity_name(d.severity); }));
    writer.strings(names::kStage, text_column(found, [](const Diagnostic& d) { return stage_name(d.stage); }));
    writer.strings(names::kMessage, text_column(found, [](const Diagnostic& d) { return d.message; }));
    writer.column(names::kValue, number_column<double>(found, [](const Diagnostic& d) { return d.value; }));
    writer.column(names::kLimit, number_column<double>(found, [](const Diagnostic& d) { return d.limit; }));
}

void write_facts(Writer& writer, const RunFacts& facts, const std::string& options) {
    std::array<char, 256> host{};
    if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
    unsigned major = 0, minor = 0, release = 0;
    hdf::checked(H5get_libversion(&major, &minor, &release), "version of HDF5");
    writer.text(names::kHost, host.data());
    writer.text(names::kProgram, version());
    writer.text(names::kCommit, build_commit());
    writer.text(names::kCompiler, build_compiler());
    writer.text(names::kHdf5Version,
                std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(release));
    writer.text(names::kOptions, options);
    writer.number(names::kThreads, std::int32_t{facts.threads});

    std::vector<std::string> stages;
    stages.reserve(kStageCount);
    for (int stage = 0; stage < kStageCount; ++stage) stages.emplace_back(stage_name(static_cast<Stage>(stage)));
    writer.strings(names::kTimingStage, stages);
    writer.column(names::kTimingSeconds, std::vector<double>(facts.stage_seconds.begin(), facts.stage_seconds.end()));
    writer.number(names::kTotalSeconds, facts.total_seconds);
    writer.number(names::kPeakBytes, facts.peak_resident_bytes);
}

void write_all(Writer& writer, const ModelRecord& record, const ArchiveOptions& options) {
    write_identity(writer, record, options);
    if (record.surface) write_surface(writer, record, options);
    if (record.endpoints) write_endpoints(writer, *record.endpoints);
    if (options.fields == ArchiveFields::kAll) {
        if (record.complex) write_complex(writer, *record.complex);
        write_fields(writer, record, options);
    }
    if (record.centerlines) {
        write_centerlines(writer, *record.centerlines);
        write_loops(writer, record.centerlines->loops);
    }
    if (record.character) {
        write_character(writer, record, options);
        write_statistics(writer, *record.character);
    }
    const bool has_branches = record.branches && record.surface && record.centerlines;
    if (has_branches)
        hdf::write_branches(writer, *record.branches, record.surface->site_count(), record.centerlines->points.size(),
                            options);
    if (record.endpoints)
        writer.column(names::kIndexRows,
                      hdf::pack_rows(index_tables(has_branches ? *record.branches : Branches(), *record.endpoints)));
    write_diagnostics(writer, record.diagnostics);
    write_vtkhdf(writer, record, options.fields != ArchiveFields::kLines);
    write_facts(writer, record.facts, record.options);
}

}  // namespace

void write_model_file(const std::filesystem::path& file, const ModelRecord& record, const ArchiveOptions& options) {
    const auto refuse = [&](const std::string& reason) {
        throw StageError(Stage::kArchive, ErrorCode::kArchiveWrite,
                         "cannot write the model file '" + file.string() + "' (" + reason +
                             "): check the directory, its permissions and the free space");
    };
    const hdf::Quiet quiet;
    try {
        Writer writer(file, record.identity.length_unit);
        write_all(writer, record, options);
        writer.commit();
    } catch (const hdf::Inconsistent& error) {
        throw StageError(Stage::kArchive, ErrorCode::kInternal,
                         "the result of model '" + record.identity.id + "' contradicts itself (" + error.what() +
                             "), which is an error of the program: please report it with the surface");
    } catch (const hdf::Error& error) {
        refuse(error.what());
    } catch (const std::system_error& error) {
        refuse(error.what());
    }
}

std::filesystem::path model_path(const std::filesystem::path& archive_dir, std::string_view id) {
    return archive_dir / "models" / (std::string(id) + ".hdf");
}

}  // namespace lumenline
