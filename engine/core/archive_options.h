#pragma once

#include <cstdint>
#include <string_view>

namespace lumenline {

/// What of a model goes into its file. Lines, endpoints, branches with all their tables, the wall's statistics,
/// diagnostics and provenance always do.
enum class ArchiveFields : std::uint8_t {
    kAll,      ///< everything
    kSurface,  ///< not the Voronoi diagram and its fields, nor poles
    kLines,    ///< nor the surface and the values of its points
};

std::string_view fields_name(ArchiveFields fields);  ///< "all" | "surface" | "lines"

/// In which form a model goes into its file.
struct ArchiveOptions {
    /// Scalar fields on the complex and the surface in single precision. Coordinates, radii and
    /// abscissae are always double.
    bool float32_fields = true;
    ArchiveFields fields = ArchiveFields::kAll;
};

}  // namespace lumenline
