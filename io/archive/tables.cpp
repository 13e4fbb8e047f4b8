// A column that a file does not have, since an earlier version wrote it, is read as missing values.
#include "io/archive/tables.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/core/text.h"
#include "io/archive/branch_names.h"

namespace lumenline::hdf {

void write_scalars(Writer& writer, const names::Field& field, const std::vector<double>& values, std::size_t expected,
                   const ArchiveOptions& options) {
    if (values.size() != expected)
        throw Inconsistent(std::string(field.path) + " has " + counted(values.size(), "value") +
                           " where the record asks for " + std::to_string(expected));
    const hsize_t length = expected;
    const Rows rows{values.data(), expected};
    writer.numbers(field, {&length, 1}, Number::kFloat64, options.float32_fields ? Number::kFloat32 : Number::kFloat64,
                   {&rows, 1});
}

namespace {

void write_graph(Writer& writer, const BranchGraph& graph) {
    const std::size_t nodes = graph.node_count();
    writer.column(names::kNodePosition, graph.position);
    writer.column(names::kNodeRadius, graph.radius, nodes);
    std::vector<std::string> kinds;
    for (const JunctionId j : graph.junction) kinds.emplace_back(j.is_none() ? "end" : "junction");
    writer.strings(names::kNodeKind, kinds);
    writer.column(names::kNodeEndpoint, graph.endpoint, nodes);
    writer.column(names::kNodeJunction, graph.junction, nodes);
    writer.column(names::kEdges, graph.edges);
}

void write_axes(Writer& writer, const BranchLines& axes, std::size_t branches) {
    writer.column(names::kAxisOffsets, axes.offsets, branches + 1);
    const std::size_t points = axes.offsets.back();
    writer.column(names::kAxisPoints, axes.points, points);
    writer.column(names::kAxisRadius, axes.radius, points);
    writer.column(names::kAxisAbscissa, axes.abscissa, points);
    writer.column(names::kAxisCurvature, axes.curvature, points);
    writer.column(names::kAxisTorsion, axes.torsion, points);
    writer.column(names::kAxisTangent, axes.tangent, points);
    writer.column(names::kAxisNormal, axes.normal, points);
    writer.column(names::kAxisFrame, axes.frame, points);
}

void write_points(Writer& writer, const LineBranches& b, std::size_t points) {
    writer.column(names::kLineBranch, b.branch, points);
    writer.column(names::kLineJunction, b.junction, points);
    writer.column(names::kLineBranchAbscissa, b.branch_abscissa, points);
    writer.column(names::kLineCurvature, b.curvature, points);
    writer.column(names::kLineTorsion, b.torsion, points);
    writer.column(names::kLineTangent, b.tangent, points);
    writer.column(names::kLineFrame, b.frame, points);
}

}  // namespace

void write_table(Writer& writer, const std::string& group, const Table& table) {
    const std::size_t rows = table.rows();
    for (const Column& column : table.columns) {
        const std::string path = group + "/" + column.name;
        const names::Field field{path.c_str(), column.unit, column.definition.c_str()};
        if (column.rows() != rows)
            throw Inconsistent(path + " has " + std::to_string(column.rows()) + " rows, the table " +
                               std::to_string(rows));
        if (column.kind == ColumnKind::kText)
            writer.strings(field, column.texts);
        else if (column.kind == ColumnKind::kIndex)
            writer.column(field, std::vector<std::int32_t>(column.numbers.begin(), column.numbers.end()));
        else
            writer.column(field, column.numbers);
        if (column.source[0] != '\0') writer.attribute(path, "source", column.source);
    }
}

void write_branches(Writer& writer, const Branches& branches, std::size_t sites, std::size_t points,
                    const ArchiveOptions& options) {
    write_graph(writer, branches.graph);
    write_axes(writer, branches.lines, branches.graph.branch_count());
    write_points(writer, branches.points, points);
    if (const SurfaceBranches& s = branches.surface; !s.branch.empty() && options.fields != ArchiveFields::kLines) {
        writer.column(names::kSiteBranch, s.branch, sites);
        writer.column(names::kSiteJunction, s.junction, sites);
        write_scalars(writer, names::kSiteLongitudinal, s.longitudinal, sites, options);
        write_scalars(writer, names::kSiteRelative, s.relative, sites, options);
        write_scalars(writer, names::kSiteAngle, s.angle, sites, options);
    }
    for (const Table& table : branch_tables(branches)) write_table(writer, std::string("/") + table.name, table);
}

bool is_index(double value) {
    return value >= -1 && value <= std::numeric_limits<std::int32_t>::max() && value == std::floor(value);
}

bool read_table(const ArchiveFile& file, const std::string& group, Table& table) {
    if (!file.has(group)) return false;
    const auto damaged = [&](const std::string& reason) {
        throw ArchiveError("cannot use '" + file.file().string() + "': the columns of " + group + " " + reason);
    };
    std::size_t rows = 0;
    for (const Column& column : table.columns)
        if (const std::string path = group + "/" + column.name; file.has(path)) {
            const std::vector<std::uint64_t> shape = file.shape(path);
            if (shape.size() != 1) damaged("have rows of several numbers");
            rows = shape[0];
            break;
        }
    for (Column& column : table.columns) {
        const std::string path = group + "/" + column.name;
        if (!file.has(path)) {
            column.numbers.assign(column.kind == ColumnKind::kText ? 0 : rows,
                                  column.kind == ColumnKind::kIndex ? -1 : std::numeric_limits<double>::quiet_NaN());
            column.texts.assign(column.kind == ColumnKind::kText ? rows : 0, "");
        } else if (column.kind == ColumnKind::kText) {
            column.texts = file.strings(path);
        } else {
            column.numbers = file.numbers(path);
        }
        if (column.rows() != rows) damaged("are not of one length");
        if (column.kind == ColumnKind::kIndex && !std::all_of(column.numbers.begin(), column.numbers.end(), is_index))
            damaged("hold an index that is none");
    }
    return true;
}

}  // namespace lumenline::hdf
