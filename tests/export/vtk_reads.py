"""Reads what `lumenline export --to vtp` wrote with VTK's own reader, and compares it with the archive.

Usage: vtk_reads.py DIRECTORY MODEL.hdf
"""
import pathlib
import sys

import h5py
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

folder, model = pathlib.Path(sys.argv[1]), h5py.File(sys.argv[2])
model_id = model.attrs["id"].decode()


def read(part):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(folder / f"{model_id}_{part}.vtp"))
    reader.Update()
    assert reader.GetErrorCode() == 0, part
    return reader.GetOutput()


def array(data, name):
    assert data.HasArray(name), name
    return vtk_to_numpy(data.GetArray(name))


def same(a, b):
    assert np.array_equal(a, b, equal_nan=True), (a, b)


surface = read("surface")
same(vtk_to_numpy(surface.GetPoints().GetData()), model["surface/points"][:])
same(vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3), model["surface/triangles"][:])
for ours, theirs in (("branch_id", "GroupIds"), ("branch_abscissa", "AbscissaMetric"), ("angle", "AngularMetric"),
                     ("euclidean_distance", "DistanceToCenterlines"), ("geodesic_distance", "geodesic_distance"),
                     ("normals", "normals")):
    same(array(surface.GetPointData(), theirs), model[f"surface/{ours}"][:])

lines = read("centerlines")
same(vtk_to_numpy(lines.GetPoints().GetData()), model["centerlines/points"][:])
for ours, theirs in (("radius", "MaximumInscribedSphereRadius"), ("abscissa", "Abscissas"), ("curvature", "Curvature")):
    same(array(lines.GetPointData(), theirs), model[f"centerlines/{ours}"][:])
cells = [array(lines.GetCellData(), n) for n in ("CenterlineIds", "TractIds", "GroupIds", "Blanking")]
offsets = model["centerlines/offsets"][:]
branch, junction = model["centerlines/branch_id"][:], model["centerlines/junction_id"][:]
assert lines.GetNumberOfCells() == len(cells[0]) > 0
assert set(cells[0]) == set(range(len(offsets) - 1))
covered = np.zeros(len(branch), dtype=int)
for cell in range(lines.GetNumberOfCells()):
    ids = lines.GetCell(cell).GetPointIds()
    points = [ids.GetId(k) for k in range(ids.GetNumberOfIds())]
    assert points == list(range(points[0], points[-1] + 1)), "a stretch of one line"
    assert offsets[cells[0][cell]] <= points[0] and points[-1] < offsets[cells[0][cell] + 1]
    covered[points[0]:points[-1]] += 1
    for k in points[:-1]:
        assert (cells[3][cell] == 1) == (junction[k] >= 0)
        if junction[k] < 0:
            assert cells[2][cell] == branch[k]
# Numbered as VMTK does: the tracts of a line from 0, own parts and blanked ones in turns; the lines of a tree share the
# groups up to where they part. For two lines this is the table that VMTK itself gives for a carotid bifurcation.
names = {}
table = [(line, tract, names.setdefault(group, len(names)), blanked) for line, tract, group, blanked in zip(*cells)]
for line in set(cells[0]):
    own = [row for row in table if row[0] == line]
    assert [row[1] for row in own] == list(range(len(own)))
    assert [row[3] for row in own] == [k % 2 for k in range(len(own))]
assert not {row[2] for row in table if row[3]} & {row[2] for row in table if not row[3]}, "groups are blanked as a whole"
if len(set(cells[0])) == 2:
    assert table == [(0, 0, 0, 0), (0, 1, 1, 1), (0, 2, 2, 0), (1, 0, 0, 0), (1, 1, 1, 1), (1, 2, 3, 0)], table
last = offsets[1:] - 1
assert (np.delete(covered, last) == 1).all() and (covered[last] == 0).all(), "each segment of a line once"

voronoi = read("voronoi")
same(vtk_to_numpy(voronoi.GetPoints().GetData()), model["voronoi/vertices"][:])
same(array(voronoi.GetPointData(), "MaximumInscribedSphereRadius"), model["voronoi/ball_radius"][:])
same(array(voronoi.GetPointData(), "EikonalSolutionArray"), model["voronoi/arrival_time"][0])
assert voronoi.GetNumberOfCells() == len(model["voronoi/polygon_offsets"]) - 1
print("lines", lines.GetNumberOfLines(), "junction parts", int(cells[3].sum()))
