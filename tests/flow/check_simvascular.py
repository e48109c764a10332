#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Opens what `lumen export simvascular` writes with VTK and an XML parser, and compares it with the case.

check_simvascular.py LUMEN [CASE...]

Paths and contours are those of the case in cm; the model's faces have one number in the .mdl and the .vtp; nodes and
elements of mesh-complete have the same numbers inside and on the boundary. CASEs are opened too. Exit status: 0 all held,
1 something did not, 77 Python has no VTK (python3-vtk9)."""
import json, math, os, pathlib, shutil, subprocess, sys, tempfile
import xml.etree.ElementTree as ElementTree
from flow_cases import *

try:
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader
    from vtkmodules.util.numpy_support import vtk_to_numpy
    import numpy
except ImportError: numpy = None


def read(reader, file):
    reader = reader()
    expect(reader.CanReadFile(str(file)) == 1, f"{file.name}: VTK reads it")
    reader.SetFileName(str(file))
    reader.Update()
    return reader.GetOutput()


def points(data): return vtk_to_numpy(data.GetPoints().GetData())


def array(attributes, name, file):
    found = attributes.GetArray(name)
    expect(found is not None, f"{file}: has {name}")
    expect(found.GetDataTypeAsString() == "int", f"{file}: {name} is of VTK's type int")
    return vtk_to_numpy(found)


def corners(data, size):
    cells = vtk_to_numpy((data.GetPolys() if size == 3 else data.GetCells()).GetConnectivityArray())
    return cells.reshape(-1, size)


def elements(file):
    """The second root of a file of SimVascular, whose first is <format>."""
    rows = file.read_text().splitlines(keepends=True)
    expect(rows[0].startswith("<?xml") and rows[1].strip() == '<format version="1.0" />', f"{file.name}: begins as SimVascular's files do")
    return ElementTree.fromstring("".join(rows[2:]))


def xyz(node): return [float(node.get(a)) for a in "xyz"]


def check_lines(name, out, tree):
    """Paths and circles."""
    paths = {p.stem for p in (out / "Paths").iterdir()}
    expect(paths == {p.stem for p in (out / "Segmentations").iterdir()}, f"{name}: a segmentation for each path")
    centre, radius = numpy.array(tree["centre"]).reshape(-1, 3), numpy.array(tree["radius"])
    for one in tree["branches"]:
        label, first, count = one["label"].lower(), one["firstNode"], one["nodeCount"]
        path, group = elements(out / "Paths" / f"{label}.pth"), elements(out / "Segmentations" / f"{label}.ctgr")
        begins = one["parentNode"] >= 0
        nodes = ([one["parentNode"]] if begins else []) + list(range(first, first + count))
        places = [xyz(p.find("pos")) for p in path.iter("path_point")]
        expect(len(places) == len(nodes) and numpy.abs(10 * numpy.array(places) - centre[nodes]).max() < 1e-4, f"{name} {label}: the path, in cm")
        expect(group.get("path_name") == label and group.get("path_id") == path.get("id"), f"{name} {label}: contours of this path")
        contours = list(group.iter("contour"))
        expect(len(contours) >= 2 or count < 3, f"{name} {label}: contours")
        for contour in contours:
            k = int(contour.find("path_point").get("id"))
            expect(k > 0 or not begins, f"{name} {label}: no contour on the parent's axis")
            middle = numpy.array(xyz(contour.find("path_point/pos")))
            expect(numpy.abs(middle - places[k]).max() < 1e-6, f"{name} {label}: a contour at its point of the path")
            on = numpy.array([xyz(p) for p in contour.find("contour_points")])
            far = 10 * numpy.linalg.norm(on - middle, axis=1)
            expect(len(on) >= 12 and numpy.abs(far - radius[nodes[k]]).max() < 1e-4, f"{name} {label}: a circle of the node's radius")
            along = numpy.array(xyz(contour.find("path_point/tangent")))
            expect(numpy.abs((on - middle) @ along).max() < 1e-5, f"{name} {label}: across the path")
        expect(int(contours[-1].find("path_point").get("id")) == len(nodes) - 1, f"{name} {label}: a contour at its end")


def check_model(name, out, manifest):
    """The numbers of the model's faces, by their names."""
    model = elements(out / "Models" / "vessel.mdl")
    faces = {f.get("name"): (int(f.get("id")), f.get("type")) for f in model.iter("face")}
    surface = read(vtkXMLPolyDataReader, out / "Models" / "vessel.vtp")
    numbers = array(surface.GetCellData(), "ModelFaceID", "vessel.vtp")
    expect(set(numbers) == {n for n, _ in faces.values()}, f"{name}: faces {faces} are those of the surface")
    expect({k for k, (_, t) in faces.items() if t == "cap"} == {e["name"] for e in manifest["ends"]}, f"{name}: caps are the ends")
    expect([t for k, (_, t) in faces.items() if k == "wall"] == ["wall"], f"{name}: the wall is one")
    place, triangles = points(surface), corners(surface, 3)
    for end in manifest["ends"]:
        middle = place[numpy.unique(triangles[numbers == faces[end["name"]][0]])].mean(axis=0)
        expect(numpy.linalg.norm(middle - end["position"]) < 0.3 * end["radius"], f"{name}: {end['name']} lies where it is said to, in cm")
    return faces, place, triangles


