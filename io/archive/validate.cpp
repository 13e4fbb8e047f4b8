// An archive is looked at file by file; a file that cannot be opened is one finding, and the rest goes on. Every check
// uses only what earlier ones found sound, so that damage in one dataset is said once and not again by all that refer
// to it.

#include "io/archive/validate.h"

#include <algorithm>
#include <map>
#include <set>

#include "io/archive/index.h"
#include "io/archive/index_names.h"
#include "io/archive/inspection.h"
#include "io/archive/model_file.h"
#include "io/archive/utf8.h"

namespace lumenline {

namespace {

/// Runs a check; what it cannot read is a finding.
template <class Check>
void guarded(Validation& result, const std::string& label, Check check) {
    try {
        check();
    } catch (const ArchiveError& error) {
        result.findings.push_back({label, "", error.what()});
    }
}

std::string text_of(const ArchiveFile& file, const char* name) { return file.attribute("/", name).value_or(""); }

bool is_among(const std::string& text, std::initializer_list<const char*> known) {
    return std::find(known.begin(), known.end(), text) != known.end();
}

void check_identity(Inspection& inspection, const std::string& id) {
    const ArchiveFile& file = inspection.file();
    const std::string status = text_of(file, "status"), own = text_of(file, "id");
    if (!is_among(status, {"ok", "warning", "failed"}))
        inspection.report("/@status", "'" + status + "' is none of ok, warning, failed");
    if (const std::string system = text_of(file, "coordinate_system"); !is_among(system, {"LPS", "RAS", "unknown"}))
        inspection.report("/@coordinate_system", "'" + system + "' is none of LPS, RAS, unknown");
    if (own != id) inspection.report("/@id", "is '" + own + "', but the model is called '" + id + "'");
    if (!inspection.is_sound(names::kSeverity.path) || status == "failed") return;
    const std::vector<std::string> severity = inspection.strings(names::kSeverity.path);
    const bool grave = std::any_of(severity.begin(), severity.end(), [](const auto& s) { return s != "note"; });
    if (grave != (status == "warning"))
        inspection.report("/@status", "is " + status + ", but the diagnostics hold " +
                                          (grave ? "warnings or errors" : "neither warnings nor errors"));
}

void check_model(const ArchiveFile& file, const std::string& id, const std::string& label, Validation& result) {
    ++result.files;
    Inspection inspection(file, label, model_specification(), result);
    check_structure(inspection, model_attributes(), text_of(file, "status") == "failed", text_of(file, "length_unit"));
    check_identity(inspection, id);
    check_values(inspection);
    check_surface(inspection);
    check_complex(inspection);
    check_lines(inspection);
}

std::string common_unit(const ArchiveFile& index) {
    const std::vector<std::string> units = index.strings(names::kLengthUnit.path);
    if (units.empty()) return "unknown";
    return std::all_of(units.begin(), units.end(), [&](const auto& u) { return u == units.front(); }) ? units.front()
                                                                                                      : "mixed";
}

/// The failures are those of the models that failed, in their order.
void check_failures(Inspection& index) {
    if (!index.are_sound({&names::kId, &names::kStatus, &names::kFailedId})) return;
    const std::vector<std::string> id = index.strings(names::kId.path), status = index.strings(names::kStatus.path),
                                   failed = index.strings(names::kFailedId.path);
    std::vector<std::string> expected;
    for (std::size_t row = 0; row < id.size(); ++row)
        if (status[row] == "failed") expected.push_back(id[row]);
    if (expected != failed) index.report(names::kFailedId.path, "are not the models of status failed, in their order");
}

/// Ids of the rows of all tables are models; those of the models are unlike each other.
void check_ids(Inspection& index) {
    if (!index.is_sound(names::kId.path)) return;
    const std::vector<std::string> ids = index.strings(names::kId.path);
    std::set<std::string> known;
    index.all_hold(names::kId.path, ids.size(), [&](std::size_t row) {
        return known.insert(ids[row]).second ? std::string() : "'" + ids[row] + "' is there twice";
    });
    for (const Specified& entry : index.specification()) {
        if (!entry.path.ends_with("/id") || entry.path == names::kId.path || !index.is_sound(entry.path)) continue;
        const std::vector<std::string> own = index.strings(entry.path);
        index.all_hold(entry.path, own.size(), [&](std::size_t row) {
            return known.contains(own[row]) ? std::string()
                                            : "'" + own[row] + "' at " + std::to_string(row) + " is no model";
        });
    }
}

/// What the index says of a model, against its file.
void check_row(Inspection& index, const ModelSummary& row, const ModelSummary& own) {
    const auto differs = [&](const names::Field& field) {
        index.report(field.path, "of the model '" + row.identity.id +
                                     "' is not that of its file: run the cohort again, or merge it");
    };
    if (row.identity.inputs_sha256 != own.identity.inputs_sha256) return differs(names::kInputsSha);
    if (row.status != own.status) differs(names::kStatus);
    const std::tuple<const names::Field*, std::size_t, std::size_t> counts[] = {
        {&names::kSites, row.sites, own.sites},
        {&names::kTriangleCount, row.triangles, own.triangles},
        {&names::kVertexCount, row.voronoi_vertices, own.voronoi_vertices},
        {&names::kPolygonCount, row.polygons, own.polygons},
        {&names::kInlets, row.inlets, own.inlets},
        {&names::kOutlets, row.outlets, own.outlets},
        {&names::kLineCount, row.centerlines, own.centerlines},
        {&names::kGenus, row.genus, own.genus},
        {&names::kLoopCount, row.loops, own.loops},
        {&names::kUnreached, row.unreached_sites, own.unreached_sites},
        {&names::kWarnings, row.warnings, own.warnings}};
    for (const auto& [field, a, b] : counts)
        if (a != b) differs(*field);
    const std::tuple<const names::Field*, double, double> numbers[] = {
        {&names::kLineLength, row.length, own.length},
        {&names::kRadiusMin, row.radius_min, own.radius_min},
        {&names::kRadiusMean, row.radius_mean, own.radius_mean},
        {&names::kRadiusMax, row.radius_max, own.radius_max}};
    for (const auto& [field, a, b] : numbers)
        if (own.centerlines > 0 && a != b) differs(*field);
}

void check_index(const std::filesystem::path& path, Validation& result) {
    const std::string label = path.string();
    const ArchiveFile file(path);
    Inspection index(file, label, index_specification(), result);
    ++result.files;
    std::string unit = "unknown";
    guarded(result, label, [&] { unit = common_unit(file); });
    check_structure(index, index_attributes(), false, unit);
    check_values(index);
    check_failures(index);
    check_ids(index);
    if (!index.is_sound(names::kId.path)) return;
    std::map<std::string, ModelSummary> rows;
    guarded(result, label, [&] {
        for (ModelSummary& row : read_index(path)) rows.emplace(row.identity.id, std::move(row));
    });
    const bool packed = file.attribute("/", names::kPackedAttribute).has_value();
    for (const std::string& id : index.strings(names::kId.path)) {
        const std::string own = packed ? label + ", model '" + id + "'" : model_path(path.parent_path(), id).string();
        guarded(result, own, [&] { check_model(open_model(path, id), id, own, result); });
        if (packed || !rows.contains(id)) continue;
        try {
            check_row(index, rows.at(id), read_summary(model_path(path.parent_path(), id)));
        } catch (const ArchiveError&) {
            // What is wrong with the file has been said.
        }
    }
}

}  // namespace

Validation validate_archive(const std::filesystem::path& archive) {
    Validation result;
    const std::filesystem::path path = index_or_file(archive);
    guarded(result, path.string(), [&] {
        const ArchiveFile file(path);
        if (file.format() == names::kCohortFormat) return check_index(path, result);
        check_model(file, text_of(file, "id"), path.string(), result);
    });
    return result;
}

}  // namespace lumenline
