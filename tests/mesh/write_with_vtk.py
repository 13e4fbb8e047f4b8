"""Writes small surfaces with VTK's own writers, and beside each file what VTK's own reader finds in it.

Usage: write_with_vtk.py DIRECTORY

For each NAME.vtp or NAME.vtk a text file NAME.EXTENSION.expected holds
    points N, and N lines x y z;  triangles M, and M lines of nine coordinates and the value of ModelFaceID.
The list of files is printed, one a line.
"""
import itertools
import os
import sys

import vtkmodules.all as vtk


def surface(points_type, with_quads, with_strips=True):
    """A bumpy grid of 5 x 4 points: triangles, strips and perhaps quads and a pentagon; a vertex and two lines."""
    points = vtk.vtkPoints()
    points.SetDataType(points_type)
    whole = points_type not in (vtk.VTK_FLOAT, vtk.VTK_DOUBLE)
    for j, i in itertools.product(range(4), range(5)):
        x = (7 * i, 11 * j, (i * j) % 3) if whole else (1.1 * i + 0.01 * j, 0.7 * j - 0.03 * i * i, 0.1 * i * j - 0.2 * j)
        points.InsertNextPoint(x)
    cells = {kind: vtk.vtkCellArray() for kind in ("verts", "lines", "polys", "strips")}

    def add(kind, *ids):
        cells[kind].InsertNextCell(len(ids), ids)

    add("verts", 3)
    add("lines", 0, 1)
    add("lines", 1, 2, 3)
    for i in range(4):
        if with_quads:
            add("polys", i, i + 1, i + 6, i + 5)
        else:
            add("polys", i, i + 1, i + 6)
            add("polys", i, i + 6, i + 5)
    if with_quads:
        add("polys", 0, 1, 2, 7, 6)
    if with_strips:
        add("strips", 5, 10, 6, 11, 7, 12, 8)
        add("strips", 10, 15, 11, 16, 12)
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    data.SetVerts(cells["verts"])
    data.SetLines(cells["lines"])
    data.SetPolys(cells["polys"])
    data.SetStrips(cells["strips"])
    add_attributes(data)
    return data


def add_attributes(data):
    faces, area, normals = vtk.vtkIntArray(), vtk.vtkFloatArray(), vtk.vtkFloatArray()
    faces.SetName("ModelFaceID")
    area.SetName("Area")
    normals.SetName("Normals")
    normals.SetNumberOfComponents(3)
    for c in range(data.GetNumberOfCells()):
        faces.InsertNextValue(c + 1)
        area.InsertNextValue(0.1 * c)
        normals.InsertNextTuple3(0, 0, 1)
    data.GetCellData().AddArray(area)
    data.GetCellData().AddArray(faces)
    data.GetCellData().SetNormals(normals)
    bits, text, scalars = vtk.vtkBitArray(), vtk.vtkStringArray(), vtk.vtkDoubleArray()
    bits.SetName("Bits")
    text.SetName("Text with blanks")
    scalars.SetName("Scalars")
    for p in range(data.GetNumberOfPoints()):
        bits.InsertNextValue(p % 2)
        text.InsertNextValue("word %d" % p)
        scalars.InsertNextValue(p / 3)
    data.GetPointData().AddArray(bits)
    data.GetPointData().AddArray(text)
    data.GetPointData().SetScalars(scalars)


def grid():
    """The surface without lines as an unstructured grid."""
    flat = surface(vtk.VTK_DOUBLE, True)
    data = vtk.vtkUnstructuredGrid()
    data.SetPoints(flat.GetPoints())
    for c in range(flat.GetNumberOfCells()):
        data.InsertNextCell(flat.GetCellType(c), flat.GetCell(c).GetPointIds())
    add_attributes(data)
    return data


def triangles_of(cell):
    """Point ids of a cell's triangles: a strip by VTK, a quad along its shorter diagonal, else a fan."""
    ids = [cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())]
    if cell.GetCellType() == vtk.VTK_TRIANGLE_STRIP:
        one, cells = vtk.vtkPolyData(), vtk.vtkCellArray()
        cells.InsertNextCell(len(ids), ids)
        one.SetPoints(vtk.vtkPoints())
        one.GetPoints().SetNumberOfPoints(max(ids) + 1)
        one.SetStrips(cells)
        cut = vtk.vtkTriangleFilter()
        cut.SetInputData(one)
        cut.Update()
        out = cut.GetOutput()
        return [[out.GetCell(t).GetPointId(k) for k in range(3)] for t in range(out.GetNumberOfCells())]
    if len(ids) == 4:
        p = [cell.GetPoints().GetPoint(i) for i in range(4)]
        square = vtk.vtkMath.Distance2BetweenPoints
        if square(p[1], p[3]) < square(p[0], p[2]):
            return [[ids[0], ids[1], ids[3]], [ids[1], ids[2], ids[3]]]
    return [[ids[0], ids[i], ids[i + 1]] for i in range(1, len(ids) - 1)]


