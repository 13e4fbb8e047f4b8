#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/arrival_field.h"
#include "engine/core/branch_labels.h"
#include "engine/core/centerlines.h"
#include "engine/core/diagnostics.h"
#include "engine/core/endpoints.h"
#include "engine/core/surface.h"
#include "engine/core/surface_character.h"
#include "engine/core/voronoi_complex.h"

namespace lumenline {

struct Branches;

enum class ModelStatus { kOk, kWarning, kFailed };

std::string_view status_name(ModelStatus status);  ///< "ok" | "warning" | "failed"

/// Who a model is. All but `id` may be empty.
struct ModelIdentity {
    std::string id;  ///< safe as a file name; unique in the cohort without regard to case
    std::string subject, session, side, structure, group;
    std::string length_unit = "unknown";                          ///< as the configuration states it
    std::string coordinate_system = "unknown";                    ///< LPS | RAS | unknown
    std::string source_file;                                      ///< as given
    std::string source_sha256;                                    ///< empty when the file could not be read
    std::string inputs_sha256;                                    ///< of everything that determines the result
    std::vector<std::pair<std::string, std::string>> covariates;  ///< column, value as written
    GivenLabels branch_labels;
};

/// Why a model failed.
struct Failure {
    Stage stage = Stage::kLoad;
    ErrorCode code = ErrorCode::kInternal;
    std::string sentence;
    int signal = 0;  ///< that ended the worker process; 0 = none
};

/// Does the failure tell of the machine and not of the model? Such a one is tried again by the next run: by its code,
/// and a worker process that was killed from outside, as the system does where memory runs out.
bool is_transient(const Failure& failure);

/// What differs between two runs of the same input.
struct RunFacts {
    std::array<double, kStageCount> stage_seconds{};  ///< per Stage; summed over sources
    double total_seconds = 0;                         ///< of work, without waiting
    double peak_resident_bytes = 0;                   ///< of the process when the model was finished
    int threads = 1;                                  ///< of the run
};

/// Everything known of one model when it is done or has failed. Parts that were not reached are null.
struct ModelRecord {
    ModelIdentity identity;
    std::string options;  ///< as resolved: canonical_text of its task
    ModelStatus status = ModelStatus::kFailed;
    std::optional<Failure> failure;  ///< set if and only if status is kFailed
    Diagnostics diagnostics;
    std::shared_ptr<const Surface> surface;
    std::shared_ptr<const VoronoiComplex> complex;
    std::shared_ptr<const Endpoints> endpoints;
    std::vector<std::shared_ptr<const ArrivalField>> fields;  ///< one per source, in endpoint order
    std::shared_ptr<const Centerlines> centerlines;
    std::shared_ptr<const SurfaceCharacter> character;  ///< null also where it was not asked for
    std::shared_ptr<const Branches> branches;           ///< null also where they were not asked for
    RunFacts facts;
};

/// Row of `/tables/models` and of the printed table: a record boiled down to numbers.
struct ModelSummary {
    ModelIdentity identity;
    ModelStatus status = ModelStatus::kFailed;
    std::optional<Failure> failure;
    std::size_t warnings = 0;
    std::size_t sites = 0, triangles = 0, voronoi_vertices = 0, polygons = 0;
    std::size_t inlets = 0, outlets = 0, centerlines = 0;
    double length = 0;  ///< sum of the lines' lengths; a stretch that lines share counts for each [length]
    double radius_min = 0, radius_mean = 0, radius_max = 0;  ///< along all lines, mean weighted by arc length [length]
    AreaStatistics geodesic_distance, euclidean_distance, normalized_tangency_deviation;  ///< over the wall; NaN = none
    std::size_t genus = 0;            ///< handles of the surface
    std::size_t loops = 0;            ///< of the lumen that fronts run around, covered by lines or not
    std::size_t unreached_sites = 0;  ///< of the wall, without a centerline
    double diagonal = 0;              ///< of the wall's bounding box; 0 = no surface was made [length]
    double edge_over_radius = 0;      ///< the wall's median edge over the lines' median radius; 0 = no line
    double seconds = 0;
};

ModelSummary summarize(const ModelRecord& record);

}  // namespace lumenline
