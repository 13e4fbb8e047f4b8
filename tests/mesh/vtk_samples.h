#pragma once

#include <string>
#include <vector>

#include "tests/mesh/samples.h"
#include "tests/mesh/vtp_writer.h"

namespace lumenline::samples {

/// The tetrahedron as VTK XML polydata: a vertex, a line, two triangles, and a strip of the other two; with the
/// cell arrays `ModelFaceID` (Int32), `Ids` (Float64, whole numbers), `Pressure` and `Normals`, which are no labels.
VtpPiece tetrahedron_piece();
/// Corners of tetrahedron_piece() as they are read, and its labels of both names.
Corners tetrahedron_piece_corners();
std::vector<std::int32_t> tetrahedron_piece_faces();
std::vector<std::int32_t> tetrahedron_piece_ids();

/// Every style of storage, with a name for each.
std::vector<std::pair<std::string, VtpStyle>> vtp_styles();

/// Legacy files with point and cell data of every kind, in text and in binary: the tetrahedron's four triangles
/// behind a line, with the labels 10, 20, 30, 40 in every cell array called ModelFaceID.
std::string legacy_with_attributes(bool binary);

/// Unstructured grids: the tetrahedron as vertex, line, triangles and strip; the cube as quads, a pixel and polygons.
void add_vtk_grids(std::vector<Sample>& list);
void add_vtp(std::vector<Sample>& list);

}  // namespace lumenline::samples