def write_expected(path, reader):
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput()
    faces = data.GetCellData().GetArray("ModelFaceID")
    lines = []
    for c in range(data.GetNumberOfCells()):
        if data.GetCellType(c) < vtk.VTK_TRIANGLE:
            continue
        for ids in triangles_of(data.GetCell(c)):
            numbers = [x for i in ids for x in data.GetPoint(i)]
            lines.append(" ".join(repr(x) for x in numbers) + " %d" % faces.GetValue(c))
    with open(path + ".expected", "w", encoding="ascii") as file:
        file.write("points %d\n" % data.GetNumberOfPoints())
        for p in range(data.GetNumberOfPoints()):
            file.write(" ".join(repr(x) for x in data.GetPoint(p)) + "\n")
        file.write("triangles %d\n" % len(lines) + "\n".join(lines) + "\n")
    print(os.path.basename(path))


def write_xml(directory):
    shapes = {"float": (vtk.VTK_FLOAT, True), "double": (vtk.VTK_DOUBLE, False)}
    forms = ("ascii", "binary", "base64", "raw")
    for (name, shape), form, zipped, wide, big, pieces in itertools.product(
            shapes.items(), forms, (False, True), (False, True), (False, True), (1, 3)):
        if form == "ascii" and (zipped or wide or big):
            continue
        writer = vtk.vtkXMLPolyDataWriter()
        # VTK 9.1 mixes up the cell arrays that it reads from several pieces with polygons and strips.
        writer.SetInputData(surface(*shape, with_strips=pieces == 1))
        writer.SetDataMode({"ascii": vtk.vtkXMLWriter.Ascii, "binary": vtk.vtkXMLWriter.Binary}.get(
            form, vtk.vtkXMLWriter.Appended))
        writer.SetEncodeAppendedData(form == "base64")
        writer.SetCompressorType(vtk.vtkXMLWriter.ZLIB if zipped else vtk.vtkXMLWriter.NONE)
        writer.SetBlockSize(64)
        writer.SetHeaderType(vtk.vtkXMLWriter.UInt64 if wide else vtk.vtkXMLWriter.UInt32)
        writer.SetByteOrder(vtk.vtkXMLWriter.BigEndian if big else vtk.vtkXMLWriter.LittleEndian)
        writer.SetNumberOfPieces(pieces)
        marks = [name, form] + [m for m, on in (("zlib", zipped), ("64", wide), ("big", big), ("pieces", pieces > 1)) if on]
        path = os.path.join(directory, "_".join(marks) + ".vtp")
        writer.SetFileName(path)
        writer.Write()
        write_expected(path, vtk.vtkXMLPolyDataReader())
    for name, kind in (("char", vtk.VTK_SIGNED_CHAR), ("uchar", vtk.VTK_UNSIGNED_CHAR), ("short", vtk.VTK_SHORT),
                       ("ushort", vtk.VTK_UNSIGNED_SHORT), ("int", vtk.VTK_INT), ("uint", vtk.VTK_UNSIGNED_INT),
                       ("longlong", vtk.VTK_LONG_LONG), ("ulonglong", vtk.VTK_UNSIGNED_LONG_LONG)):
        writer = vtk.vtkXMLPolyDataWriter()
        writer.SetInputData(surface(kind, False))
        path = os.path.join(directory, "points_" + name + ".vtp")
        writer.SetFileName(path)
        writer.Write()
        write_expected(path, vtk.vtkXMLPolyDataReader())


def write_legacy(directory):
    inputs = {"float": surface(vtk.VTK_FLOAT, True), "double": surface(vtk.VTK_DOUBLE, False),
              "short": surface(vtk.VTK_SHORT, False), "grid": grid()}
    for (name, data), binary, version in itertools.product(inputs.items(), (False, True), (42, 51)):
        is_grid = name == "grid"
        writer = vtk.vtkUnstructuredGridWriter() if is_grid else vtk.vtkPolyDataWriter()
        writer.SetInputData(data)
        writer.SetFileType(vtk.VTK_BINARY if binary else vtk.VTK_ASCII)
        if hasattr(writer, "SetFileVersion"):
            writer.SetFileVersion(version)
        path = os.path.join(directory, "%s_%s_%d.vtk" % (name, "binary" if binary else "ascii", version))
        writer.SetFileName(path)
        writer.Write()
        write_expected(path, vtk.vtkUnstructuredGridReader() if is_grid else vtk.vtkPolyDataReader())


if __name__ == "__main__":
    write_xml(sys.argv[1])
    write_legacy(sys.argv[1])
