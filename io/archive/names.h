#pragma once

#include <string_view>

/// Every name of the model file (io/ARCHIVE.md), format version 1. Those of lines are in line_names.h, those of
/// the index in index_names.h.
namespace lumenline::names {

inline constexpr int kFormatVersion = 1;
inline constexpr std::string_view kModelFormat = "lumenline-model";
inline constexpr std::string_view kCohortFormat = "lumenline-cohort";

/// A dataset: its path, its unit and its meaning, the latter two written beside it as attributes.
struct Field {
    const char* path;
    const char* units;
    const char* description;
};

/// As a unit, or part of one such as "1/length": the model's `length_unit`.
inline constexpr std::string_view kLength = "length";

// clang-format off
inline constexpr const char* kSurface = "/surface";
inline constexpr Field kSurfacePoints{"/surface/points", "length",
    "sites: vertices of the conditioned, closed surface"};
inline constexpr Field kTriangles{"/surface/triangles", "1", "sites of each triangle, counter-clockwise from outside"};
inline constexpr Field kNormals{"/surface/normals", "1", "unit outward normal of each site, angle-weighted"};
inline constexpr Field kInputVertex{"/surface/input_vertex", "1", "vertex of the source file; -1 = added"};
inline constexpr Field kOrigin{"/surface/origin", "1", "0 = wall, 1 = extension of an opening, 2 = cap"};
inline constexpr Field kCap{"/surface/cap", "1",
    "endpoint whose extension or cap the triangle is; -1 = wall, -2 = of an opening that is no endpoint"};
inline constexpr Field kPole{"/surface/pole", "1", "farthest inner Voronoi vertex of each site; -1 = none"};

inline constexpr Field kGeodesic{"/surface/geodesic_distance", "length",
    "D_g: from the site to its pole and along the Voronoi complex to a centerline; NaN = no way"};
inline constexpr Field kDescentLength{"/surface/descent_length", "length",
    "length of the steepest descent from the pole to centerline_point; NaN = no way"};
inline constexpr Field kEuclidean{"/surface/euclidean_distance", "length",
    "D_e: from the site straight to centerline_point; NaN = no way"};
inline constexpr Field kTangencyDeviation{"/surface/normalized_tangency_deviation", "1",
    "NTD: share of the way along the complex in geodesic_distance; NaN = no way"};
inline constexpr Field kGeodesicRefined{"/surface/geodesic_distance_refined", "length",
    "D_g by the medial ball that touches the surface at the site; NaN = no way"};
inline constexpr Field kTangencyDeviationRefined{"/surface/normalized_tangency_deviation_refined", "1",
    "NTD by the medial ball that touches the surface at the site; NaN = no way"};
inline constexpr Field kCenterlinePoint{"/surface/centerline_point", "length",
    "c(p): end of the descent, on a path of /centerlines/path; NaN = no way"};
inline constexpr Field kCenterlineId{"/surface/centerline_id", "1", "centerline of centerline_point; -1 = no way"};
inline constexpr Field kSiteAbscissa{"/surface/abscissa", "length",
    "abscissa of centerline_point on its centerline; NaN = no way"};
inline constexpr Field kZone{"/surface/zone", "1",
    "0 = wall that counts in statistics, 1 = extension or cap, 2 = end zone of a closed tip"};

inline constexpr Field kStatisticsGeodesic{"/characterization/geodesic_distance", "length",
    "mean, standard deviation, median and 95th percentile over the wall, weighted by area"};
inline constexpr Field kStatisticsEuclidean{"/characterization/euclidean_distance", "length",
    "mean, standard deviation, median and 95th percentile over the wall, weighted by area"};
inline constexpr Field kStatisticsTangency{"/characterization/normalized_tangency_deviation", "1",
    "mean, standard deviation, median and 95th percentile over the wall, weighted by area"};
inline constexpr Field kWallSites{"/characterization/wall_sites", "1", "sites of zone 0"};
inline constexpr Field kUnreachedSites{"/characterization/unreached", "1", "sites of zone 0 with no way to a centerline"};
inline constexpr Field kNotRefined{"/characterization/not_refined", "1",
    "sites of zone 0 whose refined values are those of the paper's pole"};
inline constexpr Field kJumps{"/characterization/jumps", "1",
    "edges of the wall along which D_g or c(p) jumps: pole on another sheet, branches meet, other"};

inline constexpr const char* kEndpoints = "/endpoints";
inline constexpr Field kEndpointPoint{"/endpoints/point", "length",
    "centre of the opening or cap, the given point, or the tip"};
inline constexpr Field kEndpointNormal{"/endpoints/normal", "1", "unit, out of the lumen; zero for a given point"};
inline constexpr Field kEndpointRadius{"/endpoints/radius", "length",
    "of the opening's circle of equal area, or of the ball at a point or tip"};
inline constexpr Field kEndpointKind{"/endpoints/kind", "1", "boundary | point | tip | cap"};
inline constexpr Field kEndpointRole{"/endpoints/role", "1", "inlet (root of the tree) | outlet"};
inline constexpr Field kAnchor{"/endpoints/anchor", "length", "point on the Voronoi complex where lines start or end"};
inline constexpr Field kAnchorRadius{"/endpoints/anchor_radius", "length", "ball radius at the anchor"};

inline constexpr Field kIndexRows{"/index_rows", "1",
    "copy of the rows that this model has in the tables of an index, in one piece: for making the index alone"};

inline constexpr const char* kVoronoi = "/voronoi";
inline constexpr Field kVertices{"/voronoi/vertices", "length",
    "inner Voronoi vertices: centres of maximal empty balls"};
inline constexpr Field kBallRadius{"/voronoi/ball_radius", "length", "radius of the ball of each vertex"};
inline constexpr Field kPolygonOffsets{"/voronoi/polygon_offsets", "1", "start of each polygon in polygon_vertices"};
inline constexpr Field kPolygonVertices{"/voronoi/polygon_vertices", "1", "loops in order; two vertices = a bare edge"};
inline constexpr Field kPolygonSites{"/voronoi/polygon_sites", "1", "the two sites of each polygon; -1 = a bare edge"};
inline constexpr Field kArrivalTime{"/voronoi/arrival_time", "1",
    "first arrival time at each vertex of the front from each source; +inf = unreached"};
inline constexpr Field kSources{"/voronoi/sources", "1", "endpoint each row of arrival_time starts from"};
inline constexpr Field kReached{"/voronoi/reached", "1", "vertices with a finite arrival time, per source"};
inline constexpr Field kCenterlineDistance{"/voronoi/centerline_distance", "length",
    "distance along the complex from each vertex to the nearest centerline path; +inf = unreached"};
inline constexpr Field kResidual{"/voronoi/residual", "1",
    "largest distance of the field from the fixed point of its update, relative to T"};

inline constexpr Field kCovariateName{"/covariates/name", "1", "column of the cohort's table"};
inline constexpr Field kCovariateValue{"/covariates/value", "1", "this model's value, as written"};

inline constexpr Field kCode{"/diagnostics/code", "1", "stable name of the finding"};
inline constexpr Field kSeverity{"/diagnostics/severity", "1", "note | warning | error"};
inline constexpr Field kStage{"/diagnostics/stage", "1", "stage that made the finding"};
inline constexpr Field kMessage{"/diagnostics/message", "1", "one sentence"};
inline constexpr Field kValue{"/diagnostics/value", "1", "what was measured, in the unit the message states; NaN = none"};
inline constexpr Field kLimit{"/diagnostics/limit", "1", "what it was held against; NaN = none"};

inline constexpr Field kHost{"/provenance/host", "1", "machine that computed the model"};
inline constexpr Field kProgram{"/provenance/lumenline_version", "1", "version of the program"};
inline constexpr Field kCommit{"/provenance/build_commit", "1", "commit the program was built from"};
inline constexpr Field kCompiler{"/provenance/compiler", "1", "compiler that built it"};
inline constexpr Field kHdf5Version{"/provenance/hdf5_version", "1", "version of the HDF5 library"};
inline constexpr Field kOptions{"/provenance/options", "1", "options as resolved, versions of the stages: key=value a line"};
inline constexpr Field kThreads{"/provenance/threads", "1", "threads of the run"};

inline constexpr Field kTimingStage{"/timing/stage", "1", "stages of the pipeline, in order"};
inline constexpr Field kTimingSeconds{"/timing/seconds", "s", "time each stage took, summed over sources"};
inline constexpr Field kTotalSeconds{"/timing/total_seconds", "s", "time of work on the model, without waiting"};
inline constexpr Field kPeakBytes{"/timing/peak_resident_bytes", "B", "of the process, when the model was finished"};

// Counts that the root of a model file states, whether or not its file holds the arrays.
inline constexpr const char *kStatedSites = "site_count", *kStatedTriangles = "triangle_count",
                            *kStatedVertices = "voronoi_vertex_count", *kStatedPolygons = "polygon_count";

inline constexpr const char* kVtk = "/VTKHDF";
inline constexpr Field kVtkPointCount{"/VTKHDF/NumberOfPoints", "1", "sites and centerline points"};
inline constexpr Field kVtkCellCount{"/VTKHDF/NumberOfCells", "1", "triangles and centerlines"};
inline constexpr Field kVtkIdCount{"/VTKHDF/NumberOfConnectivityIds", "1", "length of Connectivity"};
inline constexpr Field kVtkPoints{"/VTKHDF/Points", "length", "sites, then centerline points"};
inline constexpr Field kVtkConnectivity{"/VTKHDF/Connectivity", "1", "points of each cell"};
inline constexpr Field kVtkOffsets{"/VTKHDF/Offsets", "1", "start of each cell in Connectivity"};
inline constexpr Field kVtkTypes{"/VTKHDF/Types", "1", "5 = triangle, 4 = polyline"};
inline constexpr Field kVtkPart{"/VTKHDF/CellData/part", "1", "0 = wall, 1 = extension or cap, 2 = centerline"};
inline constexpr Field kVtkRadius{"/VTKHDF/PointData/MaximumInscribedSphereRadius", "length",
    "radius of centerline points; NaN on the surface"};
// clang-format on

}  // namespace lumenline::names
