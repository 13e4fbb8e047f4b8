#include "engine/core/errors.h"

#include <array>

#include "engine/core/diagnostics.h"
#include "engine/core/endpoints.h"

namespace lumenline {

std::string_view stage_name(Stage stage) {
    static constexpr std::array<std::string_view, kStageCount> kNames{
        "load", "condition", "voronoi", "endpoints", "eikonal", "trace", "characterize", "branches", "archive"};
    return kNames.at(static_cast<std::size_t>(stage));
}

std::string_view error_name(ErrorCode code) {
    switch (code) {
        case ErrorCode::kFileUnreadable: return "file_unreadable";
        case ErrorCode::kFileFormat: return "file_format";
        case ErrorCode::kNoSurface: return "no_surface";
        case ErrorCode::kBadCoordinate: return "bad_coordinate";
        case ErrorCode::kNonManifold: return "non_manifold";
        case ErrorCode::kOpenBoundary: return "open_boundary";
        case ErrorCode::kNotClosed: return "not_closed";
        case ErrorCode::kNoVolume: return "no_volume";
        case ErrorCode::kNestedComponents: return "nested_components";
        case ErrorCode::kSeveralComponents: return "several_components";
        case ErrorCode::kRepairOff: return "repair_off";
        case ErrorCode::kTooLarge: return "too_large";
        case ErrorCode::kNoLumen: return "no_lumen";
        case ErrorCode::kEndpointsMissing: return "endpoints_missing";
        case ErrorCode::kEndpointOutside: return "endpoint_outside";
        case ErrorCode::kEndpointAmbiguous: return "endpoint_ambiguous";
        case ErrorCode::kNoInlet: return "no_inlet";
        case ErrorCode::kNoOutlet: return "no_outlet";
        case ErrorCode::kNoSeed: return "no_seed";
        case ErrorCode::kNoLineTraced: return "no_line_traced";
        case ErrorCode::kArchiveWrite: return "archive_write";
        case ErrorCode::kInterrupted: return "interrupted";
        case ErrorCode::kOutOfMemory: return "out_of_memory";
        case ErrorCode::kTimeout: return "timeout";
        case ErrorCode::kCrashed: return "crashed";
        case ErrorCode::kInternal: return "internal";
    }
    return "internal";
}

bool is_transient(ErrorCode code) {
    return code == ErrorCode::kOutOfMemory || code == ErrorCode::kTimeout || code == ErrorCode::kInterrupted ||
           code == ErrorCode::kArchiveWrite;
}

std::string_view severity_name(Severity severity) {
    static constexpr std::array<std::string_view, 3> kNames{"note", "warning", "error"};
    return kNames.at(static_cast<std::size_t>(severity));
}

std::string_view kind_name(EndpointKind kind) {
    static constexpr std::array<std::string_view, 4> kNames{"boundary", "point", "tip", "cap"};
    return kNames.at(static_cast<std::size_t>(kind));
}

std::string_view role_name(EndpointRole role) { return role == EndpointRole::kInlet ? "inlet" : "outlet"; }

StageError::StageError(Stage stage, ErrorCode code, const std::string& sentence)
    : std::runtime_error(sentence), stage_(stage), code_(code) {}

}  // namespace lumenline
