#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Opens meshes with VTK and compares them with the surfaces that they were written from.

compare_meshes.py NAME...

Each NAME stands for NAME.vtp, .obj, .ply, .stl and _solids.stl beside NAME.json, which has the surface's arrays.
Exit status: 0 equal, 1 not, 77 where VTK is not installed (Debian: python3-vtk9)."""
import json, struct, sys

try:
    import vtk
except ImportError:
    print("skipped: VTK's Python module is not installed")
    sys.exit(77)

FAULTS = []


def check(fact, what):
    if not fact: FAULTS.append(what)


def single(value):
    """As a float of 32 bits."""
    return struct.unpack("f", struct.pack("f", value))[0]


def read(reader, path):
    errors = []
    reader.AddObserver("ErrorEvent", lambda *_: errors.append(1))
    reader.SetFileName(path)
    reader.Update()
    check(not errors, f"{path}: VTK reports an error")
    return reader.GetOutput()


def rows(array):
    return [array.GetTuple(i) for i in range(array.GetNumberOfTuples())]


def column(array):
    return [row[0] for row in rows(array)]


def triangles(mesh):
    result, ids = [], vtk.vtkIdList()
    cells = mesh.GetPolys()
    cells.InitTraversal()
    while cells.GetNextCell(ids): result.append([ids.GetId(i) for i in range(ids.GetNumberOfIds())])
    return result


def points(mesh):
    return [mesh.GetPoint(i) for i in range(mesh.GetNumberOfPoints())]


def floats(values):
    return [tuple(single(x) for x in row) for row in values]


def texts(mesh, name):
    array = mesh.GetFieldData().GetAbstractArray(name)
    return None if array is None else [array.GetValue(i) for i in range(array.GetNumberOfValues())]


def compare_vtp(name, truth):
    path = name + ".vtp"
    mesh = read(vtk.vtkXMLPolyDataReader(), path)
    check(points(mesh) == floats(truth["position"]), f"{path}: points")
    check(triangles(mesh) == truth["triangle"], f"{path}: triangles")
    at_points, at_cells = mesh.GetPointData(), mesh.GetCellData()
    check(rows(at_points.GetNormals()) == floats(truth["normal"]), f"{path}: normals")
    for array, key in (("Radius", "radius"), ("Branch", "branch"), ("Confidence", "confidence")):
        found = at_points.GetArray(array)
        check((found is None) == (not truth[key]) or not truth["position"], f"{path}: {array}: there")
        if found: check(column(found) == [single(x) for x in truth[key]], f"{path}: {array}")
    for array in ("ModelFaceID", "CellEntityIds"):
        check(column(at_cells.GetArray(array)) == [g + 1 for g in truth["group"]], f"{path}: {array}")
    check((texts(mesh, "GroupNames") or []) == truth["groups"], f"{path}: GroupNames")
    check((texts(mesh, "BranchLabels") or []) == truth["labels"], f"{path}: BranchLabels")
    check(texts(mesh, "Unit") == ["mm"], f"{path}: Unit")
    check(texts(mesh, "SPACE") == ["LPS"], f"{path}: SPACE")


def compare_ply(name, truth):
    path = name + ".ply"
    reader = vtk.vtkPLYReader()
    mesh = read(reader, path)
    check(points(mesh) == floats(truth["position"]), f"{path}: points")
    check(triangles(mesh) == truth["triangle"], f"{path}: triangles")
    comments = [reader.GetComments().GetValue(i) for i in range(reader.GetComments().GetNumberOfValues())]
    check("SPACE=LPS" in comments, f"{path}: SPACE=LPS")


def compare_obj(name, truth):
    path = name + ".obj"
    reader = vtk.vtkOBJReader()
    mesh = read(reader, path)
    # VTK makes a point of each pair of a position and a normal
    places = points(mesh)
    found = sorted(tuple(places[v] for v in t) for t in triangles(mesh))
    true = floats(truth["position"])
    check(found == sorted(tuple(true[v] for v in t) for t in truth["triangle"]), f"{path}: triangles")
    check("SPACE=LPS" in (reader.GetComment() or ""), f"{path}: SPACE=LPS")


def compare_stl(path, truth, solids):
    reader = vtk.vtkSTLReader()
    reader.MergingOff()
    reader.SetScalarTags(solids)
    mesh = read(reader, path)
    places = points(mesh)
    found = [tuple(places[v] for v in t) for t in triangles(mesh)]
    true = floats(truth["position"])
    order = sorted(range(len(truth["group"])), key=lambda f: truth["group"][f]) if solids else range(len(truth["group"]))
    check(found == [tuple(true[v] for v in truth["triangle"][f]) for f in order], f"{path}: triangles")
    if solids:
        tags = column(mesh.GetCellData().GetArray("STLSolidLabeling"))
        check(tags == [truth["group"][f] for f in order], f"{path}: solids")
    else: check("SPACE=LPS" in reader.GetHeader(), f"{path}: SPACE=LPS")


for name in sys.argv[1:]:
    with open(name + ".json", encoding="utf-8") as file: surface = json.load(file)
    compare_vtp(name, surface)
    if not surface["position"]: continue  # VTK takes no other format without points
    compare_ply(name, surface)
    compare_obj(name, surface)
    compare_stl(name + ".stl", surface, False)
    compare_stl(name + "_solids.stl", surface, True)
print("\n".join(FAULTS) or f"{len(sys.argv) - 1} surfaces: VTK reads what was written")
sys.exit(1 if FAULTS or len(sys.argv) < 2 else 0)
