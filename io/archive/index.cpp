// A covariate's name comes from a table's header and becomes a dataset's name, which must not
// contain a slash, be "." or collide with a column of ours or of another covariate. Such a name is
// changed (`covariate_` in front, slashes to underscores, a number behind), and the attribute
// `column` of each covariate says what it was.

#include "io/archive/index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <system_error>

#include "engine/core/data_table.h"
#include "engine/core/size_note.h"
#include "engine/core/version.h"
#include "io/archive/file_stamp.h"
#include "io/archive/index_names.h"
#include "io/archive/index_rows.h"
#include "io/archive/model_file.h"
#include "io/archive/utf8.h"
#include "io/archive/writer.h"

namespace lumenline {

namespace {

using hdf::Writer;
using Models = std::span<const ModelSummary>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

template <class Read>
void text_column(Writer& writer, const names::Field& field, Models models, Read read) {
    std::vector<std::string> column;
    column.reserve(models.size());
    for (const ModelSummary& model : models) column.emplace_back(read(model));
    writer.strings(field, column);
}

void identity_column(Writer& writer, const names::Field& field, Models models, std::string ModelIdentity::*member) {
    text_column(writer, field, models, [member](const ModelSummary& model) { return model.identity.*member; });
}

void count_column(Writer& writer, const names::Field& field, Models models, std::size_t ModelSummary::*member) {
    std::vector<std::uint32_t> column;
    column.reserve(models.size());
    for (const ModelSummary& model : models) column.push_back(static_cast<std::uint32_t>(model.*member));
    writer.column(field, column);
}

void length_column(Writer& writer, const names::Field& field, Models models, double ModelSummary::*member) {
    std::vector<double> column;
    column.reserve(models.size());
    for (const ModelSummary& model : models) column.push_back(model.centerlines > 0 ? model.*member : kNaN);
    writer.column(field, column);
}

void write_links(Writer& writer, Models models) {
    writer.group(names::kModelLinks);
    std::set<std::string_view> seen;
    for (const ModelSummary& model : models) {
        const std::string& id = model.identity.id;
        if (id.empty() || id == "." || id == ".." || id.find('/') != std::string::npos || valid_text(id) != id)
            throw hdf::Inconsistent("the model id '" + printable(id) + "' is no file name");
        if (!seen.insert(id).second) throw hdf::Inconsistent("the model id '" + id + "' appears twice");
        writer.external_link(std::string(names::kModelLinks) + "/" + id, "models/" + id + ".hdf");
    }
}

/// The unit of all models' lengths.
std::string common_unit(Models models) {
    std::string unit = models.empty() ? "unknown" : models.front().identity.length_unit;
    for (const ModelSummary& model : models)
        if (model.identity.length_unit != unit) return "mixed";
    return unit;
}

void write_sizes(Writer& writer, Models models) {
    std::vector<double> diagonals;
    for (const ModelSummary& model : models) diagonals.push_back(model.diagonal > 0 ? model.diagonal : kNaN);
    writer.column(names::kDiagonal, diagonals);
    length_column(writer, names::kEdgeOverRadius, models, &ModelSummary::edge_over_radius);
    writer.strings(names::kSizeNote, size_notes(diagonals, common_unit(models)));
}

void write_models(Writer& writer, Models models) {
    identity_column(writer, names::kId, models, &ModelIdentity::id);
    text_column(writer, names::kStatus, models, [](const ModelSummary& m) { return status_name(m.status); });
    identity_column(writer, names::kSubject, models, &ModelIdentity::subject);
    identity_column(writer, names::kSession, models, &ModelIdentity::session);
    identity_column(writer, names::kSide, models, &ModelIdentity::side);
    identity_column(writer, names::kStructure, models, &ModelIdentity::structure);
    identity_column(writer, names::kGroup, models, &ModelIdentity::group);
    identity_column(writer, names::kLengthUnit, models, &ModelIdentity::length_unit);
    identity_column(writer, names::kCoordinates, models, &ModelIdentity::coordinate_system);
    identity_column(writer, names::kSourceFile, models, &ModelIdentity::source_file);
    identity_column(writer, names::kSourceSha, models, &ModelIdentity::source_sha256);
    identity_column(writer, names::kInputsSha, models, &ModelIdentity::inputs_sha256);
    count_column(writer, names::kSites, models, &ModelSummary::sites);
    count_column(writer, names::kTriangleCount, models, &ModelSummary::triangles);
    count_column(writer, names::kVertexCount, models, &ModelSummary::voronoi_vertices);
    count_column(writer, names::kPolygonCount, models, &ModelSummary::polygons);
    count_column(writer, names::kInlets, models, &ModelSummary::inlets);
    count_column(writer, names::kOutlets, models, &ModelSummary::outlets);
    count_column(writer, names::kLineCount, models, &ModelSummary::centerlines);
    length_column(writer, names::kLineLength, models, &ModelSummary::length);
    length_column(writer, names::kRadiusMin, models, &ModelSummary::radius_min);
    length_column(writer, names::kRadiusMean, models, &ModelSummary::radius_mean);
    length_column(writer, names::kRadiusMax, models, &ModelSummary::radius_max);
    for (const names::StatisticsColumn& c : names::kStatisticsColumns) {
        std::vector<double> column;
        for (const ModelSummary& model : models) column.push_back(model.*c.quantity.*c.value);
        writer.column(c.field, column);
    }
    count_column(writer, names::kGenus, models, &ModelSummary::genus);
    count_column(writer, names::kLoopCount, models, &ModelSummary::loops);
    count_column(writer, names::kUnreached, models, &ModelSummary::unreached_sites);
    write_sizes(writer, models);
    count_column(writer, names::kWarnings, models, &ModelSummary::warnings);
    text_column(writer, names::kFailureStage, models,
                [](const ModelSummary& m) { return m.failure ? stage_name(m.failure->stage) : ""; });
    text_column(writer, names::kFailureCode, models,
                [](const ModelSummary& m) { return m.failure ? error_name(m.failure->code) : ""; });
}

/// Name of a covariate's dataset in the table of models, unlike all in `taken`, to which it is added.
std::string dataset_name(const std::string& column, std::set<std::string>& taken) {
    std::string name = valid_text(column);
    std::replace(name.begin(), name.end(), '/', '_');
    if (name != column || name.empty() || name == "." || name == ".." || taken.contains(name))
        name = "covariate_" + name;
    std::string candidate = name;
    for (int n = 2; !taken.insert(candidate).second; ++n) candidate = name + "_" + std::to_string(n);
    return candidate;
}

/// Names of our own columns, and of those that a printed list of the models has beside them.
std::set<std::string> own_columns() {
    std::set<std::string> own{"lines", "seconds"};
    const std::string prefix = std::string(names::kModelTable) + "/";
    for (const names::Field& field :
         {names::kId,           names::kStatus,         names::kSubject,     names::kSession,
          names::kSide,         names::kStructure,      names::kGroup,       names::kLengthUnit,
          names::kCoordinates,  names::kSourceFile,     names::kSourceSha,   names::kInputsSha,
          names::kSites,        names::kTriangleCount,  names::kVertexCount, names::kPolygonCount,
          names::kInlets,       names::kOutlets,        names::kLineCount,   names::kLineLength,
          names::kUnreached,    names::kRadiusMin,      names::kRadiusMean,  names::kRadiusMax,
          names::kDiagonal,     names::kEdgeOverRadius, names::kSizeNote,    names::kWarnings,
          names::kFailureStage, names::kFailureCode})
        own.insert(std::string(field.path).substr(prefix.size()));
    for (const names::StatisticsColumn& c : names::kStatisticsColumns)
        own.insert(std::string(c.field.path).substr(prefix.size()));
    return own;
}

void write_covariates(Writer& writer, Models models) {
    std::vector<std::string> order;
    std::map<std::string, std::vector<std::string>> columns;
    for (std::size_t row = 0; row < models.size(); ++row)
        for (const auto& [name, value] : models[row].identity.covariates) {
            const auto [column, is_new] = columns.try_emplace(name, models.size());
            if (is_new) order.push_back(name);
            column->second[row] = value;
        }
    std::set<std::string> taken = own_columns();
    for (const std::string& name : order) {
        const std::string path = std::string(names::kModelTable) + "/" + dataset_name(name, taken);
        const names::Field field{path.c_str(), "1", names::kCovariateDescription};
        const std::vector<std::string>& values = columns.at(name);
        std::vector<double> numbers;
        for (const std::string& value : values) {
            const std::optional<double> number = is_missing(value) ? kNaN : number_of(value);
            if (!number) break;
            numbers.push_back(*number);
        }
        if (numbers.size() == values.size())
            writer.column(field, numbers);
        else
            writer.strings(field, values);
        writer.attribute(path, "column", name);
    }
}

void write_failures(Writer& writer, Models models) {
    std::vector<ModelSummary> failed;
    std::copy_if(models.begin(), models.end(), std::back_inserter(failed),
                 [](const ModelSummary& model) { return model.failure.has_value(); });
    identity_column(writer, names::kFailedId, failed, &ModelIdentity::id);
    text_column(writer, names::kFailedStage, failed, [](const auto& m) { return stage_name(m.failure->stage); });
    text_column(writer, names::kFailedCode, failed, [](const auto& m) { return error_name(m.failure->code); });
    text_column(writer, names::kFailedSentence, failed, [](const auto& m) { return m.failure->sentence; });
}

/// What tells later whether a file is still the one that its row was made from.
void write_file_stamps(Writer& writer, const std::filesystem::path& archive_dir, Models models) {
    std::vector<double> bytes, times;
    for (const ModelSummary& model : models) {
        const FileStamp stamp = stamp_of(model_path(archive_dir, model.identity.id));
        bytes.push_back(stamp.bytes);
        times.push_back(stamp.time);
    }
    writer.column(names::kFileBytes, bytes);
    writer.column(names::kFileTime, times);
}

void write_seconds(Writer& writer, Models models) {
    identity_column(writer, names::kSecondsId, models, &ModelIdentity::id);
    std::vector<double> seconds;
    for (const ModelSummary& model : models) seconds.push_back(model.seconds);
    writer.column(names::kSeconds, seconds);
}

}  // namespace

std::vector<std::string> write_index(const std::filesystem::path& archive_dir, std::span<const ModelSummary> models,
                                     std::string_view config_text, std::string_view resolved_config,
                                     const BranchLabeller& label) {
    const std::filesystem::path file = archive_dir / names::kIndexFile;
    const auto refuse = [&](const std::string& reason) {
        throw StageError(Stage::kArchive, ErrorCode::kArchiveWrite,
                         "cannot write the index '" + file.string() + "' (" + reason +
                             "): check the directory, its permissions and the free space");
    };
    const hdf::Quiet quiet;
    try {
        Writer writer(file, common_unit(models));
        writer.attribute("/", "format", names::kCohortFormat);
        writer.attribute("/", "format_version", names::kFormatVersion);
        writer.attribute("/", "lumenline_version", version());
        write_links(writer, models);
        write_models(writer, models);
        write_covariates(writer, models);
        write_failures(writer, models);
        std::vector<std::string> unread = hdf::write_branch_tables(writer, archive_dir, models, label);
        hdf::write_dictionary(writer);
        writer.text(names::kConfigGiven, config_text);
        writer.text(names::kConfigResolved, resolved_config);
        write_seconds(writer, models);
        write_file_stamps(writer, archive_dir, models);
        writer.commit();
        return unread;
    } catch (const hdf::Inconsistent& error) {
        throw StageError(Stage::kArchive, ErrorCode::kInternal,
                         "the index '" + file.string() + "' cannot be made: " + error.what());
    } catch (const hdf::Error& error) {
        refuse(error.what());
    } catch (const std::system_error& error) {
        refuse(error.what());
    }
    return {};
}

}  // namespace lumenline