def volume_of(place, tetrahedra):
    a, b, c, d = (place[tetrahedra[:, k]] for k in range(4))
    return numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / 6


def check_faces(name, file, grid, mesh_numbers):
    """A part of the boundary: nodes and elements have their numbers of the volume mesh."""
    part = read(vtkXMLPolyDataReader, file)
    place, triangles = points(part), corners(part, 3)
    node, element = array(part.GetPointData(), "GlobalNodeID", file.name), array(part.GetCellData(), "GlobalElementID", file.name)
    expect(numpy.array_equal(points(grid)[node - 1], place), f"{name} {file.name}: nodes lie where those of the volume lie")
    owners = numpy.sort(corners(grid, 4)[element - 1], axis=1)
    belongs = [set(t) <= set(o) for t, o in zip((node - 1)[triangles], owners)]
    expect(all(belongs), f"{name} {file.name}: triangles are faces of their elements")
    expect(numpy.array_equal(array(part.GetCellData(), "ModelRegionID", file.name), mesh_numbers[element - 1]), f"{name} {file.name}: regions")
    return {tuple(sorted(t)) for t in (node - 1)[triangles]}, array(part.GetCellData(), "ModelFaceID", file.name)


def check_mesh(name, out, faces, surface, parts):
    folder = out / "mesh-complete"
    grid = read(vtkXMLUnstructuredGridReader, folder / "mesh-complete.mesh.vtu")
    tetrahedra = corners(grid, 4)
    for data, key, count in ((grid.GetPointData(), "GlobalNodeID", grid.GetNumberOfPoints()), (grid.GetCellData(), "GlobalElementID", grid.GetNumberOfCells())):
        expect(numpy.array_equal(array(data, key, "mesh"), numpy.arange(1, count + 1)), f"{name}: {key} counts from 1")
    regions = array(grid.GetCellData(), "ModelRegionID", "mesh")
    expect(set(regions) == set(range(1, parts + 1)), f"{name}: {parts} regions")
    volumes = volume_of(points(grid), tetrahedra)
    expect((volumes > 0).all(), f"{name}: no tetrahedron is turned over: {volumes.min()}")
    place, triangles = surface
    enclosed = numpy.einsum("ij,ij->i", numpy.cross(place[triangles[:, 0]], place[triangles[:, 1]]), place[triangles[:, 2]]).sum() / 6
    near(volumes.sum(), enclosed, 1e-4, f"{name}: the tetrahedra fill the surface, cm^3")
    once, times = numpy.unique(numpy.sort(tetrahedra[:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]].reshape(-1, 3), axis=1), axis=0, return_counts=True)
    exterior, _ = check_faces(name, folder / "mesh-complete.exterior.vtp", grid, regions)
    expect(exterior == {tuple(t) for t in once[times == 1]}, f"{name}: the exterior is the boundary of the volume")
    listed = set()
    for face, (number, _) in faces.items():
        part, numbers = check_faces(name, folder / "mesh-surfaces" / f"{face}.vtp", grid, regions)
        expect(set(numbers) == {number} and not (part & listed), f"{name}: {face} has its number, and its own triangles")
        listed |= part
        if face == "wall": expect(check_faces(name, folder / "walls_combined.vtp", grid, regions)[0] == part, f"{name}: the combined wall")
    expect(listed == exterior, f"{name}: faces make up the exterior")
    print(name, len(tetrahedra), "tetrahedra")


