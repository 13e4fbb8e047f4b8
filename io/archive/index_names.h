#pragma once

#include "engine/core/model_record.h"
#include "io/archive/names.h"

/// Every name of the index `cohort.h5` (io/ARCHIVE.md), format version 1.
namespace lumenline::names {

inline constexpr const char* kIndexFile = "cohort.h5";
inline constexpr const char* kModelLinks = "/models";
inline constexpr const char* kPackedAttribute = "packed";  ///< models are groups of the file, not links to others
inline constexpr const char* kModelTable = "/tables/models";

// clang-format off
inline constexpr Field kId{"/tables/models/id", "1", "name of the model"};
inline constexpr Field kStatus{"/tables/models/status", "1", "ok | warning | failed"};
inline constexpr Field kSubject{"/tables/models/subject", "1", "as the configuration states it"};
inline constexpr Field kSession{"/tables/models/session", "1", "as the configuration states it"};
inline constexpr Field kSide{"/tables/models/side", "1", "as the configuration states it"};
inline constexpr Field kStructure{"/tables/models/structure", "1", "as the configuration states it"};
inline constexpr Field kGroup{"/tables/models/group", "1", "as the configuration states it"};
inline constexpr Field kLengthUnit{"/tables/models/length_unit", "1", "unit of the model's lengths"};
inline constexpr Field kCoordinates{"/tables/models/coordinate_system", "1", "LPS | RAS | unknown"};
inline constexpr Field kSourceFile{"/tables/models/source_file", "1", "surface, as given"};
inline constexpr Field kSourceSha{"/tables/models/source_sha256", "1", "of the surface's bytes"};
inline constexpr Field kInputsSha{"/tables/models/inputs_sha256", "1", "of all that determines the result"};
inline constexpr Field kSites{"/tables/models/sites", "1", "vertices of the conditioned surface"};
inline constexpr Field kTriangleCount{"/tables/models/triangles", "1", "triangles of the conditioned surface"};
inline constexpr Field kVertexCount{"/tables/models/voronoi_vertices", "1", "inner Voronoi vertices"};
inline constexpr Field kPolygonCount{"/tables/models/polygons", "1", "Voronoi polygons and bare edges"};
inline constexpr Field kInlets{"/tables/models/inlets", "1", "endpoints of role inlet"};
inline constexpr Field kOutlets{"/tables/models/outlets", "1", "endpoints of role outlet"};
inline constexpr Field kLineCount{"/tables/models/centerlines", "1", "traced centerlines"};
inline constexpr Field kLineLength{"/tables/models/length", "length",
    "sum of the centerlines' lengths, shared stretches counted for each; NaN = no centerline"};
inline constexpr Field kRadiusMin{"/tables/models/radius_min", "length", "least radius; NaN = no centerline"};
inline constexpr Field kRadiusMean{"/tables/models/radius_mean", "length",
    "mean radius along the centerlines, weighted by arc length; NaN = no centerline"};
inline constexpr Field kRadiusMax{"/tables/models/radius_max", "length", "largest radius; NaN = no centerline"};
/// A statistic of the surface's characterization.
struct StatisticsColumn {
    Field field;
    AreaStatistics ModelSummary::*quantity;
    double AreaStatistics::*value;
};
inline constexpr StatisticsColumn kStatisticsColumns[] = {
    {{"/tables/models/geodesic_distance_mean", "length", "mean of D_g over the wall, weighted by area; NaN = not characterized"},
     &ModelSummary::geodesic_distance, &AreaStatistics::mean},
    {{"/tables/models/geodesic_distance_sd", "length", "standard deviation of D_g over the wall, weighted by area; NaN = not characterized"},
     &ModelSummary::geodesic_distance, &AreaStatistics::sd},
    {{"/tables/models/geodesic_distance_median", "length", "median of D_g over the wall, weighted by area; NaN = not characterized"},
     &ModelSummary::geodesic_distance, &AreaStatistics::median},
    {{"/tables/models/geodesic_distance_p95", "length", "95th percentile of D_g over the wall, weighted by area; NaN = not characterized"},
     &ModelSummary::geodesic_distance, &AreaStatistics::p95},
    {{"/tables/models/euclidean_distance_mean", "length", "mean of D_e over the wall, weighted by area; NaN = not characterized"},
     &ModelSummary::euclidean_distance, &AreaStatistics::mean},
    {{"/tables/models/euclidean_distance_sd", "length", "standard deviation of D_e over the wall, weighted by area; NaN = not characterized"},
     &ModelSummary::euclidean_distance, &AreaStatistics::sd},
    {{"/tables/models/euclidean_distance_median", "length", "median of D_e over the wall, weighted by area; NaN = not characterized"},
     &ModelSummary::euclidean_distance, &AreaStatistics::median},
    {{"/tables/models/euclidean_distance_p95", "length", "95th percentile of D_e over the wall, weighted by area; NaN = not characterized"},
     &ModelSummary::euclidean_distance, &AreaStatistics::p95},
    {{"/tables/models/normalized_tangency_deviation_mean", "1", "mean of NTD over the wall, weighted by area; NaN = not characterized"},
     &ModelSummary::normalized_tangency_deviation, &AreaStatistics::mean},
    {{"/tables/models/normalized_tangency_deviation_sd", "1", "standard deviation of NTD over the wall, weighted by area; NaN = not characterized"},
     &ModelSummary::normalized_tangency_deviation, &AreaStatistics::sd},
    {{"/tables/models/normalized_tangency_deviation_median", "1", "median of NTD over the wall, weighted by area; NaN = not characterized"},
     &ModelSummary::normalized_tangency_deviation, &AreaStatistics::median},
    {{"/tables/models/normalized_tangency_deviation_p95", "1", "95th percentile of NTD over the wall, weighted by area; NaN = not characterized"},
     &ModelSummary::normalized_tangency_deviation, &AreaStatistics::p95},
};
inline constexpr Field kGenus{"/tables/models/genus", "1", "handles of the conditioned surface"};
inline constexpr Field kLoopCount{"/tables/models/loops", "1",
    "loops of the lumen that fronts run around, covered by lines or not"};
inline constexpr Field kUnreached{"/tables/models/unreached_sites", "1", "sites of the wall with no way to a centerline"};
inline constexpr Field kDiagonal{"/tables/models/diagonal", "length",
    "of the bounding box of the wall; NaN = no surface was made"};
inline constexpr Field kEdgeOverRadius{"/tables/models/edge_over_radius", "1",
    "median edge of the wall over the median radius along the centerlines; NaN = no centerline"};
inline constexpr Field kSizeNote{"/tables/models/size_note", "1",
    "what an unusual size says of the model's unit; empty = nothing"};
inline constexpr Field kWarnings{"/tables/models/warnings", "1", "diagnostics of severity warning or error"};
inline constexpr Field kFailureStage{"/tables/models/failure_stage", "1", "stage that failed; empty = none"};
inline constexpr Field kFailureCode{"/tables/models/failure_code", "1", "why, as a stable name; empty = not failed"};
inline constexpr const char* kCovariateDescription = "covariate, as the cohort's table states it";

inline constexpr Field kFailedId{"/tables/failures/id", "1", "name of the model"};
inline constexpr Field kFailedStage{"/tables/failures/stage", "1", "stage that failed"};
inline constexpr Field kFailedCode{"/tables/failures/code", "1", "why, as a stable name"};
inline constexpr Field kFailedSentence{"/tables/failures/sentence", "1", "why, in one sentence"};

inline constexpr Field kDictionaryTable{"/dictionary/table", "1", "table below /tables"};
inline constexpr Field kDictionaryColumn{"/dictionary/column", "1", "its column"};
inline constexpr Field kDictionaryType{"/dictionary/type", "1", "float64 | int32 | string"};
inline constexpr Field kDictionaryUnit{"/dictionary/unit", "1", "of the values; 1 = none"};
inline constexpr Field kDictionaryDefinition{"/dictionary/definition", "1", "what the values are"};
inline constexpr Field kDictionarySource{"/dictionary/source", "1", "publication that the definition follows; empty = none"};

inline constexpr Field kConfigGiven{"/config/given", "1", "configuration, as given"};
inline constexpr Field kConfigResolved{"/config/resolved", "1", "configuration, with all defaults and paths resolved"};

inline constexpr Field kSecondsId{"/timing/id", "1", "name of the model"};
inline constexpr Field kSeconds{"/timing/seconds", "s", "time of work on the model, without waiting"};
inline constexpr Field kFileBytes{"/timing/file_bytes", "B", "size of the model's file; NaN = it has none"};
inline constexpr Field kFileTime{"/timing/file_time", "s", "when the file was last written, since 1970; NaN = it has none"};
// clang-format on

}  // namespace lumenline::names
