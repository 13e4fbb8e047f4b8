// A summary is not stored: it is made again by `summarize`, from a record that holds the small parts
// of the file (endpoints' roles, lines, diagnostics) and, for the large ones, only their counts. So
// there is one definition of each number, and it cannot drift from the data.

#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "io/archive/index.h"
#include "io/archive/index_names.h"
#include "io/archive/line_names.h"
#include "io/archive/model_tables.h"
#include "io/archive/read.h"

namespace lumenline {

namespace {

[[noreturn]] void damaged(const ArchiveFile& file, const std::string& reason) {
    throw ArchiveError("cannot use '" + file.file().string() + "': " + reason);
}

ModelStatus status_of(const ArchiveFile& file, const std::string& name) {
    for (const ModelStatus status : {ModelStatus::kOk, ModelStatus::kWarning, ModelStatus::kFailed})
        if (status_name(status) == name) return status;
    damaged(file, "'" + name + "' is no status (ok, warning, failed)");
}

Stage stage_of(const ArchiveFile& file, const std::string& name) {
    for (int stage = 0; stage < kStageCount; ++stage)
        if (stage_name(static_cast<Stage>(stage)) == name) return static_cast<Stage>(stage);
    damaged(file, "'" + name + "' is no stage that this program knows");
}

ErrorCode code_of(const ArchiveFile& file, const std::string& name) {
    for (int code = 0; code < kErrorCodeCount; ++code)
        if (error_name(static_cast<ErrorCode>(code)) == name) return static_cast<ErrorCode>(code);
    damaged(file, "'" + name + "' is no failure code that this program knows");
}

std::string text_attribute(const ArchiveFile& file, const char* name) {
    const std::optional<std::string> text = file.attribute("/", name);
    if (!text) damaged(file, std::string("it has no attribute '") + name + "'");
    return *text;
}

ModelIdentity read_identity(const ArchiveFile& file) {
    ModelIdentity who;
    who.id = text_attribute(file, "id");
    who.subject = text_attribute(file, "subject");
    who.session = text_attribute(file, "session");
    who.side = text_attribute(file, "side");
    who.structure = text_attribute(file, "structure");
    who.group = text_attribute(file, "group");
    who.length_unit = text_attribute(file, "length_unit");
    who.coordinate_system = text_attribute(file, "coordinate_system");
    who.source_file = text_attribute(file, "source_file");
    who.source_sha256 = text_attribute(file, "source_sha256");
    who.inputs_sha256 = text_attribute(file, "inputs_sha256");
    const std::vector<std::string> columns = file.strings(names::kCovariateName.path);
    const std::vector<std::string> values = file.strings(names::kCovariateValue.path);
    if (columns.size() != values.size()) damaged(file, "/covariates/name and value are not of the same length");
    for (std::size_t i = 0; i < columns.size(); ++i) who.covariates.emplace_back(columns[i], values[i]);
    return who;
}

std::size_t length_of(const ArchiveFile& file, const names::Field& field) {
    if (!file.has(field.path)) return 0;
    const std::vector<std::uint64_t> shape = file.shape(field.path);
    return shape.empty() ? 0 : shape.front();
}

/// A count that the root states; where it does not, the array's length.
std::size_t count_of(const ArchiveFile& file, const char* name, const names::Field& field) {
    const std::optional<std::string> text = file.attribute("/", name);
    if (!text) return length_of(file, field);
    std::size_t count = 0;
    const auto result = std::from_chars(text->data(), text->data() + text->size(), count);
    if (result.ec != std::errc() || result.ptr != text->data() + text->size())
        damaged(file, std::string("/@") + name + " is no count");
    return count;
}

std::shared_ptr<const Centerlines> read_lines(const ArchiveFile& file) {
    auto lines = std::make_shared<Centerlines>();
    lines->radius = file.numbers(names::kRadius.path);
    lines->abscissa = file.numbers(names::kAbscissa.path);
    lines->source.resize(file.numbers(names::kLineSource.path).size());
    lines->loops.resize(length_of(file, names::kLoopPoint));
    double last = 0;
    for (const double offset : file.numbers(names::kLineOffsets.path)) {
        if (!(offset >= last) || offset > static_cast<double>(lines->radius.size()))
            damaged(file, "/centerlines/offsets do not ascend within the points");
        lines->offsets.push_back(static_cast<std::uint32_t>(offset));
        last = offset;
    }
    if (lines->offsets.size() != lines->source.size() + 1 || lines->radius.size() != lines->abscissa.size())
        damaged(file, "the arrays of /centerlines are not of matching length");
    return lines;
}

AreaStatistics read_statistics(const ArchiveFile& file, const names::Field& field) {
    const std::vector<double> values = file.numbers(field.path);
    if (values.size() != 4) damaged(file, std::string(field.path) + " does not hold four numbers");
    return {values[0], values[1], values[2], values[3]};
}

std::shared_ptr<const SurfaceCharacter> read_character(const ArchiveFile& file) {
    auto character = std::make_shared<SurfaceCharacter>();
    character->geodesic_distance_statistics = read_statistics(file, names::kStatisticsGeodesic);
    character->euclidean_distance_statistics = read_statistics(file, names::kStatisticsEuclidean);
    character->normalized_tangency_deviation_statistics = read_statistics(file, names::kStatisticsTangency);
    const std::vector<double> unreached = file.numbers(names::kUnreachedSites.path);
    if (unreached.size() != 1 || !(unreached.front() >= 0))
        damaged(file, std::string(names::kUnreachedSites.path) + " is not a count");
    character->unreached = static_cast<std::size_t>(unreached.front());
    return character;
}

Diagnostics read_severities(const ArchiveFile& file) {
    Diagnostics found;
    for (const std::string& severity : file.strings(names::kSeverity.path)) {
        Diagnostic diagnostic;
        diagnostic.severity = severity == severity_name(Severity::kNote)      ? Severity::kNote
                              : severity == severity_name(Severity::kWarning) ? Severity::kWarning
                                                                              : Severity::kError;
        found.push_back(diagnostic);
    }
    return found;
}

double only_number(const ArchiveFile& file, const names::Field& field) {
    const std::vector<double> numbers = file.numbers(field.path);
    if (numbers.size() != 1) damaged(file, std::string(field.path) + " is not one number");
    return numbers.front();
}

/// The numbers of the surface that a summary needs; its arrays stay empty.
std::shared_ptr<const Surface> read_surface_sizes(const ArchiveFile& file) {
    const auto number = [&](const char* name) {
        double value = 0;
        const std::string text = file.attribute(names::kSurface, name).value_or("");
        const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
        if (result.ec != std::errc() || result.ptr != text.data() + text.size())
            damaged(file, std::string(names::kSurface) + "@" + name + " is no number");
        return value;
    };
    auto surface = std::make_shared<Surface>();
    surface->diagonal = number("diagonal");
    surface->median_edge = number("median_edge");
    const double genus = number("genus");
    if (!(genus >= 0 && genus <= std::numeric_limits<int>::max()))
        damaged(file, std::string(names::kSurface) + "@genus is not a count");
    surface->genus = static_cast<int>(genus);
    return surface;
}

Failure read_failure(const ArchiveFile& file) {
    const std::string signal = file.attribute("/", "failure_signal").value_or("0");
    Failure failure{stage_of(file, text_attribute(file, "failure_stage")),
                    code_of(file, text_attribute(file, "failure_code")), text_attribute(file, "failure_sentence")};
    std::from_chars(signal.data(), signal.data() + signal.size(), failure.signal);
    return failure;
}

/// A column of the index, which must have one value per model.
template <class T>
std::vector<T> column(const ArchiveFile& index, const char* path, std::size_t rows) {
    std::vector<T> values;
    if constexpr (std::is_same_v<T, std::string>)
        values = index.strings(path);
    else
        values = index.numbers(path);
    if (values.size() != rows)
        damaged(index, std::string(path) + " has " + std::to_string(values.size()) + " rows for " +
                           std::to_string(rows) + " models");
    return values;
}

void read_identities(const ArchiveFile& index, std::vector<ModelSummary>& models) {
    const std::pair<const names::Field*, std::string ModelIdentity::*> columns[] = {
        {&names::kId, &ModelIdentity::id},
        {&names::kSubject, &ModelIdentity::subject},
        {&names::kSession, &ModelIdentity::session},
        {&names::kSide, &ModelIdentity::side},
        {&names::kStructure, &ModelIdentity::structure},
        {&names::kGroup, &ModelIdentity::group},
        {&names::kLengthUnit, &ModelIdentity::length_unit},
        {&names::kCoordinates, &ModelIdentity::coordinate_system},
        {&names::kSourceFile, &ModelIdentity::source_file},
        {&names::kSourceSha, &ModelIdentity::source_sha256},
        {&names::kInputsSha, &ModelIdentity::inputs_sha256}};
    for (const auto& [field, member] : columns) {
        const auto values = column<std::string>(index, field->path, models.size());
        for (std::size_t row = 0; row < models.size(); ++row) models[row].identity.*member = values[row];
    }
}

void read_counts(const ArchiveFile& index, std::vector<ModelSummary>& models) {
    const std::pair<const names::Field*, std::size_t ModelSummary::*> columns[] = {
        {&names::kSites, &ModelSummary::sites},
        {&names::kTriangleCount, &ModelSummary::triangles},
        {&names::kVertexCount, &ModelSummary::voronoi_vertices},
        {&names::kPolygonCount, &ModelSummary::polygons},
        {&names::kInlets, &ModelSummary::inlets},
        {&names::kOutlets, &ModelSummary::outlets},
        {&names::kLineCount, &ModelSummary::centerlines},
        {&names::kGenus, &ModelSummary::genus},
        {&names::kLoopCount, &ModelSummary::loops},
        {&names::kUnreached, &ModelSummary::unreached_sites},
        {&names::kWarnings, &ModelSummary::warnings}};
    for (const auto& [field, member] : columns) {
        const bool is_new = field == &names::kGenus || field == &names::kLoopCount;
        if (is_new && !index.has(field->path)) continue;  // an index of an earlier version
        const auto values = column<double>(index, field->path, models.size());
        for (std::size_t row = 0; row < models.size(); ++row) {
            if (!(values[row] >= 0)) damaged(index, std::string(field->path) + " holds a negative count");
            models[row].*member = static_cast<std::size_t>(values[row]);
        }
    }
}

void read_lengths(const ArchiveFile& index, std::vector<ModelSummary>& models) {
    const std::pair<const names::Field*, double ModelSummary::*> columns[] = {
        {&names::kLineLength, &ModelSummary::length},      {&names::kRadiusMin, &ModelSummary::radius_min},
        {&names::kRadiusMean, &ModelSummary::radius_mean}, {&names::kRadiusMax, &ModelSummary::radius_max},
        {&names::kDiagonal, &ModelSummary::diagonal},      {&names::kEdgeOverRadius, &ModelSummary::edge_over_radius},
        {&names::kSeconds, &ModelSummary::seconds}};
    for (const auto& [field, member] : columns) {
        if (!index.has(field->path)) continue;  // an index of an earlier version
        const auto values = column<double>(index, field->path, models.size());
        for (std::size_t row = 0; row < models.size(); ++row)
            models[row].*member = std::isnan(values[row]) ? 0 : values[row];
    }
}

void read_character_columns(const ArchiveFile& index, std::vector<ModelSummary>& models) {
    for (const names::StatisticsColumn& c : names::kStatisticsColumns) {
        const auto values = column<double>(index, c.field.path, models.size());
        for (std::size_t row = 0; row < models.size(); ++row) models[row].*c.quantity.*c.value = values[row];
    }
}

void read_states(const ArchiveFile& index, std::vector<ModelSummary>& models) {
    const auto status = column<std::string>(index, names::kStatus.path, models.size());
    const auto stage = column<std::string>(index, names::kFailureStage.path, models.size());
    const auto code = column<std::string>(index, names::kFailureCode.path, models.size());
    const std::vector<std::string> sentences = index.strings(names::kFailedSentence.path);
    std::size_t failed = 0;
    for (std::size_t row = 0; row < models.size(); ++row) {
        models[row].status = status_of(index, status[row]);
        if (code[row].empty()) continue;
        if (failed == sentences.size()) damaged(index, "/tables/failures has fewer rows than there are failed models");
        models[row].failure = Failure{stage_of(index, stage[row]), code_of(index, code[row]), sentences[failed++]};
    }
}

void require_format(const ArchiveFile& file, std::string_view format) {
    if (file.format() != format) damaged(file, "it is a " + file.format() + " file, not a " + std::string(format));
}

}  // namespace

ModelSummary read_summary(const std::filesystem::path& model_file) {
    const ArchiveFile file(model_file);
    require_format(file, names::kModelFormat);
    ModelRecord record;
    record.identity = read_identity(file);
    record.status = status_of(file, text_attribute(file, "status"));
    if (record.status == ModelStatus::kFailed) record.failure = read_failure(file);
    record.diagnostics = read_severities(file);
    if (file.has(names::kSurface)) record.surface = read_surface_sizes(file);
    if (file.has(names::kEndpointRole.path)) record.endpoints = std::make_shared<const Endpoints>(hdf::read_endpoints(file));
    if (file.has(names::kRadius.path)) record.centerlines = read_lines(file);
    if (file.has(names::kStatisticsGeodesic.path)) record.character = read_character(file);
    record.facts.total_seconds = only_number(file, names::kTotalSeconds);

    ModelSummary summary = summarize(record);
    summary.sites = count_of(file, names::kStatedSites, names::kSurfacePoints);
    summary.triangles = count_of(file, names::kStatedTriangles, names::kTriangles);
    summary.voronoi_vertices = count_of(file, names::kStatedVertices, names::kVertices);
    summary.polygons = count_of(file, names::kStatedPolygons, names::kPolygonSites);
    return summary;
}

std::optional<ModelState> read_state(const std::filesystem::path& model_file) {
    std::error_code error;
    if (!std::filesystem::exists(model_file, error)) return std::nullopt;
    const ArchiveFile file(model_file);
    require_format(file, names::kModelFormat);
    ModelState state;
    state.id = text_attribute(file, "id");
    state.status = status_of(file, text_attribute(file, "status"));
    state.source_sha256 = text_attribute(file, "source_sha256");
    state.inputs_sha256 = text_attribute(file, "inputs_sha256");
    if (state.status == ModelStatus::kFailed) state.failure = read_failure(file);
    state.seconds = only_number(file, names::kTotalSeconds);
    return state;
}

std::vector<ModelSummary> read_index(const std::filesystem::path& index_file) {
    const ArchiveFile index(index_file);
    require_format(index, names::kCohortFormat);
    std::vector<ModelSummary> models(index.strings(names::kId.path).size());
    read_identities(index, models);
    read_states(index, models);
    read_counts(index, models);
    read_lengths(index, models);
    read_character_columns(index, models);
    return models;
}

}  // namespace lumenline