def has_netgen(program): return (pathlib.Path(program).parent / "lumen-netgen").exists()


def export(program, folder, case, name, *options):
    lumen(program, folder, "export", "simvascular", str(case), name, "--quiet", *options)
    return folder / name, json.loads((folder / name / "lumen-export.json").read_text())


def check_case(name, program, folder, case, parts, *options):
    out, manifest = export(program, folder, case, name, *options)
    project = ElementTree.parse(out / "vessels.svproj").getroot()
    expect(project.tag == "projectDescription" and project.find("paths").get("folder_name") == "Paths", f"{name}: a project")
    lumen(program, folder, "convert", str(case), f"{name}.lumen.json", "--quiet")
    check_lines(name, out, json.loads((folder / f"{name}.lumen.json").read_text())["tree"])
    faces, *surface = check_model(name, out, manifest)
    if has_netgen(program): check_mesh(name, out, faces, surface, parts)


def without_netgen(program, folder, case):
    """A copy of the program with nothing beside it writes all but the volume mesh."""
    (folder / "alone").mkdir()
    shutil.copy(program, folder / "alone" / "lumen")
    done = subprocess.run([folder / "alone" / "lumen", "export", "simvascular", str(case), "bare", "--json"], cwd=folder, capture_output=True, text=True, env={"PATH": "/nowhere"})
    said = json.loads((folder / "bare" / "lumen-export.json").read_text())
    expect(done.returncode == 0 and "needs the program lumen-netgen" in done.stderr, f"without lumen-netgen: {done.stderr}")
    expect(any("lumen-netgen" in loss for loss in said["losses"]) and not (folder / "bare" / "mesh-complete").exists(), "without lumen-netgen the folder says so")


def broken_netgen(program, folder, case):
    """A program of that name that fails, or writes nonsense, costs only the volume mesh."""
    for k, script in enumerate(("exit 3", "kill -9 $$", "head -c 99 /dev/zero > volume", "echo 9999999999999999 > volume")):
        netgen = folder / "alone" / "lumen-netgen"
        netgen.write_text(f"#!/bin/sh\n{script}\n")
        netgen.chmod(0o755)
        done = subprocess.run([folder / "alone" / "lumen", "export", "simvascular", str(case), f"broken{k}"], cwd=folder, capture_output=True, text=True)
        expect(done.returncode == 0 and "could not fill" in done.stderr, f"lumen-netgen that says {script}: {done.returncode} {done.stderr}")
        expect(not (folder / f"broken{k}" / "mesh-complete").exists(), f"no mesh of a lumen-netgen that says {script}")


def check(program, folder, cases):
    for design, parts in (("bifurcation", 1), ("kissing", 2)):
        lumen(program, folder, "phantom", design, f"{design}.nrrd", "--size", "64", "--seeds", f"{design}.json", "--quiet")
        lumen(program, folder, "convert", f"{design}.nrrd", f"{design}.lumen", "--seeds", f"{design}.json", "--seeds-only", "--quiet")
        check_case(design, program, folder, f"{design}.lumen", parts)
    without_netgen(program, folder, "bifurcation.lumen")
    broken_netgen(program, folder, "bifurcation.lumen")
    for k, case in enumerate(cases): check_case(f"case{k}", program, folder, pathlib.Path(case).resolve(), 1)


def main():
    if numpy is None: skip("Python's VTK (python3-vtk9) or NumPy is not installed")
    if not has_netgen(sys.argv[1]): print("lumen-netgen is not built: mesh-complete is not tested")
    with tempfile.TemporaryDirectory() as folder: check(str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(folder), sys.argv[2:])
    return 1 if failures else 0


if __name__ == "__main__": sys.exit(main())
