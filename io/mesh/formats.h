#pragma once

#include "engine/core/soup.h"
#include "io/mesh/cursor.h"

namespace lumenline::mesh {

/// Triangles of a file in memory, in the format that its content or else its extension tells.
/// The soup's source_file and source_sha256 stay empty. Throws as read_surface().
TriangleSoup parse_surface(const SourceFile& file);

/// Whether the size fits the number of triangles in a binary STL header.
bool is_binary_stl(const SourceFile& file);

// One format each; called for a file whose content or extension says so.

TriangleSoup parse_stl(const SourceFile& file);
TriangleSoup parse_ply(const SourceFile& file);
TriangleSoup parse_obj(const SourceFile& file);
TriangleSoup parse_off(const SourceFile& file);
TriangleSoup parse_vtk_legacy(const SourceFile& file);
TriangleSoup parse_vtk_xml(const SourceFile& file);

}  // namespace lumenline::mesh
