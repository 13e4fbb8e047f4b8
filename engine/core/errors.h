#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace lumenline {

/// The stages of one model, in the order in which it passes them.
enum class Stage { kLoad, kCondition, kVoronoi, kEndpoints, kEikonal, kTrace, kCharacterize, kBranches, kArchive };

inline constexpr int kStageCount = 9;

/// Lower-case name of a stage, as written in the archive.
std::string_view stage_name(Stage stage);

/// Stable codes of everything that makes a model fail. The archive carries their names
/// (`error_name`); a code keeps its name for good.
enum class ErrorCode {
    kFileUnreadable,     ///< cannot be opened or read
    kFileFormat,         ///< not of the format it claims, or truncated
    kNoSurface,          ///< no triangle left
    kBadCoordinate,      ///< NaN, infinity
    kNonManifold,        ///< cannot be made an oriented manifold
    kOpenBoundary,       ///< a boundary loop that cannot be capped
    kNotClosed,          ///< not closed after capping
    kNoVolume,           ///< encloses no volume
    kNestedComponents,   ///< a component inside another one
    kSeveralComponents,  ///< more than one component, where one only is allowed
    kRepairOff,          ///< a defect whose repair is switched off
    kTooLarge,           ///< more sites or triangles than 32-bit indices hold
    kNoLumen,            ///< no Voronoi vertex inside
    kEndpointsMissing,   ///< neither openings nor given points
    kEndpointOutside,    ///< a given point lies outside of the lumen
    kEndpointAmbiguous,  ///< a given point lies between two branches
    kNoInlet,            ///< no source
    kNoOutlet,           ///< no target
    kNoSeed,             ///< a march without a start
    kNoLineTraced,       ///< not one target could be traced
    kArchiveWrite,       ///< the model file could not be written
    kInterrupted,        ///< the run was stopped
    kOutOfMemory,        ///< allocation failed
    kInternal,           ///< a broken promise of ours
    kTimeout,            ///< more time than run.model_timeout
    kCrashed,            ///< the worker process that computed the model died
};

inline constexpr int kErrorCodeCount = 26;

/// Stable snake_case name of a code, as written in the archive.
std::string_view error_name(ErrorCode code);

/// Codes that tell of the machine and not of the model: such a failure is tried again by the next run.
bool is_transient(ErrorCode code);

/// Unusable input. `what()` is one sentence: what is wrong, where, the measured value and its
/// limit where there is one, what to do.
class StageError : public std::runtime_error {
public:
    StageError(Stage stage, ErrorCode code, const std::string& sentence);

    [[nodiscard]] Stage stage() const { return stage_; }
    [[nodiscard]] ErrorCode code() const { return code_; }

private:
    Stage stage_;
    ErrorCode code_;
};

/// A surface's file that was read and is of no use.
class SourceError : public StageError {
public:
    SourceError(const StageError& reason, std::string source_sha256)
        : StageError(reason), source_sha256_(std::move(source_sha256)) {}

    /// Of the bytes that were read.
    [[nodiscard]] const std::string& source_sha256() const { return source_sha256_; }

private:
    std::string source_sha256_;
};

}  // namespace lumenline
