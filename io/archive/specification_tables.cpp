// The tables of branches, in the model file and in the index, and the index. Columns come from where they are defined
// (engine/core/branch_tables.cpp); what they may hold is said here for those that hold more than plain quantities.

#include <algorithm>
#include <array>

#include "engine/core/branch_tables.h"
#include "engine/core/index_tables.h"
#include "io/archive/index_names.h"
#include "io/archive/specification.h"

namespace lumenline {

namespace {

using namespace rules;

struct ColumnRule {
    std::string_view table, column;  ///< the column's name, or its beginning where it ends in '*'
    Rule rule;
};

constexpr ColumnRule kColumnRules[] = {
    {"", "branch_id", index_or_none('B')},
    {"branches", "parent", index_or_none('B')},
    {"bifurcations", "parent", index_or_none('B')},
    {"bifurcations", "child_*", index_or_none('B')},
    {"bifurcations", "junction_id", index('X')},
    {"bifurcation_children", "junction_id", index('X')},
    {"bifurcation_children", "parent", index_or_none('B')},
    {"bifurcation_children", "child", index('B')},
    {"bifurcation_children", "at_last_node", code(1)},
    {"bifurcation_children", "in_plane", or_none(within(-360, 360))},
    {"bifurcation_children", "out_of_plane", or_none(within(-90, 90))},
    {"", "branch_label_confidence", or_none(share())},
    {"sections", "abscissa_relative", or_none(share())},
    {"bifurcations", "node", index('G')},
    {"branches", "first_node", index('G')},
    {"branches", "last_node", index('G')},
    {"sections", "closed", code(1)},
    {"endpoints", "kind", words("boundary|cap|tip|point")},
    {"endpoints", "role", words("inlet|outlet")},
    // Quantities with a sign.
    {"", "*_x", or_none(finite())},
    {"", "*_y", or_none(finite())},
    {"", "*_z", or_none(finite())},
    {"branches", "torsion_*", or_none(finite())},
    {"branches", "taper", or_none(finite())},
    {"branches", "tortuosity", or_none(within(-1e-9, Rule().high))},
    {"branches", "volume", or_none(finite())},
    {"branches", "normalized_tangency_deviation_mean", or_none(share())},
    {"patches", "normalized_tangency_deviation_mean", or_none(share())},
    {"bifurcations", "in_plane_*", or_none(within(-360, 360))},
    {"bifurcations", "out_of_plane_*", or_none(within(-90, 90))},
    {"bifurcations", "planarity", or_none(within(-90, 90))},
    {"bifurcations", "murray_exponent", or_none(finite())},
    {"stenoses", "nascet_*", or_none(finite())},
    {"stenoses", "ecst_*", or_none(finite())},
};

bool matches(std::string_view pattern, std::string_view name) {
    if (pattern.ends_with('*')) return name.starts_with(pattern.substr(0, pattern.size() - 1));
    if (pattern.starts_with('*')) return name.ends_with(pattern.substr(1));
    return pattern == name;
}

Rule rule_of(std::string_view table, const Column& column) {
    for (const ColumnRule& known : kColumnRules)
        if ((known.table.empty() || known.table == table) && matches(known.column, column.name)) return known.rule;
    if (column.kind == ColumnKind::kText) return text();
    return column.kind == ColumnKind::kIndex ? count() : or_none(not_negative());
}

constexpr const char* kDouble = "float64";
constexpr const char* kInt = "int32";
constexpr const char* kText = "string";

struct Row {
    const names::Field& field;
    const char* shape;
    const char* type;
    Rule rule;
};

// clang-format off
const Row kModels[] = {
    {names::kId, "A", kText, text()},
    {names::kStatus, "A", kText, words("ok|warning|failed")},
    {names::kSubject, "A", kText, text()},
    {names::kSession, "A", kText, text()},
    {names::kSide, "A", kText, text()},
    {names::kStructure, "A", kText, text()},
    {names::kGroup, "A", kText, text()},
    {names::kLengthUnit, "A", kText, text()},
    {names::kCoordinates, "A", kText, words("LPS|RAS|unknown")},
    {names::kSourceFile, "A", kText, text()},
    {names::kSourceSha, "A", kText, text()},
    {names::kInputsSha, "A", kText, text()},
    {names::kSites, "A", kInt, count()},
    {names::kTriangleCount, "A", kInt, count()},
    {names::kVertexCount, "A", kInt, count()},
    {names::kPolygonCount, "A", kInt, count()},
    {names::kInlets, "A", kInt, count()},
    {names::kOutlets, "A", kInt, count()},
    {names::kLineCount, "A", kInt, count()},
    {names::kLineLength, "A", kDouble, or_none(positive())},
    {names::kRadiusMin, "A", kDouble, or_none(positive())},
    {names::kRadiusMean, "A", kDouble, or_none(positive())},
    {names::kRadiusMax, "A", kDouble, or_none(positive())},
};
const Row kMoreOfModels[] = {
    {names::kGenus, "A", kInt, count()},
    {names::kLoopCount, "A", kInt, count()},
    {names::kUnreached, "A", kInt, count()},
    {names::kDiagonal, "A", kDouble, or_none(positive())},
    {names::kEdgeOverRadius, "A", kDouble, or_none(positive())},
    {names::kSizeNote, "A", kText, text()},
    {names::kWarnings, "A", kInt, count()},
    {names::kFailureStage, "A", kText, text()},
    {names::kFailureCode, "A", kText, text()},
};
const Row kRest[] = {
    {names::kFailedId, "F", kText, text()},
    {names::kFailedStage, "F", kText, text()},
    {names::kFailedCode, "F", kText, text()},
    {names::kFailedSentence, "F", kText, text()},
    {names::kConfigGiven, "", kText, text()},
    {names::kConfigResolved, "", kText, text()},
    {names::kDictionaryTable, "K", kText, text()},
    {names::kDictionaryColumn, "K", kText, text()},
    {names::kDictionaryType, "K", kText, words("float64|int32|string")},
    {names::kDictionaryUnit, "K", kText, text()},
    {names::kDictionaryDefinition, "K", kText, text()},
    {names::kDictionarySource, "K", kText, text()},
    {names::kSecondsId, "A", kText, text()},
    {names::kSeconds, "A", kDouble, not_negative()},
    {names::kFileBytes, "A", kDouble, or_none(not_negative())},
    {names::kFileTime, "A", kDouble, or_none(finite())},
};
// clang-format on

/// Lengths of the tables of an index, in the order of index_tables().
constexpr const char kTableRows[] = "BXURYZO";

void add(std::vector<Specified>& all, const Row& row) {
    all.push_back({row.field.path, row.shape, row.type, row.field.units, Part::kAlways, row.rule});
}

std::vector<Specified> made() {
    std::vector<Specified> all;
    for (const Row& row : kModels) add(all, row);
    for (const names::StatisticsColumn& c : names::kStatisticsColumns)
        add(all, {c.field, "A", kDouble, or_none(not_negative())});
    for (const Row& row : kMoreOfModels) add(all, row);
    all.push_back({std::string(names::kAnyCovariate), "A", "float64 or string", "1", Part::kAlways, any()});
    std::vector<Table> tables = index_tables(Branches(), Endpoints());
    for (std::size_t t = 0; t < tables.size(); ++t) {
        const std::string prefix = std::string("/tables/") + tables[t].name + "/";
        const std::string id = prefix + "id";
        all.push_back({id, std::string(1, kTableRows[t]), kText, "1", Part::kAlways, text()});
        add_columns(all, prefix, tables[t], kTableRows[t], Part::kAlways, false);
    }
    for (const Row& row : kRest) add(all, row);
    return all;
}

}  // namespace

void add_columns(std::vector<Specified>& specification, const std::string& prefix, const Table& table, char rows,
                 Part part, bool with_indices) {
    for (const Column& column : table.columns) {
        Rule rule = rule_of(table.name, column);
        if (!with_indices) rule.index_of = '\0';
        const char* const type = column.kind == ColumnKind::kText    ? kText
                                 : column.kind == ColumnKind::kIndex ? kInt
                                                                     : kDouble;
        specification.push_back({prefix + column.name, std::string(1, rows), type, column.unit, part, rule});
    }
}

const std::vector<Specified>& index_specification() {
    static const std::vector<Specified> all = made();
    return all;
}

const std::vector<SpecifiedAttribute>& index_attributes() {
    static const std::vector<SpecifiedAttribute> all{
        {"/", "format", "string"}, {"/", "format_version", "int32"}, {"/", "lumenline_version", "string"}};
    return all;
}

}  // namespace lumenline
