#pragma once

#include <string>

#include "io/archive/read.h"
#include "io/export/picture.h"

namespace lumenline {

/// A small picture of a model.
struct Thumbnail {
    Picture picture;
    std::string quantity;  ///< what the wall is coloured by: "D_g", or empty
    double largest = 0;    ///< the value of the last colour; the first one is 0 [length]
};

/// Draws the wall of a model, seen along the least of its principal axes, the longest one across: shaded by its normals,
/// coloured by D_g up to its 98th percentile where the surface was characterized, and the centerlines over it in red. The
/// ground is transparent. The same picture for the same file.
///
/// @param size  of its sides in pixels
/// @returns     an empty picture where the model has no surface
/// @throws ArchiveError where parts of the file contradict each other
/// @cost   reads points, triangles, normals, one field and the lines; about 20 ms for 50,000 triangles
Thumbnail draw_model(const ArchiveFile& model, std::size_t size);

}  // namespace lumenline
