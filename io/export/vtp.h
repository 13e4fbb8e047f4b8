#pragma once

#include <filesystem>
#include <vector>

#include "io/archive/read.h"

namespace lumenline {

/// Writes a model as VTK XML polydata, for VMTK, 3D Slicer, SimVascular and ParaView: `<id>_surface.vtp`,
/// `<id>_centerlines.vtp` and `<id>_voronoi.vtp`, as far as the model has them.
///
/// Arrays have the names of the archive, and besides the ones that VMTK's scripts read:
///  - lines: MaximumInscribedSphereRadius, Abscissas, Curvature, Torsion, ParallelTransportNormals per point; a cell is
///  a
///    part of one line on one branch or in one junction, with CenterlineIds, TractIds (its place along the line),
///    GroupIds (the branch; the number of branches plus the junction) and Blanking (1 in junctions). A cell ends in the
///    point where the next begins. Without branches a cell is a line.
///  - surface: GroupIds, AbscissaMetric and AngularMetric (coordinates on the branch), DistanceToCenterlines (D_e).
///  - Voronoi diagram: MaximumInscribedSphereRadius, EikonalSolutionArray (arrival time from the first source).
/// @returns the files written
/// @throws ArchiveError if the model cannot be read or its parts contradict each other; std::system_error
std::vector<std::filesystem::path> export_vtp(const ArchiveFile& model, const std::filesystem::path& directory);

}  // namespace lumenline
