// The model file: io/ARCHIVE.md as data. A test holds the two against each other, so that neither can change alone.

#include "io/archive/specification.h"

#include "engine/core/branch_tables.h"
#include "io/archive/branch_names.h"
#include "io/archive/line_names.h"

namespace lumenline {

namespace {

using namespace rules;
using enum Part;

constexpr const char* kDouble = "float64";
constexpr const char* kScalar = "float32 or float64";  ///< as the precision was asked for
constexpr const char* kInt = "int32";
constexpr const char* kLong = "int64";
constexpr const char* kByte = "uint8";
constexpr const char* kText = "string";
constexpr double kPi = 3.14159265358979324;

struct Row {
    const names::Field& field;
    const char* shape;
    const char* type;
    Part part;
    Rule rule;
};

// clang-format off
const Row kRows[] = {
    {names::kSurfacePoints, "N, 3", kDouble, kSurface, finite()},
    {names::kTriangles, "M, 3", kInt, kSurface, index('N')},
    {names::kNormals, "N, 3", kDouble, kSurface, unit_or_zero()},
    {names::kInputVertex, "N", kInt, kSurface, {.low = -1, .whole = true}},
    {names::kOrigin, "N", kByte, kSurface, code(2)},
    {names::kCap, "M", kInt, kSurface, index('E', -2)},
    {names::kPole, "N", kInt, kPoles, index_or_none('V')},

    {names::kGeodesic, "N", kScalar, kCharacter, or_none(not_negative())},
    {names::kDescentLength, "N", kScalar, kCharacter, or_none(not_negative())},
    {names::kEuclidean, "N", kScalar, kCharacter, or_none(not_negative())},
    {names::kTangencyDeviation, "N", kScalar, kCharacter, or_none(share())},
    {names::kGeodesicRefined, "N", kScalar, kCharacter, or_none(not_negative())},
    {names::kTangencyDeviationRefined, "N", kScalar, kCharacter, or_none(share())},
    {names::kCenterlinePoint, "N, 3", kDouble, kCharacter, or_none(finite())},
    {names::kCenterlineId, "N", kInt, kCharacter, index_or_none('L')},
    {names::kSiteAbscissa, "N", kScalar, kCharacter, or_none(not_negative())},
    {names::kZone, "N", kByte, kCharacter, code(2)},

    {names::kStatisticsGeodesic, "4", kDouble, kStatistics, or_none(not_negative())},
    {names::kStatisticsEuclidean, "4", kDouble, kStatistics, or_none(not_negative())},
    {names::kStatisticsTangency, "4", kDouble, kStatistics, or_none(share())},
    {names::kWallSites, "", kInt, kStatistics, count()},
    {names::kUnreachedSites, "", kInt, kStatistics, count()},
    {names::kNotRefined, "", kInt, kStatistics, count()},
    {names::kJumps, "3", kInt, kStatistics, count()},

    {names::kEndpointPoint, "E, 3", kDouble, kEndpoints, finite()},
    {names::kEndpointNormal, "E, 3", kDouble, kEndpoints, unit_or_zero()},
    {names::kEndpointRadius, "E", kDouble, kEndpoints, positive()},
    {names::kEndpointKind, "E", kText, kEndpoints, words("boundary|cap|tip|point")},
    {names::kEndpointRole, "E", kText, kEndpoints, words("inlet|outlet")},
    {names::kAnchor, "E, 3", kDouble, kEndpoints, finite()},
    {names::kAnchorRadius, "E", kDouble, kEndpoints, positive()},

    {names::kIndexRows, "Y", kByte, kEndpoints, {}},

    {names::kVertices, "V, 3", kDouble, kVoronoi, finite()},
    {names::kBallRadius, "V", kDouble, kVoronoi, positive()},
    {names::kPolygonOffsets, "P+1", kInt, kVoronoi, offsets('I')},
    {names::kPolygonVertices, "I", kInt, kVoronoi, index('V')},
    {names::kPolygonSites, "P, 2", kInt, kVoronoi, index_or_none('N')},
    {names::kArrivalTime, "S, V", kScalar, kFronts, or_unreached(not_negative())},
    {names::kCenterlineDistance, "V", kScalar, kVertexCharacter, or_unreached(not_negative())},
    {names::kSources, "S", kInt, kFronts, index('E')},
    {names::kReached, "S", kInt, kFronts, count()},
    {names::kResidual, "S", kDouble, kFronts, not_negative()},

    {names::kLinePoints, "K, 3", kDouble, kLines, finite()},
    {names::kLineOffsets, "L+1", kInt, kLines, offsets('K')},
    {names::kLineBallRadius, "K", kDouble, kLines, positive()},
    {names::kClearance, "K", kDouble, kLines, not_negative()},
    {names::kRadius, "K", kDouble, kLines, positive()},
    {names::kRadiusError, "K", kDouble, kLines, not_negative()},
    {names::kPositionError, "K", kDouble, kLines, or_none(not_negative())},
    {names::kAbscissa, "K", kDouble, kLines, rising(names::kLineOffsets)},
    {names::kLineSource, "L", kInt, kLines, index('E')},
    {names::kLineTarget, "L", kInt, kLines, index_or_none('E')},
    {names::kLineLoop, "L", kInt, kLines, index_or_none('H')},
    {names::kPathPoints, "Q, 3", kDouble, kLines, finite()},
    {names::kPathOffsets, "L+1", kInt, kLines, offsets('Q')},
    {names::kPathBallRadius, "Q", kDouble, kLines, positive()},
    {names::kPathAbscissa, "Q", kDouble, kLines, rising(names::kPathOffsets)},
    {names::kLineAbscissa, "Q", kDouble, kLines, rising(names::kPathOffsets)},

    {names::kLoopPoint, "H, 3", kDouble, kLines, finite()},
    {names::kLoopBallRadius, "H", kDouble, kLines, positive()},
    {names::kLoopTime, "H", kDouble, kLines, not_negative()},
    {names::kLoopSource, "H", kInt, kLines, index('E')},

    {names::kNodePosition, "G, 3", kDouble, kBranches, finite()},
    {names::kNodeRadius, "G", kDouble, kBranches, positive()},
    {names::kNodeKind, "G", kText, kBranches, words("end|junction")},
    {names::kNodeEndpoint, "G", kInt, kBranches, index_or_none('E')},
    {names::kNodeJunction, "G", kInt, kBranches, index_or_none('X')},
    {names::kEdges, "B, 2", kInt, kBranches, index('G')},
    {names::kAxisOffsets, "B+1", kInt, kBranches, offsets('J')},
    {names::kAxisPoints, "J, 3", kDouble, kBranches, finite()},
    {names::kAxisRadius, "J", kDouble, kBranches, positive()},
    {names::kAxisAbscissa, "J", kDouble, kBranches, rising(names::kAxisOffsets)},
    {names::kAxisCurvature, "J", kDouble, kBranches, or_none(not_negative())},
    {names::kAxisTorsion, "J", kDouble, kBranches, or_none(finite())},
    {names::kAxisTangent, "J, 3", kDouble, kBranches, unit()},
    {names::kAxisNormal, "J, 3", kDouble, kBranches, unit_or_none()},
    {names::kAxisFrame, "J, 3", kDouble, kBranches, unit()},

    {names::kLineBranch, "K", kInt, kBranches, index('B')},
    {names::kLineJunction, "K", kInt, kBranches, index_or_none('X')},
    {names::kLineBranchAbscissa, "K", kDouble, kBranches, not_negative()},
    {names::kLineCurvature, "K", kDouble, kBranches, or_none(not_negative())},
    {names::kLineTorsion, "K", kDouble, kBranches, or_none(finite())},
    {names::kLineTangent, "K, 3", kDouble, kBranches, unit()},
    {names::kLineFrame, "K, 3", kDouble, kBranches, unit()},
    {names::kSiteBranch, "N", kInt, kSiteBranches, index_or_none('B')},
    {names::kSiteJunction, "N", kInt, kSiteBranches, index_or_none('X')},
    {names::kSiteLongitudinal, "N", kScalar, kSiteBranches, or_none(not_negative())},
    {names::kSiteRelative, "N", kScalar, kSiteBranches, or_none(share())},
    {names::kSiteAngle, "N", kScalar, kSiteBranches, or_none(within(-kPi - 1e-6, kPi + 1e-6))},

    {names::kCovariateName, "C", kText, kAlways, text()},
    {names::kCovariateValue, "C", kText, kAlways, text()},
    {names::kCode, "D", kText, kAlways, text()},
    {names::kSeverity, "D", kText, kAlways, words("note|warning|error")},
    {names::kStage, "D", kText, kAlways, text()},
    {names::kMessage, "D", kText, kAlways, text()},
    {names::kValue, "D", kDouble, kAlways, any()},
    {names::kLimit, "D", kDouble, kAlways, any()},

    {names::kHost, "", kText, kAlways, text()},
    {names::kProgram, "", kText, kAlways, text()},
    {names::kCommit, "", kText, kAlways, text()},
    {names::kCompiler, "", kText, kAlways, text()},
    {names::kHdf5Version, "", kText, kAlways, text()},
    {names::kOptions, "", kText, kAlways, text()},
    {names::kThreads, "", kInt, kAlways, {.low = 1, .whole = true}},
    {names::kTimingStage, "T", kText, kAlways, text()},
    {names::kTimingSeconds, "T", kDouble, kAlways, not_negative()},
    {names::kTotalSeconds, "", kDouble, kAlways, not_negative()},
    {names::kPeakBytes, "", kDouble, kAlways, not_negative()},

    {names::kVtkPointCount, "1", kLong, kVtk, count()},
    {names::kVtkCellCount, "1", kLong, kVtk, count()},
    {names::kVtkIdCount, "1", kLong, kVtk, count()},
    {names::kVtkPoints, "N+K, 3", kDouble, kVtk, finite()},
    {names::kVtkConnectivity, "3M+K", kLong, kVtk, count()},
    {names::kVtkOffsets, "M+L+1", kLong, kVtk, count()},
    {names::kVtkTypes, "M+L", kByte, kVtk, {.low = 4, .high = 5, .whole = true}},
    {names::kVtkPart, "M+L", kByte, kVtk, code(2)},
    {names::kVtkRadius, "N+K", kDouble, kVtk, or_none(positive())},
};

const std::vector<SpecifiedAttribute> kAttributes{
    {"/", "format", "string"}, {"/", "format_version", "int32"}, {"/", "lumenline_version", "string"},
    {"/", "id", "string"}, {"/", "subject", "string"}, {"/", "session", "string"}, {"/", "side", "string"},
    {"/", "structure", "string"}, {"/", "group", "string"}, {"/", "status", "string"},
    {"/", "length_unit", "string"}, {"/", "coordinate_system", "string"}, {"/", "source_file", "string"},
    {"/", "source_sha256", "string"}, {"/", "inputs_sha256", "string"},
    {"/", "fields", "string"},
    {"/", names::kStatedSites, "int32", Presence::kUnlessFailed, 'N'}, {"/", names::kStatedTriangles, "int32", Presence::kUnlessFailed, 'M'},
    {"/", names::kStatedVertices, "int32", Presence::kUnlessFailed, 'V'}, {"/", names::kStatedPolygons, "int32", Presence::kUnlessFailed, 'P'},
    {"/", "failure_stage", "string", Presence::kIfFailed}, {"/", "failure_code", "string", Presence::kIfFailed},
    {"/", "failure_sentence", "string", Presence::kIfFailed}, {"/", "failure_signal", "int32", Presence::kIfFailed},
    {"/surface", "genus", "int32"}, {"/surface", "component_count", "int32"}, {"/surface", "diagonal", "float64"},
    {"/surface", "median_edge", "float64"}, {"/surface", "coordinate_rounding", "float64"},
    {"/VTKHDF", "Version", "int64"}, {"/VTKHDF", "Type", "string"},
};
// clang-format on

/// Lengths of the tables of a model, in the order of branch_tables().
constexpr const char kTableRows[] = "BXURBBW";

std::vector<Specified> made() {
    std::vector<Specified> all;
    for (const Row& row : kRows)
        all.push_back({row.field.path, row.shape, row.type, row.field.units, row.part, row.rule});
    const std::vector<Table> tables = branch_tables(Branches());
    for (std::size_t t = 0; t < tables.size(); ++t)
        add_columns(all, std::string("/") + tables[t].name + "/", tables[t], kTableRows[t], kBranches, true);
    return all;
}

}  // namespace

const std::vector<Specified>& model_specification() {
    static const std::vector<Specified> all = made();
    return all;
}

const std::vector<SpecifiedAttribute>& model_attributes() { return kAttributes; }

}  // namespace lumenline
