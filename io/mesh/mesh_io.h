#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "engine/core/soup.h"
#include "engine/core/vec3.h"

namespace lumenline {

/// Triangles of the surface file `path`.
///
/// Formats: STL (ascii, binary), PLY (ascii, binary of either byte order), OBJ, OFF (with colours, normals,
/// texture coordinates), legacy VTK polydata and unstructured grids of flat cells (ascii, binary, versions 1.0 to
/// 5.1), VTK XML polydata (.vtp: ascii, base64, appended; plain or compressed by zlib; pieces are joined). The
/// content decides, and the extension where the content bears no mark (OBJ). Vertices and lines of VTK files are
/// left out; arrays of whole numbers on their cells are kept as TriangleSoup::cell_labels. Polygons are triangulated:
/// quads along their shorter diagonal, larger ones as a fan. Corners of an STL file are one point where their
/// coordinates are identical
/// (-0.0 counts as +0.0); nothing else is merged or dropped: repeated corners and unused points stay.
/// Coordinates are those of the file, in double precision and the file's unit.
/// @throws StageError (Stage::kLoad) kFileUnreadable: no regular file, or it cannot be read, or it
///         is written to or replaced while it is read;
///         kFileFormat: another format, damaged or truncated; kNoSurface: no triangle; kBadCoordinate: NaN or
///         infinite; kTooLarge: more than 2^31 - 1 points or triangles. The sentence names the file and the
///         line (text) or byte (binary). A text file without counts (OBJ, several STL solids) that was cut
///         between two of its faces or solids cannot be told from a smaller one.
/// @param name  what the sentence calls the file, and TriangleSoup::source_file; empty = its path
/// @cost O(bytes): one pass over the file in memory, and one for its SHA-256
TriangleSoup read_surface(const std::string& path, const std::string& name = {});

/// Writes a surface in the format of the extension of `path`: .stl (binary, coordinates rounded to float32),
/// .ply (binary little-endian, double), .obj and .off (shortest decimals that read back as the same double),
/// .vtk (legacy polydata, binary, double).
///
/// The file appears under its name only when complete: it is written as `path`.tmp and renamed.
/// @param points     finite [length]
/// @param triangles  at least one; indices into `points`
/// @throws std::runtime_error  one sentence: unknown extension, no triangle, an index out of range, a coordinate
///         that is not finite (or beyond float32, for STL), the file cannot be written. An existing file stays.
void write_surface(const std::string& path, std::span<const Vec3> points,
                   std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace lumenline
