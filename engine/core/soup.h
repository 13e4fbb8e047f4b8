#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/core/diagnostics.h"
#include "engine/core/vec3.h"

namespace lumenline {

/// Whole numbers that a file gives its faces, as `ModelFaceID` of SimVascular or `CellEntityIds` of VMTK.
struct CellLabels {
    std::string name;                  ///< of the array in the file
    std::vector<std::int32_t> values;  ///< (M) one per triangle; alike on the triangles of one polygon
};

/// Triangles as a file gives them: nothing is promised but valid indices and finite coordinates.
struct TriangleSoup {
    std::vector<Vec3> points;                             ///< (N) in the file's unit
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< (M) indices into points
    std::string source_file;                              ///< path as given, for messages and the archive
    std::string source_sha256;  ///< of the file's bytes, 64 hexadecimal digits; empty if made in memory
    /// Half the spacing of representable coordinates in the file, at its largest coordinate
    /// [length]: 2^-24 max|x| for float32 files; from the printed digits in text files.
    double coordinate_rounding = 0;
    std::vector<CellLabels> cell_labels;  ///< names are distinct; empty where the format has none
    Diagnostics diagnostics;              ///< what the file holds beside the triangles that are read
};

}  // namespace lumenline
